// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/group_commit.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "fixture.h"

namespace watertight::test_group_commit {
using store::GroupCommit;
using test::Database;
using test::sample_feature;

namespace {

using Refs = std::span<const StoredFeature* const>;
using Ids = std::vector<std::string>;

/// A writer that keeps what it was asked to write. The first write waits until it is let go, so
/// that calls gather meanwhile.
class FakeWriter {
 public:
  GroupCommit::Versions write(Refs features) {
    if (calls_++ == 0) {
      while (is_held_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::lock_guard lock(mutex_);
    Ids ids;
    for (const StoredFeature* feature : features) ids.push_back(feature->id);
    groups_.push_back(ids);
    for (const std::string& id : ids) {
      if (id == refused) return Error{ErrorCode::conflict, "no " + id};
      if (id == lost && ids.size() > 1) return Error{ErrorCode::unavailable, "away"};
    }
    if (std::exchange(must_throw, false)) throw std::bad_alloc();
    std::vector<std::uint64_t> versions;
    for (std::size_t i = 0; i < ids.size(); ++i) versions.push_back(++version_);
    return versions;
  }
  void release() { is_held_ = false; }
  std::size_t calls() const { return calls_; }
  const std::vector<Ids>& groups() const { return groups_; }  // after all threads have ended

  /// As write(), unless a lock on a feature is in the way.
  std::optional<GroupCommit::Versions> write_group(Refs features) {
    for (const StoredFeature* feature : features) {
      if (feature->id == locked) return std::nullopt;
    }
    return write(features);
  }

  std::string refused;  // a write with this id fails
  std::string locked;   // a group with this id finds a lock
  bool must_throw = false;
  std::string lost;  // a write with this id and others finds the database away

 private:
  std::atomic<std::size_t> calls_{0};
  std::atomic<bool> is_held_{true};
  std::mutex mutex_;
  std::vector<Ids> groups_;
  std::uint64_t version_ = 100;
};

/// Puts "first", and then each call of `calls`, one after the other in the queue. Returns the
/// results of `calls`.
std::vector<GroupCommit::Versions> put_all(FakeWriter& writer, const GroupCommit::Limits& limits,
                                           const std::vector<Ids>& calls) {
  GroupCommit group({[&](Refs all) { return writer.write_group(all); },
                     [&](Refs all) { return writer.write(all); }},
                    limits);
  std::vector<std::vector<StoredFeature>> features(calls.size() + 1);
  features[0].push_back(sample_feature("first"));
  for (std::size_t i = 0; i < calls.size(); ++i) {
    for (const std::string& id : calls[i]) features[i + 1].push_back(sample_feature(id));
  }
  std::vector<GroupCommit::Versions> results(features.size(), Error{});
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < features.size(); ++i) {
    threads.emplace_back([&, i] { results[i] = group.put(features[i]); });
    while (writer.calls() == 0 || group.waiting() < i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  writer.release();
  for (std::thread& thread : threads) thread.join();
  CHECK(results[0]);
  results.erase(results.begin());
  return results;
}

}  // namespace

TEST_CASE("calls that arrive while another is written are written together") {
  FakeWriter writer;
  const auto results = put_all(writer, {}, {{"a"}, {"b", "c"}, {"d"}});
  CHECK(writer.groups() == std::vector<Ids>{{"first"}, {"a", "b", "c", "d"}});
  CHECK(*results[0] == std::vector<std::uint64_t>{102});
  CHECK(*results[1] == std::vector<std::uint64_t>{103, 104});
  CHECK(*results[2] == std::vector<std::uint64_t>{105});
}

TEST_CASE("a group has at most so many features and bytes") {
  FakeWriter writer;
  put_all(writer, {3, 1 << 20}, {{"a"}, {"b", "c"}, {"d"}, {"e", "f", "g", "h"}, {"i"}});
  CHECK(writer.groups() ==
        std::vector<Ids>{{"first"}, {"a", "b", "c"}, {"d"}, {"e", "f", "g", "h"}, {"i"}});
  FakeWriter other;
  put_all(other, {100, 17}, {{"a"}, {"b"}, {"c"}});  // a sample has 16 bytes
  CHECK(other.groups() == std::vector<Ids>{{"first"}, {"a"}, {"b"}, {"c"}});
}

TEST_CASE("calls with a feature in common are written one after the other") {
  FakeWriter writer;
  const auto results = put_all(writer, {}, {{"a"}, {"b", "a"}, {"c"}, {"a"}});
  CHECK(writer.groups() == std::vector<Ids>{{"first"}, {"a"}, {"b", "a", "c"}, {"a"}});
  CHECK(results[3]->front() > results[1]->back());
}

TEST_CASE("when a group fails, only its guilty call fails") {
  FakeWriter writer;
  writer.refused = "b";
  const auto results = put_all(writer, {}, {{"a"}, {"b", "x"}, {"c"}});
  REQUIRE(writer.groups().size() == 5);
  CHECK(writer.groups()[1] == Ids{"a", "b", "x", "c"});
  const std::multiset<Ids> alone(writer.groups().begin() + 2, writer.groups().end());
  CHECK(alone == std::multiset<Ids>{{"a"}, {"b", "x"}, {"c"}});
  CHECK(results[0]);
  REQUIRE(!results[1]);
  CHECK(results[1].error().code == ErrorCode::conflict);
  CHECK(results[2]);
}

TEST_CASE("when a lock is in the way of a group, each of its calls is written alone") {
  FakeWriter writer;
  writer.locked = "b";
  const auto results = put_all(writer, {}, {{"a"}, {"b"}, {"c"}});
  for (const auto& result : results) CHECK(result);
  CHECK(writer.groups().size() == 4);
}

TEST_CASE("an exception leaves no call waiting") {
  FakeWriter writer;
  GroupCommit group({[&](Refs all) { return writer.write_group(all); },
                     [&](Refs all) { return writer.write(all); }});
  writer.release();
  writer.must_throw = true;
  const StoredFeature feature = sample_feature("a");
  CHECK_THROWS_AS(group.put(std::span(&feature, 1)), std::bad_alloc);
  CHECK(group.put(std::span(&feature, 1)));
}

TEST_CASE("a feature that another transaction has locked holds up no other put") {
  const Database database;
  const auto store = database.store(8);
  REQUIRE(store->put(std::vector{sample_feature("locked")}));
  const auto session = test::session_in(database.connection());
  REQUIRE(session->run("BEGIN"));
  REQUIRE(session->run("SELECT FROM watertight.feature_row WHERE id = 'locked' FOR UPDATE"));
  std::atomic<bool> is_stored = false;
  std::thread waiting(
      [&] { is_stored = store->put(std::vector{sample_feature("locked")}).has_value(); });
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 5; ++i) {
    CHECK(store->put(std::vector{sample_feature("free" + std::to_string(i))}));
  }
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
  CHECK_FALSE(is_stored);
  REQUIRE(session->run("COMMIT"));
  waiting.join();
  CHECK(is_stored);
}

TEST_CASE("when the database is away, the calls of a group share this and none is repeated") {
  FakeWriter writer;
  writer.lost = "b";
  const auto results = put_all(writer, {}, {{"a"}, {"b"}});
  CHECK(writer.groups() == std::vector<Ids>{{"first"}, {"a", "b"}});
  for (const auto& result : results) {
    REQUIRE(!result);
    CHECK(result.error().code == ErrorCode::unavailable);
  }
}

TEST_CASE("puts of many threads share transactions, and each is stored once with its version") {
  const Database database;
  const auto store = database.store(8);
  REQUIRE(store->put(std::vector{sample_feature("first")}));
  const auto receipts = [&] {
    return std::stoi(database.ask("SELECT count(*)::text FROM watertight.write_receipt"));
  };
  const int before = receipts();
  constexpr int kThreads = 8;
  constexpr int kPuts = 60;
  std::atomic<int> failures{0};
  std::vector<std::map<std::string, std::uint64_t>> versions(kThreads);
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < kPuts; ++i) {
        StoredFeature feature = sample_feature(std::to_string(t) + "-" + std::to_string(i));
        feature.skeleton.bytes = {static_cast<std::uint8_t>(t), static_cast<std::uint8_t>(i)};
        const auto put = store->put(std::span(&feature, 1));
        if (put) versions[static_cast<std::size_t>(t)][feature.id] = put->front();
        if (!put) ++failures;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(failures == 0);
  CHECK(receipts() - before < kThreads * kPuts);
  std::set<std::uint64_t> distinct;
  for (int t = 0; t < kThreads; ++t) {
    for (const auto& [id, version] : versions[static_cast<std::size_t>(t)]) {
      distinct.insert(version);
      const auto got = store->get("buildings", id);
      REQUIRE(got);
      CHECK(got->version == version);
      CHECK(got->skeleton.bytes[0] == t);
      CHECK(got->solids.size() == 2);
      CHECK(got->solids[0].object_id == id + "-part");
    }
  }
  CHECK(distinct.size() == kThreads * kPuts);
  CHECK(store->collection("buildings")->features == kThreads * kPuts + 1);
}

TEST_CASE("a bad put fails alone beside puts of other threads") {
  const Database database;
  const auto store = database.store(4);
  REQUIRE(store->put(std::vector{sample_feature("first")}));
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 6; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 20; ++i) {
        StoredFeature feature = sample_feature(std::to_string(t) + "-" + std::to_string(i));
        if (t == 0) feature.id = std::string("\xff");
        if (t == 1) feature.srid = 28992;
        const auto put = store->put(std::span(&feature, 1));
        const bool is_expected =
            t > 1 ? put.has_value()
                  : !put && put.error().code ==
                                (t == 0 ? ErrorCode::invalid_argument : ErrorCode::conflict);
        if (!is_expected) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
  CHECK(store->collection("buildings")->features == 81);
}

TEST_CASE("grouped puts whose sessions are cut at any moment happen exactly once") {
  const Database database;
  const auto store = database.store(3);
  REQUIRE(store->put(std::vector{sample_feature("first")}));
  database.ask("CREATE TABLE audit (id text)");
  database.ask(
      "CREATE FUNCTION note() RETURNS trigger LANGUAGE plpgsql AS"
      " 'BEGIN INSERT INTO audit VALUES (new.id); RETURN new; END'");
  database.ask(
      "CREATE TRIGGER note AFTER INSERT OR UPDATE ON watertight.feature_row"
      " FOR EACH ROW EXECUTE FUNCTION note()");
  std::atomic<bool> stop{false};
  std::atomic<std::size_t> stored{0};
  std::atomic<int> failures{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; !stop; ++i) {
        const StoredFeature feature = sample_feature(std::to_string(t) + "-" + std::to_string(i));
        if (store->put(std::span(&feature, 1))) {
          ++stored;
        } else {
          ++failures;
        }
      }
    });
  }
  for (int cut = 0; cut < 20 || (stored <= 100 && cut < 1000); ++cut) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20 + 7 * (cut % 13)));
    database.end_sessions();
  }
  stop = true;
  for (std::thread& thread : threads) thread.join();
  CHECK(failures == 0);
  CHECK(stored > 100);
  CHECK(database.ask("SELECT count(*) || ' ' || count(DISTINCT id) FROM audit") ==
        std::to_string(stored) + " " + std::to_string(stored));
}

}  // namespace watertight::test_group_commit
