// SPDX-License-Identifier: GPL-3.0-or-later
//
// Conditions on what a write replaces or removes.
#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <thread>

#include "fixture.h"

namespace watertight::test_conditions {
using store::WriteCondition;
using test::Database;
using test::sample_feature;
using Kind = WriteCondition::Kind;

namespace {

std::uint64_t put_on_condition(SolidStore& store, const StoredFeature& feature,
                               const WriteCondition& condition = {}) {
  const auto versions = store.put(std::span(&feature, 1), condition);
  INFO((versions ? std::string() : to_string(versions.error())));
  REQUIRE(versions);
  return versions->front();
}

void check_refused(const Error& error, const std::string& id, const std::string& found) {
  CHECK(error.code == ErrorCode::precondition_failed);
  CHECK(error.message.find("'" + id + "'") != std::string::npos);
  CHECK(error.message.find(found) != std::string::npos);
}

/// Whether a change was refused for its condition. Threads count this; the checks of the test
/// framework stay in one thread, because they may not run in several at once.
bool is_refused(const auto& result) {
  return !result && result.error().code == ErrorCode::precondition_failed;
}

}  // namespace

TEST_CASE("the version of a feature is that of its last put") {
  const Database database;
  const auto store = database.store();
  CHECK(store->version("buildings", "a").error().code == ErrorCode::not_found);
  CHECK(store->version("no/ne", "a").error().code == ErrorCode::not_found);
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t version = put_on_condition(*store, sample_feature("a"));
    CHECK(*store->version("buildings", "a") == version);
  }
  CHECK(store->version("buildings", "b").error().code == ErrorCode::not_found);
  REQUIRE(store->remove("buildings", "a"));
  CHECK(store->version("buildings", "a").error().code == ErrorCode::not_found);
}

TEST_CASE("a put happens only if its condition holds for each of its features") {
  const Database database;
  const auto store = database.store();
  const std::vector<StoredFeature> both{sample_feature("a"), sample_feature("b")};
  const auto refused = [&](const WriteCondition& condition, const std::string& id,
                           const std::string& found) {
    const auto result = store->put(both, condition);
    REQUIRE(!result);
    check_refused(result.error(), id, found);
  };
  refused({Kind::present, {}}, "a", "does not exist");
  refused({Kind::versions, {7}}, "a", "does not exist");
  CHECK(store->collection("buildings").error().code == ErrorCode::not_found);
  const std::uint64_t a = put_on_condition(*store, both[0], {Kind::absent, {}});
  refused({Kind::absent, {}}, "a", "version " + std::to_string(a));
  refused({Kind::present, {}}, "b", "does not exist");
  refused({Kind::versions, {a}}, "b", "does not exist");
  CHECK(*store->version("buildings", "a") == a);
  const std::uint64_t b = put_on_condition(*store, both[1]);
  refused({Kind::versions, {a}}, "b", "version " + std::to_string(b));
  refused({Kind::versions, {}}, "a", "version " + std::to_string(a));
  CHECK(*store->version("buildings", "a") == a);
  const auto again = store->put(both, {Kind::versions, {b, a}});
  REQUIRE(again);
  CHECK(again->front() > b);
  CHECK(store->put(both, {Kind::present, {}}));
  CHECK(store->get("buildings", "a")->solids.size() == 2);
}

TEST_CASE("a remove happens only if its condition holds") {
  const Database database;
  const auto store = database.store();
  const std::uint64_t first = put_on_condition(*store, sample_feature("a"));
  const std::uint64_t second = put_on_condition(*store, sample_feature("a"));
  const Status stale = store->remove("buildings", "a", {Kind::versions, {first}});
  REQUIRE(!stale);
  check_refused(stale.error(), "a", "version " + std::to_string(second));
  CHECK(store->remove("buildings", "b", {Kind::present, {}}).error().code == ErrorCode::not_found);
  CHECK(store->remove("buildings", "a", {Kind::versions, {first, second}}));
  CHECK(store->version("buildings", "a").error().code == ErrorCode::not_found);
}

TEST_CASE("of writers that replace one version exactly one succeeds") {
  const Database database;
  const auto store = database.store(4);
  std::uint64_t version = put_on_condition(*store, sample_feature("a"));
  for (int round = 0; round < 25; ++round) {
    std::atomic<int> stored{0};
    std::atomic<int> refused{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&, t] {
        if (round % 5 == 4 && t == 0) {
          const Status removed = store->remove("buildings", "a", {Kind::versions, {version}});
          if (removed) ++stored;
          if (is_refused(removed)) ++refused;
          return;
        }
        StoredFeature feature = sample_feature("a");
        feature.skeleton.bytes = {static_cast<std::uint8_t>(t)};
        const auto put = store->put(std::span(&feature, 1), {Kind::versions, {version}});
        if (put) ++stored;
        if (is_refused(put)) ++refused;
      });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(stored == 1);
    CHECK(refused == 3);
    const auto now = store->version("buildings", "a");
    version = now ? *now : put_on_condition(*store, sample_feature("a"));
  }
}

TEST_CASE("of writers that add one feature exactly one succeeds") {
  const Database database;
  const auto store = database.store(4);
  for (int round = 0; round < 25; ++round) {
    std::atomic<int> stored{0};
    std::atomic<int> refused{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        const std::string name = std::to_string(round);
        const std::vector<StoredFeature> pair{sample_feature("f" + name),
                                              sample_feature("g" + name)};
        const auto put = store->put(pair, {Kind::absent, {}});
        if (put) ++stored;
        if (is_refused(put)) ++refused;
      });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(stored == 1);
    CHECK(refused == 3);
  }
  CHECK(store->collection("buildings")->features == 50);
}

}  // namespace watertight::test_conditions
