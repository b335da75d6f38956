// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests walks over a collection in the order of place numbers.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "fixture.h"
#include "store/rows/place.h"

namespace watertight::test_walk {
using test::Database;
using test::sample_feature;

namespace {

StoredFeature at(const std::string& id, double x, double y, double width = 1) {
  StoredFeature feature = sample_feature(id);
  feature.box = store::StoredBox{{x, y, 0}, {x + width, y + width, 3}};
  return feature;
}

std::vector<std::string> walked_ids(SolidStore& store, std::uint64_t limit) {
  std::vector<std::string> ids;
  std::string after;
  do {
    const auto batch = store.walk("buildings", limit, after);
    REQUIRE(batch);
    REQUIRE(batch->features.size() <= limit);
    REQUIRE_FALSE(batch->features.empty());
    for (const StoredFeature& feature : batch->features) ids.push_back(feature.id);
    after = batch->next;
  } while (!after.empty());
  return ids;
}

store::StoredBox square(double x, double y, double width) {
  return store::StoredBox{{x, y, 0}, {x + width, y + width, 3}};
}

}  // namespace

TEST_CASE("the place number runs through all cells, each beside the one before") {
  for (const double unit : {0.5, 1.0 / 2097152}) {
    std::map<std::int64_t, std::pair<int, int>> cells;
    for (int x = 0; x < 64; ++x) {
      for (int y = 0; y < 64; ++y) {
        // The cells of half a unit are tested away from the origin.
        const double shift = unit == 0.5 ? 1024 : 0;
        cells[store::place_number(square(shift + x * unit, shift + y * unit, unit / 2))] = {x, y};
      }
    }
    REQUIRE(cells.size() == 64 * 64);
    CHECK(cells.rbegin()->first - cells.begin()->first == 64 * 64 - 1);
    auto before = cells.begin()->second;
    for (const auto& [place, cell] : cells) {
      CHECK(std::abs(cell.first - before.first) + std::abs(cell.second - before.second) <= 1);
      before = cell;
    }
  }
}

TEST_CASE("any finite box has a place number, and a feature without a box comes last") {
  for (const double value : {0.0, 5e-324, 360.0, 1e9, 536870912.0, 1e19, 1.7e308}) {
    for (const store::StoredBox& box : {store::StoredBox{{-value, -value, 0}, {value, value, 0}},
                                        store::StoredBox{{value, -value, 0}, {value, value, 0}},
                                        store::StoredBox{{-value, value, 0}, {-value, value, 0}}}) {
      CHECK(store::place_number(box) >= 0);
      CHECK(store::place_number(box) < store::kNoPlace);
    }
  }
  CHECK(store::place_number(std::nullopt) == store::kNoPlace);
}

TEST_CASE("a walk visits each feature once, in order of place number") {
  const Database database;
  const auto store = database.store();
  std::vector<StoredFeature> features;
  std::vector<std::pair<std::int64_t, std::string>> expected;
  for (int i = 0; i < 200; ++i) {
    const std::string id = "b" + std::to_string(i * 7919 % 200);
    features.push_back(at(id, 85'000 + 37.25 * (i % 20), -450'000 + 41.5 * (i / 20), 4));
    expected.emplace_back(store::place_number(features.back().box), id);
  }
  REQUIRE(store->put(features));
  std::sort(expected.begin(), expected.end());
  std::vector<std::string> ids;
  for (const auto& [place, id] : expected) ids.push_back(id);
  for (const std::uint64_t limit : {1U, 7U, 200U, 1000U}) {
    CHECK(walked_ids(*store, limit) == ids);
  }
  const auto batch = store->walk("buildings", 3, "");
  REQUIRE(batch);
  REQUIRE(batch->features.size() == 3);
  CHECK(batch->features[0].solids.size() == 2);
  CHECK(batch->features[0].header == "{\"type\":\"CityJSON\"}");
  // A feature that moves is found at its new place number.
  features[0].box = square(-1e6, -1e6, 1);
  REQUIRE(store->put({&features[0], 1}));
  CHECK(walked_ids(*store, 200).front() == features[0].id);
}

TEST_CASE("a walk takes boxes of any size and unit, and none at the end, by id") {
  const Database database;
  const auto store = database.store();
  std::vector<StoredFeature> features{at("b", 1, 1), at("a", 1, 1), at("ä", 1, 1)};
  for (const char* id : {"no-box-2", "no-box-1"}) {
    features.push_back(sample_feature(id));
    features.back().box.reset();
  }
  for (const double extreme : {1e308, 5e-324, 1e9, 1073741824.0}) {
    const std::string name = std::to_string(features.size());
    features.push_back(sample_feature("x" + name));
    features.back().box =
        store::StoredBox{{-extreme, -extreme, -extreme}, {extreme, extreme, extreme}};
    features.push_back(sample_feature("y" + name));
    features.back().box = store::StoredBox{{extreme, -extreme, 0}, {extreme, -extreme, extreme}};
  }
  REQUIRE(store->put(features));
  for (const std::uint64_t limit : {1U, 4U, 100U}) {
    std::vector<std::string> ids = walked_ids(*store, limit);
    REQUIRE(ids.size() == features.size());
    const auto first = std::find(ids.begin(), ids.end(), "a");
    REQUIRE(ids.end() - first > 4);
    CHECK(std::vector<std::string>(first, first + 3) == std::vector<std::string>{"a", "b", "ä"});
    CHECK(std::vector<std::string>(ids.end() - 2, ids.end()) ==
          std::vector<std::string>{"no-box-1", "no-box-2"});
    std::sort(ids.begin(), ids.end());
    CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
  }
}

TEST_CASE("degrees are distinguished to a hand's breadth") {
  const Database database;
  const auto store = database.store();
  // Two rows of buildings, 1 metre and 100 km apart: each row stays together in the walk.
  std::vector<StoredFeature> features;
  for (int i = 0; i < 8; ++i) {
    features.push_back(at("a" + std::to_string(9 - i), 18.4 + 1e-5 * i, -33.9, 1e-6));
    features.push_back(at("b" + std::to_string(i), 18.4 + 1e-5 * i, -32.9, 1e-6));
  }
  REQUIRE(store->put(features));
  const std::vector<std::string> ids = walked_ids(*store, 100);
  const std::vector<std::string> first(ids.begin(), ids.begin() + 8);
  const bool is_a = first[0][0] == 'a';
  CHECK(std::all_of(first.begin(), first.end(),
                    [&](const auto& id) { return (id[0] == 'a') == is_a; }));
}

TEST_CASE("a batch ends at 16 MiB, but has one feature at least") {
  const Database database;
  const auto store = database.store();
  std::vector<StoredFeature> features;
  for (int i = 0; i < 5; ++i) {
    // All features have one place number, so ids decide.
    features.push_back(at("b" + std::to_string(i), 1000, 0));
    features.back().solids[0].blob.resize(i == 2 ? 20U << 20U : 7U << 20U);
  }
  REQUIRE(store->put(features));
  std::vector<std::size_t> sizes;
  std::string after;
  do {
    const auto batch = store->walk("buildings", 100, after);
    REQUIRE(batch);
    sizes.push_back(batch->features.size());
    after = batch->next;
  } while (!after.empty());
  CHECK(sizes == std::vector<std::size_t>{2, 1, 2});
}

TEST_CASE("a walk goes on where features were put and removed meanwhile") {
  const Database database;
  const auto store = database.store();
  REQUIRE(store->put(std::vector{at("a", 1000, 0), at("b", 2000, 0), at("c", 3000, 0)}));
  const auto first = store->walk("buildings", 2, "");
  REQUIRE(first);
  REQUIRE(store->remove("buildings", "b"));
  REQUIRE(store->put(std::vector{at("before", 500, 0), at("after", 4000, 0)}));
  const auto second = store->walk("buildings", 10, first->next);
  REQUIRE(second);
  REQUIRE(second->features.size() == 2);
  CHECK(second->features[0].id == "c");
  CHECK(second->features[1].id == "after");
  CHECK(second->next.empty());
}

TEST_CASE("a walk starts only where a batch ended") {
  const Database database;
  const auto store = database.store();
  CHECK(store->walk("none", 10, "").error().code == ErrorCode::not_found);
  CHECK(store->walk("no/ne", 10, "").error().code == ErrorCode::not_found);
  REQUIRE(store->put(std::vector{at("a", 1000, 0)}));
  for (const char* after : {"a", ":a", "12", "12:", "-1:a", "99999999999999999999:a", "1:\xFF"}) {
    const auto batch = store->walk("buildings", 10, after);
    REQUIRE_FALSE(batch);
    CHECK(batch.error().code == ErrorCode::invalid_argument);
  }
  const auto past = store->walk("buildings", 10, "9223372036854775807:zz");
  REQUIRE(past);
  CHECK(past->features.empty());
  CHECK(past->next.empty());
}

TEST_CASE("an index serves walks") {
  const Database database;
  const auto store = database.store();
  database.add_many_features();
  database.ask("ANALYZE watertight.feature_row");
  const std::string plan = database.ask(
      "EXPLAIN (FORMAT JSON) SELECT id FROM watertight.feature_row WHERE collection = 1"
      " AND place >= 4000000 AND (place, id) > (4000000, 'x') ORDER BY place, id LIMIT 500");
  CHECK(plan.find("feature_place") != std::string::npos);
  CHECK(plan.find("\"Sort\"") == std::string::npos);  // only features of one place are sorted
}

TEST_CASE("the documents of a collection are listed, as many as were asked for") {
  const Database database;
  const auto store = database.store();
  CHECK(store->documents("buildings", 5)->empty());
  std::vector<StoredFeature> features{at("a", 0, 0), at("b", 0, 0), at("c", 0, 0)};
  features[1].header = "{\"other\":1}";
  features[2].format = "obj";
  REQUIRE(store->put(features));
  const auto documents = store->documents("buildings", 5);
  REQUIRE(documents);
  REQUIRE(documents->size() == 3);
  CHECK(documents->back().format == "obj");
  CHECK(store->documents("buildings", 2)->size() == 2);
}

TEST_CASE("places are those of all features with a box, page by page") {
  const Database database;
  const auto opened = database.store();
  auto& store = *opened;
  std::vector<StoredFeature> features;
  for (int i = 0; i < 25; ++i) features.push_back(at("f" + std::to_string(i), i * 10, 5, 1 + i));
  features.push_back(sample_feature("none"));
  features.back().box.reset();
  REQUIRE(store.put(features));
  std::string after;
  std::map<double, std::int64_t> numbers;
  do {
    const auto page = store.places("buildings", 7, after, false);
    REQUIRE(page);
    for (const auto& placed : page->features) {
      CHECK(numbers.emplace(placed.box.min[0], placed.number).second);
      CHECK(store::plane_size(placed.box) == 1 + placed.box.min[0] / 10);
      CHECK(placed.bytes > 0);
    }
    after = page->next;
  } while (!after.empty());
  CHECK(numbers.size() == 25);
  CHECK_FALSE(store.places("nowhere", 7, "", false));
}

TEST_CASE("ranked features are those of a part of the plane, the largest first") {
  const Database database;
  const auto opened = database.store();
  auto& store = *opened;
  std::vector<StoredFeature> features;
  for (int i = 0; i < 20; ++i)
    features.push_back(at("f" + std::to_string(i), 0, 0, i < 10 ? 2 : 1));
  features.push_back(at("far", 1000, 1000, 3));
  features.push_back(at("endless", 1e308, -1e308, 1e307));
  features.push_back(at("edge", 9.5, 0, 1));  // its middle is on the upper bound
  REQUIRE(store.put(features));
  store::RankQuery query{"buildings", {0, 0}, {10, 10}, {0, INT64_MIN}, std::nullopt};
  const auto all = store.ranked(query, 100);
  REQUIRE(all);
  CHECK(all->size() == 20);
  query.max = {10.25, 10};
  CHECK(store.ranked(query, 100)->size() == 21);
  query.max = {10, 10};

  // Cut at any rank, the two parts are all features.
  std::map<std::int64_t, double> ranks;
  const auto all_places = store.places("buildings", 100, "", false);
  REQUIRE(all_places);
  for (const auto& placed : all_places->features) {
    if (placed.box.min[0] == 0) ranks[placed.number] = store::plane_size(placed.box);
  }
  REQUIRE(ranks.size() == 20);
  for (const auto& [number, size] : ranks) {
    store::RankQuery upper = query;
    upper.from = {size, number};
    store::RankQuery lower = query;
    lower.below = store::SizeRank{size, number};
    auto joined = *store.ranked(upper, 100);
    const auto rest = *store.ranked(lower, 100);
    joined.insert(joined.end(), rest.begin(), rest.end());
    CHECK(joined == *all);
  }
  CHECK(store.ranked(query, 3)->size() == 3);
  query.only_unproven = true;
  CHECK(store.ranked(query, 100)->empty());
  query.collection = "nowhere";
  CHECK_FALSE(store.ranked(query, 3));
}

TEST_CASE("features that are not proven are placed and ranked by themselves") {
  const Database database;
  const auto opened = database.store();
  auto& store = *opened;
  std::vector<StoredFeature> features;
  for (int i = 0; i < 10; ++i) features.push_back(at("f" + std::to_string(i), i, 0, 1));
  for (const std::size_t i : {2U, 5U, 7U}) features[i].has_findings = true;
  REQUIRE(store.put(features));
  std::vector<double> found;
  std::string after;
  do {
    const auto page = store.places("buildings", 2, after, true);
    REQUIRE(page);
    for (const auto& placed : page->features) found.push_back(placed.box.min[0]);
    after = page->next;
  } while (!after.empty());
  std::ranges::sort(found);
  CHECK(found == std::vector<double>{2, 5, 7});
  store::RankQuery query{"buildings", {0, 0}, {100, 10}, {0, INT64_MIN}, std::nullopt};
  query.only_unproven = true;
  auto ids = *store.ranked(query, 100);
  std::ranges::sort(ids);
  CHECK(ids == std::vector<std::string>{"f2", "f5", "f7"});
}

}  // namespace watertight::test_walk
