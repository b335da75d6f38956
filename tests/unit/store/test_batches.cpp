// SPDX-License-Identifier: GPL-3.0-or-later
//
// Puts of more features than one batch holds: all in one transaction, whatever happens meanwhile.
#include <catch2/catch_test_macros.hpp>
#include <functional>
#include <set>
#include <vector>

#include "fixture.h"
#include "proxy.h"

namespace watertight::test::test_batches {
namespace {

/// Batches of three features with ids "0", "1", ...
class Batches final : public store::FeatureBatches {
 public:
  explicit Batches(std::size_t count) : count_(count) {}

  Status rewind() override {
    next_ = 0;
    ++rewinds;
    return Done{};
  }
  Result<std::span<const StoredFeature>> next() override {
    batch_.clear();
    if (next_ == count_) return std::span<const StoredFeature>();
    if (next_ == broken) return Error{ErrorCode::unavailable, "the temporary file is broken"};
    if (before_batch) before_batch(next_);
    for (std::size_t i = 0; i < 3; ++i) {
      batch_.push_back(sample_feature(std::to_string(3 * next_ + i)));
      if (next_ == foreign) batch_.back().srid = 4979;
    }
    ++next_;
    return std::span<const StoredFeature>(batch_);
  }

  std::size_t broken = SIZE_MAX;   // the batch that cannot be read
  std::size_t foreign = SIZE_MAX;  // the batch with another CRS
  std::function<void(std::size_t)> before_batch;
  int rewinds = 0;

 private:
  std::size_t count_;
  std::size_t next_ = 0;
  std::vector<StoredFeature> batch_;
};

std::uint64_t stored(SolidStore& store) {
  const auto collection = store.collection("buildings");
  return collection ? collection->features : 0;
}

}  // namespace

TEST_CASE("all batches are stored together, each feature under a version of its own") {
  const Database database;
  const auto store = database.store();
  Batches batches(50);
  batches.before_batch = [&](std::size_t) { CHECK(stored(*store) == 0); };  // until the commit
  const auto versions = store->put_all(batches);
  REQUIRE(versions);
  CHECK(std::set(versions->begin(), versions->end()).size() == 150);
  CHECK(stored(*store) == 150);
  CHECK(store->version("buildings", "149").value() == versions->back());
}

TEST_CASE("no batch is stored when one cannot be read or stored") {
  const Database database;
  const auto store = database.store();
  Batches broken(10);
  broken.broken = 7;
  const auto unread = store->put_all(broken);
  REQUIRE_FALSE(unread);
  CHECK(unread.error().message == "the temporary file is broken");
  Batches foreign(10);
  foreign.foreign = 7;
  const auto refused = store->put_all(foreign);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::conflict);
  CHECK(stored(*store) == 0);
}

TEST_CASE("a condition holds for the features of all batches") {
  const Database database;
  const auto store = database.store();
  const StoredFeature old = sample_feature("20");
  REQUIRE(store->put(std::span(&old, 1)));
  Batches batches(10);
  const auto refused = store->put_all(batches, {store::WriteCondition::Kind::absent, {}});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::precondition_failed);
  CHECK(stored(*store) == 1);
}

TEST_CASE("batches are sent again from the first after a lost session, and stored once") {
  const Database database;
  const auto store = database.store(1);
  Batches batches(10);
  batches.before_batch = [&](std::size_t number) {
    if (number == 5 && batches.rewinds == 1) CHECK(database.end_sessions());
  };
  const auto versions = store->put_all(batches);
  REQUIRE(versions);
  CHECK(batches.rewinds == 2);
  CHECK(versions->size() == 30);
  CHECK(stored(*store) == 30);
  CHECK(database.ask("SELECT count(*)::text FROM watertight.feature") == "30");
}

TEST_CASE("batches whose commit was not answered are stored once") {
  const Database database;
  const TemporaryFolder folder;
  Proxy proxy(folder.path, database.socket());
  const auto store =
      store::open_postgres_store(database.connection() + " host='" + folder.path + "'", 1);
  REQUIRE(store);
  for (const Proxy::Cut cut : {Proxy::Cut::before_commit, Proxy::Cut::after_commit}) {
    proxy.cut_next(cut);
    Batches batches(5);
    const auto versions = (*store)->put_all(batches);
    REQUIRE(versions);
    CHECK(proxy.has_cut());
    CHECK((*store)->version("buildings", "14").value() == versions->back());
    CHECK(database.ask("SELECT count(*)::text FROM watertight.feature") == "15");
  }
}

}  // namespace watertight::test::test_batches
