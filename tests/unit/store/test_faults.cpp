// SPDX-License-Identifier: GPL-3.0-or-later
//
// What happens to a store when the server, or the way to it, breaks.
#include <signal.h>

#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <fstream>
#include <thread>

#include "fixture.h"
#include "proxy.h"

namespace watertight::test {
namespace {

pid_t postmaster_of(const std::string& data) {
  std::ifstream file(data + "/postgres/postmaster.pid");
  pid_t pid = 0;
  file >> pid;
  return pid;
}

/// Puts single features until `stop`; returns the ids that were acknowledged.
std::vector<std::string> write_until(SolidStore& store, const std::string& prefix,
                                     const std::atomic<bool>& stop) {
  std::vector<std::string> acknowledged;
  for (int i = 0; !stop; ++i) {
    const StoredFeature feature = sample_feature(prefix + std::to_string(i));
    if (store.put(std::span(&feature, 1))) acknowledged.push_back(feature.id);
  }
  return acknowledged;
}

/// From now on each change of a feature leaves one row in `audit`, in the same transaction.
void watch_features(const Database& database) {
  database.ask("CREATE TABLE audit (id text)");
  database.ask(
      "CREATE FUNCTION note() RETURNS trigger LANGUAGE plpgsql AS"
      " 'BEGIN INSERT INTO audit VALUES (new.id); RETURN new; END'");
  database.ask(
      "CREATE TRIGGER note AFTER INSERT OR UPDATE ON watertight.feature"
      " FOR EACH ROW EXECUTE FUNCTION note()");
}

}  // namespace

TEST_CASE("a store goes on after its sessions were ended") {
  const Database database;
  const auto store = database.store(2);
  const StoredFeature feature = sample_feature("a");
  REQUIRE(store->put(std::span(&feature, 1)));
  REQUIRE(database.end_sessions());
  CHECK(store->ping());
  REQUIRE(database.end_sessions());
  CHECK(store->get("buildings", "a"));
  REQUIRE(database.end_sessions());
  CHECK(store->put(std::span(&feature, 1)));
  REQUIRE(database.end_sessions());
  CHECK(store->remove("buildings", "a"));
}

TEST_CASE("a put whose session is cut at any moment happens exactly once") {
  const Database database;
  const auto store = database.store(2);
  watch_features(database);
  std::atomic<bool> stop{false};
  std::vector<std::string> acknowledged;
  std::thread writer([&] { acknowledged = write_until(*store, "f", stop); });
  int cuts = 0;
  for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(3);
       std::chrono::steady_clock::now() < end;) {
    cuts += database.end_sessions() ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(20 + cuts % 17));
  }
  stop = true;
  writer.join();
  CHECK(cuts > 20);
  CHECK(acknowledged.size() > 20);
  CHECK(database.ask("SELECT count(*)::text FROM audit") == std::to_string(acknowledged.size()));
  CHECK(database.ask("SELECT count(DISTINCT id)::text FROM audit") ==
        std::to_string(acknowledged.size()));
}

TEST_CASE("a commit whose answer was lost is found out, never repeated and never forgotten") {
  const Database database;
  const TemporaryFolder folder;
  Proxy proxy(folder.path, database.socket());
  const auto store = open_postgres_store(database.connection() + " host='" + folder.path + "'", 1);
  REQUIRE(store);
  watch_features(database);
  std::vector<std::string> expected;
  for (const Proxy::Cut cut : {Proxy::Cut::before_commit, Proxy::Cut::after_commit}) {
    const StoredFeature feature = sample_feature("a" + std::to_string(expected.size()));
    proxy.cut_next(cut);
    const auto versions = (*store)->put(std::span(&feature, 1));
    REQUIRE(versions);
    CHECK(proxy.has_cut());
    CHECK((*store)->get("buildings", feature.id)->version == versions->front());
    expected.push_back(feature.id);
    CHECK(database.ask("SELECT count(*)::text FROM audit") == std::to_string(expected.size()));
  }
  for (const std::string& id : expected) {
    proxy.cut_next(id == expected[0] ? Proxy::Cut::after_commit : Proxy::Cut::before_commit);
    CHECK((*store)->remove("buildings", id));
    CHECK(proxy.has_cut());
    CHECK((*store)->remove("buildings", id).error().code == ErrorCode::not_found);
  }
}

TEST_CASE("every acknowledged put survives kill -9 of the server, and the store goes on") {
  const TemporaryFolder folder;
  Result<std::unique_ptr<PrivateCluster>> cluster = PrivateCluster::start({folder.path});
  REQUIRE(cluster);
  const auto store = open_postgres_store((*cluster)->connection(), 3);
  REQUIRE(store);
  std::atomic<bool> stop{false};
  std::vector<std::string> acknowledged[2];
  std::thread writers[2];
  for (int w = 0; w < 2; ++w) {
    writers[w] = std::thread(
        [&, w] { acknowledged[w] = write_until(**store, "w" + std::to_string(w) + "-", stop); });
  }
  for (int round = 0; round < 3; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    const pid_t before = postmaster_of(folder.path);
    REQUIRE(before > 0);
    REQUIRE(kill(before, SIGKILL) == 0);
    // The cluster's supervisor starts the next one.
    for (int i = 0; i < 600 && (postmaster_of(folder.path) == before || !(*store)->ping()); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    REQUIRE(postmaster_of(folder.path) != before);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  stop = true;
  for (std::thread& writer : writers) writer.join();
  for (const auto& ids : acknowledged) {
    CHECK(ids.size() > 30);
    for (const std::string& id : ids) {
      const auto got = (*store)->get("buildings", id);
      REQUIRE(got);
      CHECK(got->solids.size() == 2);
    }
  }
}

TEST_CASE("a store says so when the server stays away, and works when it is back") {
  const TemporaryFolder folder;
  Result<std::unique_ptr<PrivateCluster>> cluster = PrivateCluster::start({folder.path});
  REQUIRE(cluster);
  const auto store = open_postgres_store((*cluster)->connection(), 1);
  REQUIRE(store);
  (*cluster).reset();  // the last user stops the server
  CHECK((*store)->ping().error().code == ErrorCode::unavailable);
  const auto got = (*store)->get("buildings", "a");
  REQUIRE(!got);
  CHECK(got.error().code == ErrorCode::unavailable);
  Result<std::unique_ptr<PrivateCluster>> again = PrivateCluster::start({folder.path});
  REQUIRE(again);
  CHECK((*store)->ping());
  CHECK((*store)->get("buildings", "a").error().code == ErrorCode::not_found);
}

TEST_CASE("a connection string that leads nowhere is an error at once") {
  CHECK(open_postgres_store("host='unclosed").error().code == ErrorCode::invalid_argument);
  const Database database;
  const auto missing = open_postgres_store(database.connection() + " dbname=no_such_database");
  REQUIRE(!missing);
  CHECK(missing.error().code == ErrorCode::unavailable);
  CHECK(missing.error().message.find("no_such_database") != std::string::npos);
}

}  // namespace watertight::test
