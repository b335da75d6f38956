// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <limits>
#include <random>
#include <thread>

#include "fixture.h"

namespace watertight::test::test_store {
namespace {

ErrorCode put_failure(SolidStore& store, std::vector<StoredFeature> features) {
  const auto result = store.put(features);
  REQUIRE(!result);
  CHECK(!result.error().message.empty());
  return result.error().code;
}

std::uint64_t put_one(SolidStore& store, const StoredFeature& feature) {
  const auto versions = store.put(std::span(&feature, 1));
  INFO((versions ? std::string() : to_string(versions.error())));
  REQUIRE(versions);
  REQUIRE(versions->size() == 1);
  return versions->front();
}

/// The ids of all pages, sorted.
std::vector<std::string> all_ids(SolidStore& store, store::FeatureQuery query) {
  std::vector<std::string> ids;
  do {
    const auto page = store.list(query);
    REQUIRE(page);
    CHECK(page->features.size() <= query.limit);
    for (const store::FeatureSummary& feature : page->features) ids.push_back(feature.id);
    query.after = page->next;
  } while (!query.after.empty());
  std::sort(ids.begin(), ids.end());  // pages are in order of hashes
  return ids;
}

}  // namespace

TEST_CASE("get returns what put stored, byte for byte") {
  const Database database;
  const auto store = database.store();
  const StoredFeature sent = sample_feature("NL.IMBAG.Pand.0363100012185598");
  const std::uint64_t version = put_one(*store, sent);
  const auto got = store->get("buildings", sent.id);
  REQUIRE(got);
  CHECK(got->version == version);
  CHECK(got->collection == sent.collection);
  CHECK(got->id == sent.id);
  CHECK(got->type == sent.type);
  CHECK(got->format == sent.format);
  CHECK(got->srid == sent.srid);
  CHECK(got->header == sent.header);
  CHECK(got->skeleton == sent.skeleton);
  REQUIRE(got->box);
  CHECK(got->box->min == sent.box->min);
  CHECK(got->box->max == sent.box->max);
  REQUIRE(got->solids.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(got->solids[i].object_id == sent.solids[i].object_id);
    CHECK(got->solids[i].geometry == 3);
    CHECK(got->solids[i].ordinal == sent.solids[i].ordinal);
    CHECK(got->solids[i].lod == "2.2");
    CHECK(got->solids[i].blob == sent.solids[i].blob);
  }
}

TEST_CASE("a feature without solids, box or texts comes back as it was") {
  const Database database;
  const auto store = database.store();
  StoredFeature sent;
  sent.collection = "c";
  sent.id = "x";
  put_one(*store, sent);
  const auto got = store->get("c", "x");
  REQUIRE(got);
  CHECK(!got->box);
  CHECK(got->solids.empty());
  CHECK(got->skeleton.bytes.empty());
  CHECK(got->header.empty());
  const auto collection = store->collection("c");
  REQUIRE(collection);
  CHECK(!collection->box);
}

TEST_CASE("put replaces a feature, raises its version and never uses one twice") {
  const Database database;
  const auto store = database.store();
  StoredFeature feature = sample_feature("a");
  const std::uint64_t first = put_one(*store, feature);
  feature.solids.pop_back();
  feature.header = "{\"type\":\"CityJSON\",\"version\":\"2.0\"}";
  const std::uint64_t second = put_one(*store, feature);
  CHECK(second > first);
  const auto got = store->get("buildings", "a");
  REQUIRE(got);
  CHECK(got->solids.size() == 1);
  CHECK(got->header == feature.header);
  REQUIRE(store->remove("buildings", "a"));
  CHECK(put_one(*store, feature) > second);
}

TEST_CASE("a collection counts its features, solids and bytes and spans their boxes") {
  const Database database;
  const auto store = database.store();
  StoredFeature a = sample_feature("a");
  StoredFeature b = sample_feature("b");
  b.box = store::StoredBox{{-5, 7, 2}, {-4, 8, 3}};
  REQUIRE(store->put(std::vector{a, b}));
  const auto collection = store->collection("buildings");
  REQUIRE(collection);
  CHECK(collection->features == 2);
  CHECK(collection->solids == 4);
  CHECK(collection->blob_bytes == 16);
  CHECK(collection->srid == 7415);
  CHECK(collection->header == a.header);
  REQUIRE(collection->box);
  CHECK(collection->box->min == std::array<double, 3>{-5, 0, 0});
  CHECK(collection->box->max == std::array<double, 3>{1, 8, 1e9});
  const auto all = store->collections(10, "");
  REQUIRE(all);
  REQUIRE(all->collections.size() == 1);
  CHECK(all->collections.front().id == "buildings");
  CHECK(all->next.empty());
}

TEST_CASE("put stores all features or none") {
  const Database database;
  const auto store = database.store();
  StoredFeature good = sample_feature("good");
  StoredFeature bad = sample_feature("bad");
  bad.solids[1].report = "not part of the text";
  CHECK(put_failure(*store, {good, bad}) == ErrorCode::invalid_argument);
  CHECK(put_failure(*store, {good, good}) == ErrorCode::conflict);
  StoredFeature elsewhere = sample_feature("elsewhere");
  elsewhere.srid = 28992;
  CHECK(put_failure(*store, {good, elsewhere}) == ErrorCode::conflict);
  CHECK(!store->get("buildings", "good"));
  CHECK(!store->collection("buildings"));
  CHECK(database.ask("SELECT count(*)::text FROM watertight.feature") == "0");
  CHECK(database.ask("SELECT count(*)::text FROM watertight.document") == "0");
}

TEST_CASE("text that the database cannot hold is an error, never another text") {
  const Database database;
  const auto store = database.store();
  for (const std::string& text :
       {std::string("nul\0here", 8), std::string("\xC3"), std::string("\xC0\x80"),
        std::string("\xED\xA0\x80"), std::string("\xF5\x80\x80\x80"), std::string("\xFFx")}) {
    StoredFeature feature = sample_feature(text);
    CHECK(put_failure(*store, {feature}) == ErrorCode::invalid_argument);
    feature = sample_feature("a");
    feature.solids[0].object_id = text;
    CHECK(put_failure(*store, {feature}) == ErrorCode::invalid_argument);
    feature = sample_feature("a");
    feature.type = text;
    CHECK(put_failure(*store, {feature}) == ErrorCode::invalid_argument);
    // A get of such an id reports that it is not found.
    const auto got = store->get("buildings", text);
    REQUIRE(!got);
    CHECK(got.error().code == ErrorCode::not_found);
    const Status removed = store->remove("buildings", text);
    REQUIRE(!removed);
    CHECK(removed.error().code == ErrorCode::not_found);
    CHECK(!store->list({"buildings", 10, text, {}}));
  }
  CHECK(put_failure(*store, {sample_feature("")}) == ErrorCode::invalid_argument);
  CHECK(put_failure(*store, {sample_feature(std::string(1025, 'x'))}) ==
        ErrorCode::invalid_argument);
  put_one(*store, sample_feature(std::string(1019, 'x')));
  put_one(*store, sample_feature("it's \"é\" \\ 𝄞"));
  CHECK(store->get("buildings", "it's \"é\" \\ 𝄞"));
}

TEST_CASE("the largest keys fit the index") {
  const Database database;
  const auto store = database.store();
  StoredFeature feature = sample_feature("x");
  std::mt19937 random(7);
  const auto incompressible = [&](std::size_t size) {
    std::string text(size, ' ');
    for (char& c : text) c = static_cast<char>(0x20 + random() % 0x5F);
    return text;
  };
  feature.id = incompressible(1024);
  feature.collection = std::string(64, 'c');
  for (StoredSolid& solid : feature.solids) solid.object_id = incompressible(1024);
  put_one(*store, feature);
  CHECK(store->get(feature.collection, feature.id));
}

TEST_CASE("collection ids and boxes that make no sense are refused") {
  const Database database;
  const auto store = database.store();
  for (const char* id : {"", "a b", "é", "a/b", "';--"}) {
    StoredFeature feature = sample_feature("a");
    feature.collection = id;
    CHECK(put_failure(*store, {feature}) == ErrorCode::invalid_argument);
    CHECK(store->collection(id).error().code == ErrorCode::not_found);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const store::StoredBox& box :
       {store::StoredBox{{0, 0, 0}, {1, 1, nan}}, store::StoredBox{{0, 0, 0}, {1, infinity, 1}},
        store::StoredBox{{2, 0, 0}, {1, 1, 1}}}) {
    StoredFeature feature = sample_feature("a");
    feature.box = box;
    CHECK(put_failure(*store, {feature}) == ErrorCode::invalid_argument);
    CHECK(!store->list({"buildings", 10, "", box}));
  }
}

TEST_CASE("ids that no URL can name are refused") {
  const Database database;
  const auto store = database.store();
  for (const char* id : {".", ".."}) {
    const StoredFeature feature = sample_feature(id);
    CHECK(store->put(std::span(&feature, 1)).error().code == ErrorCode::invalid_argument);
  }
  for (const char* id : {"...", ".a", "%2E", "a\tb", "\x7f"}) {
    put_one(*store, sample_feature(id));
    CHECK(store->get("buildings", id));
  }
}

TEST_CASE("what does not exist is not found") {
  const Database database;
  const auto store = database.store();
  CHECK(store->get("nothing", "a").error().code == ErrorCode::not_found);
  CHECK(store->collection("nothing").error().code == ErrorCode::not_found);
  CHECK(store->list({"nothing", 10, "", {}}).error().code == ErrorCode::not_found);
  CHECK(store->remove("nothing", "a").error().code == ErrorCode::not_found);
  put_one(*store, sample_feature("a"));
  CHECK(store->get("buildings", "b").error().code == ErrorCode::not_found);
  REQUIRE(store->remove("buildings", "a"));
  CHECK(store->remove("buildings", "a").error().code == ErrorCode::not_found);
  CHECK(store->get("buildings", "a").error().code == ErrorCode::not_found);
  CHECK(database.ask("SELECT count(*)::text FROM watertight.solid") == "0");
  // The collection stays, although it is empty.
  const auto empty = store->list({"buildings", 10, "", {}});
  REQUIRE(empty);
  CHECK(empty->features.empty());
}

TEST_CASE("pages walk through all features once, in one order") {
  const Database database;
  const auto store = database.store();
  std::vector<std::string> ids{"Z", "a", "B",   "é",   "10",
                               "9", "_", "a-1", "a.1", "\xF0\x9D\x84\x9E"};
  std::vector<StoredFeature> features;
  for (const std::string& id : ids) features.push_back(sample_feature(id));
  const auto versions = store->put(features);
  REQUIRE(versions);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    CHECK(store->get("buildings", ids[i])->version == (*versions)[i]);
  }
  std::sort(ids.begin(), ids.end());
  for (const std::uint64_t limit : {1U, 3U, 9U, 10U, 11U}) {
    CHECK(all_ids(*store, {"buildings", limit, "", {}}) == ids);
  }
  const auto page = store->list({"buildings", 3, "", {}});
  REQUIRE(page);
  REQUIRE(page->features.size() == 3);
  CHECK(page->features[0].type == "Building");
  CHECK(page->features[0].solids == 2);
  CHECK(page->features[0].blob_bytes == 8);
  CHECK(page->features[0].box->max == features[0].box->max);
  CHECK(page->next == page->features[2].id);
  CHECK(store->list({"buildings", 0, "", {}})->features.empty());
}

TEST_CASE("features of any finite size are stored and found, and keep no others out") {
  const Database database;
  const auto store = database.store();
  const double sizes[] = {1e308, 1e200, 1e-200, 1e-307, 5e-324, 0, 1};
  for (int i = 0; i < 700; ++i) {
    StoredFeature feature = sample_feature("f" + std::to_string(1000 + i));
    const double size = sizes[i % 7];
    feature.box = store::StoredBox{{-size, -size, -size}, {size, size, size}};
    const auto versions = store->put(std::span(&feature, 1));
    INFO((versions ? std::string() : to_string(versions.error())));
    REQUIRE(versions);
  }
  const auto count = [&](const store::StoredBox& box) {
    const auto found = store->list({"buildings", 1000, "", box});
    INFO((found ? std::string() : to_string(found.error())));
    REQUIRE(found);
    return found->features.size();
  };
  CHECK(count({{0, 0, 0}, {0, 0, 0}}) == 700);
  CHECK(count({{0.5, 0.5, 0.5}, {1, 1, 1}}) == 300);
  CHECK(count({{1e307, 1e307, 1e307}, {1.5e308, 1.5e308, 1.5e308}}) == 100);
  CHECK(count({{1.5e308, 1.5e308, 0}, {1.6e308, 1.6e308, 1}}) == 0);
  CHECK(count({{1e-323, 1e-323, 0}, {1e-323, 1e-323, 1}}) == 500);
}

TEST_CASE("a box finds exactly the features whose closed boxes share a point with it") {
  const Database database;
  const auto store = database.store();
  std::mt19937 random(11);
  const auto coordinate = [&] { return static_cast<double>(random() % 12) - 3; };
  const auto random_box = [&] {
    store::StoredBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.min[axis] = coordinate();
      box.max[axis] = box.min[axis] + static_cast<double>(random() % 3);
    }
    return box;
  };
  std::vector<StoredFeature> features;
  for (int i = 0; i < 400; ++i) {
    features.push_back(sample_feature("f" + std::to_string(1000 + i)));
    features.back().box = random_box();
    if (i % 10 == 0) features.back().box.reset();
  }
  REQUIRE(store->put(features));
  for (int round = 0; round < 40; ++round) {
    store::StoredBox box = random_box();
    if (round % 4 == 0)
      box.max[0] = std::nextafter(box.max[0], -100);  // the box ends one step before it would touch
    if (box.max[0] < box.min[0]) box.max[0] = box.min[0];
    std::vector<std::string> expected;
    for (const StoredFeature& feature : features) {
      bool meets = feature.box.has_value();
      for (std::size_t axis = 0; meets && axis < 3; ++axis) {
        meets = feature.box->min[axis] <= box.max[axis] && box.min[axis] <= feature.box->max[axis];
      }
      if (meets) expected.push_back(feature.id);
    }
    CHECK(all_ids(*store, {"buildings", 50, "", box}) == expected);
    CHECK(all_ids(*store, {"buildings", 1, "", box}) == expected);
    for (const double share : {0.5, 1.0}) {  // other plans
      CHECK(all_ids(*store, {"buildings", 50, "", box, share}) == expected);
    }
  }
}

TEST_CASE("an index serves the box filter") {
  const Database database;
  const auto store = database.store();
  database.add_many_features();
  const auto page =
      store->list({"c", 10, "", store::StoredBox{{500.5, 500.5, 0}, {501.5, 501.5, 1}}});
  REQUIRE(page);
  CHECK(page->features.size() == 2);
  database.ask("ANALYZE watertight.feature_row");
  const std::string plan = database.ask(
      "EXPLAIN (FORMAT JSON) SELECT count(*) FROM watertight.feature_row WHERE collection = 1"
      " AND min_x IS NOT NULL AND watertight.index_box(min_x, min_y, max_x, max_y)"
      "   && watertight.index_box(500.5, 500.5, 501.5, 501.5)");
  CHECK(plan.find("feature_box") != std::string::npos);
}

TEST_CASE("concurrent writers of the same features neither fail nor mix") {
  const Database database;
  const auto store = database.store(3);  // the store has fewer sessions than the test has threads
  constexpr int kThreads = 6;
  constexpr int kRounds = 15;
  std::atomic<int> failures{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      std::mt19937 random(static_cast<unsigned>(t));
      for (int round = 0; round < kRounds; ++round) {
        std::vector<StoredFeature> batch;
        for (int i = 0; i < 8; ++i) {
          batch.push_back(sample_feature("f" + std::to_string(i)));
          batch.back().skeleton.bytes = {static_cast<std::uint8_t>(t)};
          for (StoredSolid& solid : batch.back().solids) {
            solid.blob = {static_cast<std::uint8_t>(t)};
          }
        }
        std::shuffle(batch.begin(), batch.end(), random);
        if (!store->put(batch)) ++failures;
        if (!store->list({"buildings", 8, "", {}})) ++failures;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(failures == 0);
  const auto batch = store->walk("buildings", 8, "");
  REQUIRE(batch);
  REQUIRE(batch->features.size() == 8);
  for (const StoredFeature& feature : batch->features) {
    CHECK(feature.skeleton == batch->features.front().skeleton);  // one batch was the last
    REQUIRE(feature.solids.size() == 2);
    CHECK(feature.solids[0].blob == feature.skeleton.bytes);
  }
}

TEST_CASE("batches above one statement's size are stored whole") {
  const Database database;
  const auto store = database.store();
  std::vector<StoredFeature> features;
  for (int i = 0; i < 5; ++i) {
    features.push_back(sample_feature("f" + std::to_string(i)));
    features.back().solids[0].blob = Bytes(20U << 20, static_cast<std::uint8_t>(i));
  }
  REQUIRE(store->put(features));
  for (int i = 0; i < 5; ++i) {
    const auto got = store->get("buildings", "f" + std::to_string(i));
    REQUIRE(got);
    CHECK(got->solids[0].blob == features[static_cast<std::size_t>(i)].solids[0].blob);
  }
}

TEST_CASE("any number of stores may be opened on a new database at once") {
  const Database database;
  std::atomic<int> failures{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 6; ++t) {
    threads.emplace_back([&] {
      const auto store = store::open_postgres_store(database.connection(), 1);
      if (!store || !(*store)->ping()) ++failures;
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(failures == 0);
  CHECK(database.ask("SELECT (count(*) = max(number))::text FROM watertight.migration") == "true");
}

TEST_CASE("a database of a newer program is left alone") {
  const Database database;
  const auto store = database.store();
  REQUIRE(store->ping());
  database.ask("INSERT INTO watertight.migration (number, name) VALUES (999, 'future')");
  CHECK(store->ping().error().code == ErrorCode::unsupported);
  const auto opened = store::open_postgres_store(database.connection());
  REQUIRE(!opened);
  CHECK(opened.error().code == ErrorCode::unsupported);
}

TEST_CASE("headers and receipts that nothing needs are swept") {
  const Database database;
  StoredFeature feature = sample_feature("a");
  {
    const auto store = database.store();
    put_one(*store, feature);
    feature.header = "{}";
    put_one(*store, feature);
    feature.header = "{\"x\":1}";
    put_one(*store, feature);
    database.ask("UPDATE watertight.write_receipt SET written = now() - interval '2 days'");
    CHECK(database.ask("SELECT count(*)::text FROM watertight.document") == "3");
  }
  put_one(*database.store(), feature);  // a store sweeps after its first write
  CHECK(database.ask("SELECT count(*)::text FROM watertight.document") == "2");
  CHECK(database.ask("SELECT count(*)::text FROM watertight.write_receipt") == "1");
}

}  // namespace watertight::test::test_store
