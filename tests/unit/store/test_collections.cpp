// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pages of collections, and collections that are removed or renamed.
#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <thread>

#include "fixture.h"

namespace watertight::test_collections {
using test::Database;
using test::sample_feature;

namespace {

StoredFeature feature_of(const std::string& collection, const std::string& id,
                         std::uint32_t srid = 7415) {
  StoredFeature feature = sample_feature(id);
  feature.collection = collection;
  feature.srid = srid;
  return feature;
}

void put_feature(SolidStore& store, const StoredFeature& feature) {
  const auto versions = store.put(std::span(&feature, 1));
  INFO((versions ? std::string() : to_string(versions.error())));
  REQUIRE(versions);
}

std::vector<std::string> ids_of(const store::CollectionPage& page) {
  std::vector<std::string> ids;
  for (const store::StoredCollection& collection : page.collections) ids.push_back(collection.id);
  return ids;
}

std::string rows_of(const Database& database, const std::string& table) {
  return database.ask("SELECT count(*)::text FROM watertight." + table);
}

}  // namespace

TEST_CASE("pages walk through all collections, each with its own counts") {
  const Database database;
  const auto store = database.store();
  for (const char* id : {"b", "a", "Z", "a.1", "_"}) {
    for (int i = 0; i < (id == std::string("a") ? 3 : 1); ++i) {
      put_feature(*store, feature_of(id, std::to_string(i)));
    }
  }
  const std::vector<std::string> expected{"Z", "_", "a", "a.1", "b"};
  for (const std::uint64_t limit : {1U, 2U, 5U, 6U}) {
    std::vector<std::string> ids;
    std::string after;
    do {
      const auto page = store->collections(limit, after);
      REQUIRE(page);
      REQUIRE(page->collections.size() <= limit);
      for (const store::StoredCollection& collection : page->collections) {
        CHECK(collection.features == (collection.id == "a" ? 3U : 1U));
        CHECK(collection.solids == 2 * collection.features);
        ids.push_back(collection.id);
      }
      after = page->next;
    } while (!after.empty());
    CHECK(ids == expected);
  }
  CHECK(store->collections(0, "")->collections.empty());
  CHECK(store->collections(5, "\xFF").error().code == ErrorCode::invalid_argument);
}

TEST_CASE("a collection is made before its first feature, with its CRS, policy and rules") {
  const Database database;
  const auto store = database.store();
  REQUIRE(store->make_collection("town", 7415));
  CHECK(store->make_collection("town", 7415).error().code == ErrorCode::conflict);
  CHECK(store->make_collection("no/name", 0).error().code == ErrorCode::invalid_argument);
  CHECK(store->set_rules("none", "x").error().code == ErrorCode::not_found);
  const auto made = store->collection("town");
  REQUIRE(made);
  CHECK(made->srid == 7415);
  CHECK(made->features == 0);
  CHECK(made->header.empty());
  CHECK(made->rules.empty());
  REQUIRE(store->set_rules("town", "planarity=0.02\n"));
  const auto changed = store->collection("town");
  REQUIRE(changed);
  CHECK(changed->rules == "planarity=0.02\n");
  CHECK(changed->state != made->state);
  REQUIRE(store->set_rules("town", "planarity=0.02\n"));
  CHECK(store->collection("town")->state == changed->state);
  // Another session sees them; so do pages and a recount; a rename keeps them.
  CHECK(database.store()->collections(10, "")->collections[0].rules == "planarity=0.02\n");
  CHECK(store->recount("town")->rules == "planarity=0.02\n");
  CHECK(store->list({"town", 10, {}, {}, 0, {}, {}})->features.empty());
  put_feature(*store, feature_of("town", "a"));
  const StoredFeature other = feature_of("town", "b", 28992);
  CHECK(store->put(std::span(&other, 1)).error().code == ErrorCode::conflict);
  REQUIRE(store->rename_collection("town", "city"));
  CHECK(store->collection("city")->rules == "planarity=0.02\n");
  CHECK(store->collection("city")->features == 1);
  REQUIRE(store->remove_collection("city", {}));
  REQUIRE(store->make_collection("city", 0));
  CHECK(store->collection("city")->rules.empty());
}

TEST_CASE("features with the box of another one are found, in their own collection only") {
  const Database database;
  const auto store = database.store();
  const auto at = [](const std::string& collection, const std::string& id, double x) {
    StoredFeature feature = feature_of(collection, id);
    feature.box = store::StoredBox{{x, 0, 0}, {x + 1, 1, 1}};
    return feature;
  };
  for (const auto& feature :
       {at("town", "a", 0), at("town", "b", 0), at("town", "c", 5), at("other", "d", 5),
        at("town", "e", 0), at("town", "near", std::nextafter(5.0, 6.0))}) {
    put_feature(*store, feature);
  }
  StoredFeature without = feature_of("town", "x");
  without.box.reset();
  put_feature(*store, without);
  without.id = "y";
  put_feature(*store, without);
  const std::vector<std::string> all{"a", "b", "c", "d", "e", "near", "x", "y", "none"};
  const auto found = store->twins("town", all);
  REQUIRE(found);
  std::string text;
  for (const store::Twins& twins : *found) text += twins.id + "=" + twins.other + " ";
  CHECK(text == "a=b b=a e=a ");
  const std::vector<std::string> one{"c"};
  CHECK(store->twins("town", one)->empty());
  CHECK(store->twins("town", {})->empty());
  CHECK(store->twins("none", one).error().code == ErrorCode::not_found);
}

TEST_CASE("a removed collection is gone with its features, its CRS and its header") {
  const Database database;
  const auto store = database.store();
  CHECK(store->remove_collection("c", {}).error().code == ErrorCode::not_found);
  CHECK(store->remove_collection("no/ne", {}).error().code == ErrorCode::not_found);
  std::vector<StoredFeature> features;
  for (int i = 0; i < 2500; ++i) features.push_back(feature_of("c", "f" + std::to_string(i)));
  REQUIRE(store->put(features));
  put_feature(*store, feature_of("other", "x"));
  REQUIRE(store->remove_collection("c", {}));
  CHECK(store->collection("c").error().code == ErrorCode::not_found);
  CHECK(store->get("c", "f1").error().code == ErrorCode::not_found);
  CHECK(store->list({"c", 10, "", {}}).error().code == ErrorCode::not_found);
  CHECK(store->walk("c", 10, "").error().code == ErrorCode::not_found);
  CHECK(ids_of(*store->collections(10, "")) == std::vector<std::string>{"other"});
  CHECK(rows_of(database, "feature") == "1");
  CHECK(rows_of(database, "solid") == "2");
  CHECK(rows_of(database, "collection") == "1");
  CHECK(store->remove_collection("c", {}).error().code == ErrorCode::not_found);
  StoredFeature elsewhere = feature_of("c", "f1", 28992);
  elsewhere.header = "{\"another\":1}";
  put_feature(*store, elsewhere);
  const auto collection = store->collection("c");
  REQUIRE(collection);
  CHECK(collection->srid == 28992);
  CHECK(collection->header == elsewhere.header.str());
  CHECK(collection->features == 1);
}

TEST_CASE("a removal that is cancelled is whole all the same, and later writes delete its rows") {
  const Database database;
  const auto store = database.store();
  std::vector<StoredFeature> features;
  for (int i = 0; i < 3500; ++i) features.push_back(feature_of("c", "f" + std::to_string(i)));
  REQUIRE(store->put(features));
  CHECK(store->remove_collection("c", [] { return true; }).error().code == ErrorCode::cancelled);
  CHECK(store->collection("c")->features == 3500);
  int polls = 0;
  REQUIRE(store->remove_collection("c", [&] { return ++polls > 2; }));
  CHECK(store->collection("c").error().code == ErrorCode::not_found);
  CHECK(rows_of(database, "feature") == "2500");
  // The new collection of this name has none of the old rows.
  put_feature(*store, feature_of("c", "f3000", 28992));
  CHECK(store->collection("c")->features == 1);
  CHECK(store->list({"c", 10, "", {}})->features.size() == 1);
  for (int i = 0; i < 4; ++i) {
    const auto again = database.store();  // a store deletes some of them after its first write
    put_feature(*again, feature_of("c", "f3000", 28992));
  }
  CHECK(rows_of(database, "feature") == "1");
  CHECK(rows_of(database, "collection") == "1");
  CHECK(store->recount("c")->features == 1);
}

TEST_CASE("a renamed collection is the same under its new id") {
  const Database database;
  const auto store = database.store();
  put_feature(*store, feature_of("a", "x"));
  put_feature(*store, feature_of("b", "y"));
  CHECK(store->rename_collection("none", "c").error().code == ErrorCode::not_found);
  CHECK(store->rename_collection("a", "b").error().code == ErrorCode::conflict);
  CHECK(store->rename_collection("a", "no/ne").error().code == ErrorCode::invalid_argument);
  CHECK(store->rename_collection("no/ne", "c").error().code == ErrorCode::not_found);
  const std::uint64_t version = *store->version("a", "x");
  REQUIRE(store->rename_collection("a", "c"));
  CHECK(store->collection("a").error().code == ErrorCode::not_found);
  CHECK(store->get("c", "x")->version == version);
  CHECK(store->get("c", "x")->solids.size() == 2);
  CHECK(ids_of(*store->collections(10, "")) == std::vector<std::string>{"b", "c"});
  // The old id is free, and names another collection now.
  put_feature(*store, feature_of("a", "z", 28992));
  put_feature(*store, feature_of("c", "w"));
  CHECK(store->collection("a")->features == 1);
  CHECK(store->collection("c")->features == 2);
  CHECK(store->get("a", "x").error().code == ErrorCode::not_found);
  REQUIRE(store->rename_collection("c", "c"));
  CHECK(store->documents("c", 10)->size() == 1);
  CHECK(store->recount("c")->features == 2);
  REQUIRE(store->remove("c", "x"));
  CHECK(store->collection("c")->features == 1);
}

TEST_CASE("writers beside removals get the old collection or a new one, never a mixture") {
  const Database database;
  const auto store = database.store(5);
  std::atomic<int> failures{0};
  std::atomic<bool> stop{false};
  std::vector<std::thread> writers;
  for (int t = 0; t < 3; ++t) {
    writers.emplace_back([&, t] {
      // Each writer has a CRS of its own: it is refused while the collection has another.
      for (int i = 0; !stop; ++i) {
        const std::vector<StoredFeature> batch{
            feature_of("c", std::to_string(i % 7), static_cast<std::uint32_t>(t)),
            feature_of("c", std::to_string(i % 7 + 1), static_cast<std::uint32_t>(t))};
        const auto put = store->put(batch);
        if (!put && put.error().code != ErrorCode::conflict) ++failures;
      }
    });
  }
  int removed = 0;
  for (int round = 0; round < 60; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const Status gone = round % 2 == 0 ? store->remove_collection("c", {})
                                       : store->rename_collection("c", "d" + std::to_string(round));
    if (!gone && gone.error().code != ErrorCode::not_found) ++failures;
    if (gone) ++removed;
    const auto walked = store->walk("c", 100, "");
    if (!walked) continue;
    for (const StoredFeature& feature : walked->features) {
      if (feature.srid != walked->features.front().srid) ++failures;
    }
  }
  stop = true;
  for (std::thread& writer : writers) writer.join();
  CHECK(failures == 0);
  CHECK(removed > 20);
  CHECK(database.ask("SELECT count(*)::text FROM watertight.feature WHERE collection IS NULL") ==
        "0");
}

}  // namespace watertight::test_collections
