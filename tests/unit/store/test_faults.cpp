// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the store when the server, or the connection to it, breaks.
#include <signal.h>

#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "fixture.h"
#include "proxy.h"

namespace watertight::test::test_faults {
namespace {

pid_t postmaster_of(const std::string& data) {
  std::ifstream file(data + "/postgres/postmaster.pid");
  pid_t pid = 0;
  file >> pid;
  return pid;
}

/// Puts single features from a thread of its own, as fast as the store takes them.
class Writer {
 public:
  Writer(SolidStore& store, const std::string& prefix)
      : thread_([this, &store, prefix] {
          for (int i = 0; !stop_; ++i) {
            const StoredFeature feature = sample_feature(prefix + std::to_string(i));
            if (!store.put(std::span(&feature, 1))) continue;
            acknowledged_.push_back(feature.id);
            ++count_;
          }
        }) {}
  std::size_t count() const { return count_; }
  /// Waits for `more` acknowledged puts; returns false if they take more than a minute.
  bool writes(std::size_t more) const {
    const std::size_t goal = count_ + more;
    for (int i = 0; i < 6000 && count_ < goal; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return count_ >= goal;
  }
  /// Stops the thread; returns the ids that were acknowledged.
  const std::vector<std::string>& stop() {
    stop_ = true;
    thread_.join();
    return acknowledged_;
  }

 private:
  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> count_{0};
  std::vector<std::string> acknowledged_;
  std::thread thread_;
};

/// Makes each later change of a feature add one row to `audit`, in the same transaction.
void watch_features(const Database& database) {
  database.ask("CREATE TABLE audit (id text)");
  database.ask(
      "CREATE FUNCTION note() RETURNS trigger LANGUAGE plpgsql AS"
      " 'BEGIN INSERT INTO audit VALUES (new.id); RETURN new; END'");
  database.ask(
      "CREATE TRIGGER note AFTER INSERT OR UPDATE ON watertight.feature_row"
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
  Writer writer(*store, "f");
  std::mt19937 random(5);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  for (int cuts = 0;
       (cuts < 25 || writer.count() < 25) && std::chrono::steady_clock::now() < end;) {
    cuts += database.end_sessions() ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(5 + random() % 100));
  }
  const std::vector<std::string>& acknowledged = writer.stop();
  CHECK(acknowledged.size() >= 25);
  CHECK(database.ask("SELECT count(*)::text FROM audit") == std::to_string(acknowledged.size()));
  CHECK(database.ask("SELECT count(DISTINCT id)::text FROM audit") ==
        std::to_string(acknowledged.size()));
}

TEST_CASE("a commit whose answer was lost is found out, never repeated and never forgotten") {
  const Database database;
  const TemporaryFolder folder;
  Proxy proxy(folder.path, database.socket());
  const auto store =
      store::open_postgres_store(database.connection() + " host='" + folder.path + "'", 1);
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
  Result<std::unique_ptr<store::PrivateCluster>> cluster =
      store::PrivateCluster::start({folder.path});
  REQUIRE(cluster);
  const auto store = store::open_postgres_store((*cluster)->connection(), 3);
  REQUIRE(store);
  Writer first(**store, "first-");
  Writer second(**store, "second-");
  for (int round = 0; round < 3; ++round) {
    REQUIRE(first.writes(20));
    const pid_t before = postmaster_of(folder.path);
    REQUIRE(before > 0);
    REQUIRE(kill(before, SIGKILL) == 0);
    // The supervisor of the cluster starts the next server.
    for (int i = 0; i < 600 && (postmaster_of(folder.path) == before || !(*store)->ping()); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    REQUIRE(postmaster_of(folder.path) != before);
  }
  CHECK(second.writes(5));
  for (Writer* writer : {&first, &second}) {
    for (const std::string& id : writer->stop()) {
      const auto got = (*store)->get("buildings", id);
      REQUIRE(got);
      CHECK(got->solids.size() == 2);
    }
  }
}

TEST_CASE("a store reports that the server stays away, and works when it is back") {
  const TemporaryFolder folder;
  Result<std::unique_ptr<store::PrivateCluster>> cluster =
      store::PrivateCluster::start({folder.path});
  REQUIRE(cluster);
  const auto store = store::open_postgres_store((*cluster)->connection(), 1);
  REQUIRE(store);
  (*cluster).reset();  // the end of the last user stops the server
  CHECK((*store)->ping().error().code == ErrorCode::unavailable);
  const auto got = (*store)->get("buildings", "a");
  REQUIRE(!got);
  CHECK(got.error().code == ErrorCode::unavailable);
  Result<std::unique_ptr<store::PrivateCluster>> again =
      store::PrivateCluster::start({folder.path});
  REQUIRE(again);
  CHECK((*store)->ping());
  CHECK((*store)->get("buildings", "a").error().code == ErrorCode::not_found);
}

TEST_CASE("a database that hangs fails a read in time, and an interruption fails it at once") {
  const Database database;
  const TemporaryFolder folder;
  Proxy proxy(folder.path, database.socket());
  const auto store =
      store::open_postgres_store(database.connection() + " host='" + folder.path + "'", 1);
  REQUIRE(store);
  const StoredFeature feature = sample_feature("a");
  REQUIRE((*store)->put(std::span(&feature, 1)));
  const auto seconds_of_get = [&] {
    const auto start = std::chrono::steady_clock::now();
    const auto got = (*store)->get("buildings", "a");
    REQUIRE(!got);
    CHECK(got.error().code == ErrorCode::unavailable);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  proxy.hold(true);
  CHECK(seconds_of_get() < 12);
  proxy.hold(false);
  CHECK((*store)->get("buildings", "a"));
  proxy.hold(true);
  std::thread stopping([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    (*store)->interrupt();
  });
  CHECK(seconds_of_get() < 2);
  stopping.join();
  proxy.hold(false);
  CHECK(!(*store)->get("buildings", "a"));  // an interruption is for good
}

TEST_CASE("a server that does not answer a new session fails a ping in time, or when interrupted") {
  const Database database;
  const TemporaryFolder folder;
  Proxy proxy(folder.path, database.socket());
  const auto store =
      store::open_postgres_store(database.connection() + " host='" + folder.path + "'", 1);
  REQUIRE(store);
  const auto seconds_of_ping = [&] {
    const auto start = std::chrono::steady_clock::now();
    const Status status = (*store)->ping();
    REQUIRE(!status);
    CHECK(status.error().code == ErrorCode::unavailable);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  proxy.hold(true);
  CHECK(seconds_of_ping() < 2.5);  // the session is there
  CHECK(seconds_of_ping() < 2.5);  // there is none now
  std::thread stopping([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    (*store)->interrupt();
  });
  CHECK(seconds_of_ping() < 1.5);
  stopping.join();
  proxy.hold(false);
}

TEST_CASE("an error of the server names no file to a client, and no line end to anyone") {
  const Database database;
  const auto session = session_in(database.connection());
  const auto failure_of = [&](const std::string& state) {
    const auto failed =
        session->run("DO $$ BEGIN RAISE EXCEPTION USING ERRCODE = '" + state +
                     "', MESSAGE = E'could not extend file \"base/1/2\"\n  no space'; END $$");
    REQUIRE(!failed);
    CHECK(failed.error().detail == "could not extend file \"base/1/2\"; no space");
    CHECK(failed.error().code == ErrorCode::unavailable);
    return failed.error().message;
  };
  CHECK(failure_of("53100") == "the database's disk is full");
  CHECK(failure_of("58030") == "the database cannot do this now");
  const auto opened = store::DatabaseSession::open("host='/nowhere/at/all'");
  const auto* missing = std::get_if<store::DatabaseSession::OpenFailure>(&opened);
  REQUIRE(missing != nullptr);
  CHECK(missing->error.message.find("nowhere") == std::string::npos);
  CHECK(missing->error.detail.find("nowhere") != std::string::npos);
  CHECK(to_string(missing->error).find('\n') == std::string::npos);
}

TEST_CASE("statements that were sent together fail together, and the session can be used again") {
  const Database database;
  const auto session = session_in(database.connection());
  for (int round = 0; round < 2; ++round) {
    session->send("BEGIN");
    const std::size_t one = session->send("SELECT $1::int8 + 1", store::Parameters().int8(1));
    session->send("SELECT 1 / $1::int8", store::Parameters().int8(round));
    const std::size_t three = session->send("SELECT 3::int8");
    const auto results = session->results();
    CHECK(results.has_value() == (round == 1));
    if (results) {
      CHECK((*results)[one].int8(0, 0) == 2);
      CHECK((*results)[three].int8(0, 0) == 3);
    } else {
      CHECK(session->state() == "22012");
    }
    session->roll_back();
    CHECK(session->ask("SELECT 5::int8")->int8(0, 0) == 5);
  }
}

TEST_CASE("while a ping has found the database away, other calls fail at once") {
  const TemporaryFolder folder;
  Result<std::unique_ptr<store::PrivateCluster>> cluster =
      store::PrivateCluster::start({folder.path});
  REQUIRE(cluster);
  const auto store = store::open_postgres_store((*cluster)->connection(), 1);
  REQUIRE(store);
  (*cluster).reset();
  CHECK(!(*store)->ping());
  const auto start = std::chrono::steady_clock::now();
  CHECK(!(*store)->get("buildings", "a"));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
}

TEST_CASE("a connection string that leads nowhere is an error at once") {
  CHECK(store::open_postgres_store("host='unclosed").error().code == ErrorCode::invalid_argument);
  const Database database;
  const auto missing =
      store::open_postgres_store(database.connection() + " dbname=no_such_database");
  REQUIRE(!missing);
  CHECK(missing.error().code == ErrorCode::unavailable);
  CHECK(missing.error().detail.find("no_such_database") != std::string::npos);
}

}  // namespace watertight::test::test_faults
