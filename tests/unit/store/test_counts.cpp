// SPDX-License-Identifier: GPL-3.0-or-later
//
// The counts and boxes of collections, which every write keeps, against those of the features.
#include <catch2/catch_test_macros.hpp>
#include <random>
#include <set>
#include <thread>

#include "fixture.h"

namespace watertight::test_counts {
using test::Database;
using test::sample_feature;

namespace {

/// The counts of collection "buildings", from the store.
std::string kept(SolidStore& store) {
  const auto collection = store.collection("buildings");
  REQUIRE(collection);
  return std::to_string(collection->features) + " " + std::to_string(collection->solids) + " " +
         std::to_string(collection->blob_bytes);
}

/// The same, counted in the tables.
std::string counted(const Database& database) {
  return database.ask(
      "SELECT count(*) || ' ' || coalesce(sum(solids), 0) || ' ' || coalesce(sum(blob_bytes), 0)"
      " FROM watertight.feature WHERE collection = 'buildings'");
}

StoredFeature feature_at(const std::string& id, double x, std::size_t solids = 2) {
  StoredFeature feature = sample_feature(id);
  feature.box = store::StoredBox{{x, 0, 0}, {x + 1, 1, 1}};
  feature.solids.resize(solids);
  return feature;
}

}  // namespace

TEST_CASE("counts of a collection are those of its features after every kind of write") {
  const Database database;
  const auto store = database.store();
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    std::vector<StoredFeature> batch;
    const auto first = random() % 40;
    for (unsigned i = 0; i < 1 + random() % 5; ++i) {
      batch.push_back(
          feature_at("f" + std::to_string(first + i), static_cast<double>(first), random() % 3));
    }
    REQUIRE(store->put(batch));
    if (round % 3 == 0) {
      const Status removed = store->remove("buildings", "f" + std::to_string(random() % 45));
      CHECK((removed || removed.error().code == ErrorCode::not_found));
    }
    if (round % 20 == 0) CHECK(kept(*store) == counted(database));
  }
  CHECK(kept(*store) == counted(database));
  // 300 writes and more were summed up after each hundred.
  CHECK(std::stoi(database.ask("SELECT count(*)::text FROM watertight.collection_change")) < 400);
}

TEST_CASE("counts stay right under writers of the same features") {
  const Database database;
  const auto store = database.store(4);
  std::atomic<int> failures{0};
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      std::mt19937 random(t);
      for (int i = 0; i < 120; ++i) {
        const std::string id = "f" + std::to_string(random() % 6);
        const StoredFeature feature = feature_at(id, 0, random() % 3);
        if (random() % 3 == 0) {
          const Status removed = store->remove("buildings", id);
          if (!removed && removed.error().code != ErrorCode::not_found) ++failures;
        } else if (!store->put(std::span(&feature, 1))) {
          ++failures;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(failures == 0);
  CHECK(kept(*store) == counted(database));
}

TEST_CASE("the box of a collection holds all features, and fits them after a recount") {
  const Database database;
  const auto store = database.store();
  for (int i = 0; i < 3; ++i) {
    const StoredFeature feature = feature_at("f" + std::to_string(i), 10.0 * i);
    REQUIRE(store->put(std::span(&feature, 1)));
  }
  CHECK(store->collection("buildings")->box->min[0] == 0);
  CHECK(store->collection("buildings")->box->max[0] == 21);
  REQUIRE(store->remove("buildings", "f0"));
  CHECK(store->collection("buildings")->box->min[0] <= 10);
  const auto recounted = store->recount("buildings");
  REQUIRE(recounted);
  CHECK(recounted->box->min[0] == 10);
  CHECK(recounted->features == 2);
  CHECK(kept(*store) == counted(database));
  for (const char* id : {"f1", "f2"}) REQUIRE(store->remove("buildings", id));
  CHECK_FALSE(store->collection("buildings")->box);
  REQUIRE(store->recount("buildings"));
  const StoredFeature far = feature_at("far", 1000);
  REQUIRE(store->put(std::span(&far, 1)));
  CHECK(store->collection("buildings")->box->min[0] == 1000);
  CHECK(store->recount("nothing").error().code == ErrorCode::not_found);
}

TEST_CASE("the documents of a collection are found without reading its features") {
  const Database database;
  const auto store = database.store();
  database.add_many_features();
  for (int i = 0; i < 3; ++i) {
    StoredFeature feature = feature_at("f" + std::to_string(i), i);
    feature.collection = "c";
    feature.srid = 0;
    feature.header = "header " + std::to_string(i % 2);
    REQUIRE(store->put(std::span(&feature, 1)));
  }
  CHECK(store->documents("c", 10)->size() == 3);
  CHECK(store->documents("c", 2)->size() == 2);
  CHECK(store->documents("nothing", 10)->empty());
}

TEST_CASE(
    "the state of a collection changes with every change of its features, and with no other") {
  const Database database;
  const auto store = database.store();
  const auto state = [&] {
    const auto collection = store->collection("buildings");
    REQUIRE(collection);
    return collection->state;
  };
  REQUIRE(store->put(std::vector{feature_at("a", 1)}));
  std::set<std::string> states{state()};
  REQUIRE(store->put(std::vector{feature_at("a", 1)}));  // replaced by an equal one: a new version
  CHECK(states.insert(state()).second);
  REQUIRE(store->put(std::vector{feature_at("b", 2), feature_at("c", 3)}));
  CHECK(states.insert(state()).second);
  REQUIRE(store->remove("buildings", "b"));
  CHECK(states.insert(state()).second);
  const std::string before = state();
  REQUIRE(store->recount("buildings"));
  CHECK(state() == before);
  for (int i = 0; i < 120; ++i) {  // more writes than are summed up at once
    REQUIRE(store->put(std::vector{feature_at("a", 1)}));
    CHECK(states.insert(state()).second);
  }
  REQUIRE(store->remove_collection("buildings", {}));
  REQUIRE(store->put(std::vector{feature_at("a", 1)}));
  CHECK(states.insert(state()).second);
}

}  // namespace watertight::test_counts
