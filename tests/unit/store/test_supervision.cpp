// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests what the supervisor of a private cluster does, and how a start is ended.
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <thread>

#include "fixture.h"
#include "store/cluster_files.h"

namespace watertight::test::test_supervision {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

std::unique_ptr<store::PrivateCluster> started(const store::ClusterOptions& options) {
  Result<std::unique_ptr<store::PrivateCluster>> cluster = store::PrivateCluster::start(options);
  INFO((cluster ? std::string() : to_string(cluster.error())));
  REQUIRE(cluster);
  return std::move(*cluster);
}

pid_t postmaster_of(const std::string& data) {
  const auto file = store::read_postmaster_file(data + "/postgres");
  return file ? file->pid : 0;
}

/// Waits until `holds` is true; false if that takes longer than `longest`.
template <class Condition>
bool soon(seconds longest, const Condition& holds) {
  const Clock::time_point deadline = Clock::now() + longest;
  while (Clock::now() < deadline) {
    if (holds()) return true;
    std::this_thread::sleep_for(milliseconds(20));
  }
  return false;
}

bool answers(const std::string& connection) {
  return store::server_state(connection + " connect_timeout=2") == store::ServerState::accepting;
}

void signal_all(const std::string& data, int signal) {
  for (const pid_t pid : store::postgres_processes_in(data + "/postgres")) kill(pid, signal);
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The sentences that a cluster tells.
class Told {
 public:
  void add(const std::string& sentence) {
    const std::lock_guard lock(mutex_);
    text_ += sentence + "\n";
  }
  bool has(const std::string& words) const {
    const std::lock_guard lock(mutex_);
    return text_.find(words) != std::string::npos;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
};

}  // namespace

TEST_CASE("a smart shutdown of the server takes seconds, with clients and with starting users") {
  const TemporaryFolder folder;
  Told told;
  store::ClusterOptions options{folder.path};
  options.tell = [&told](const std::string& sentence) { told.add(sentence); };
  const auto cluster = started(options);
  const auto session = session_in(cluster->connection());  // a smart shutdown waits for its end
  const pid_t before = postmaster_of(folder.path);
  REQUIRE(kill(before, SIGTERM) == 0);
  const auto second = started(options);  // either of the two may act, and say so
  // The second user may have found the server before it began to shut down.
  CHECK(soon(seconds(5), [&] {
    return postmaster_of(folder.path) != before && answers(second->connection());
  }));
  CHECK(soon(seconds(5), [&] { return cluster->health().has_value(); }));

  // The same without anybody who starts.
  const pid_t then = postmaster_of(folder.path);
  const auto other_session = session_in(cluster->connection());
  REQUIRE(kill(then, SIGTERM) == 0);
  CHECK(soon(seconds(5),
             [&] { return postmaster_of(folder.path) != then && answers(cluster->connection()); }));
  CHECK(soon(seconds(5), [&] { return told.has("the private database shuts down"); }));
}

TEST_CASE("a stopped server makes the health an error, and is continued in time") {
  const TemporaryFolder folder;
  store::ClusterOptions options{folder.path};
  options.continue_after = seconds(4);
  const auto cluster = started(options);
  const pid_t before = postmaster_of(folder.path);
  for (const bool stops_all : {false, true}) {
    if (stops_all) {
      signal_all(folder.path, SIGSTOP);
    } else {
      REQUIRE(kill(before, SIGSTOP) == 0);
    }
    CHECK(soon(seconds(5), [&] { return !cluster->health().has_value(); }));
    CHECK(!answers(cluster->connection()));
    CHECK(soon(seconds(15), [&] { return cluster->health().has_value(); }));
    CHECK(postmaster_of(folder.path) == before);
    CHECK(ask(cluster->connection(), "SELECT 'there'") == "there");
  }
}

TEST_CASE("a server that hangs for long is killed and recovered") {
  const TemporaryFolder folder;
  store::ClusterOptions options{folder.path};
  options.continue_after = seconds(1);
  options.kill_after = seconds(4);
  const auto cluster = started(options);
  ask(cluster->connection(), "CREATE TABLE t AS SELECT 7 AS x");
  const pid_t before = postmaster_of(folder.path);
  // Stops the server again and again, so that it hangs although it is continued.
  std::atomic<bool> is_over = false;
  std::thread stopper([&] {
    while (!is_over) {
      if (postmaster_of(folder.path) == before) kill(before, SIGSTOP);
      std::this_thread::sleep_for(milliseconds(1));
    }
  });
  CHECK(soon(seconds(30), [&] {
    return postmaster_of(folder.path) != before && cluster->health().has_value();
  }));
  is_over = true;
  stopper.join();
  CHECK(ask(cluster->connection(), "SELECT x::text FROM t") == "7");
}

TEST_CASE(
    "a server is back within seconds of kill -9 of any of its processes, and leaves no zombie") {
  const TemporaryFolder folder;
  const auto cluster = started({folder.path});
  const auto is_back = [&] {
    return answers(cluster->connection()) && cluster->health().has_value();
  };
  const auto has_zombie = [] {
    siginfo_t info{};
    return waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
  };
  const pid_t first = postmaster_of(folder.path);
  REQUIRE(kill(first, SIGKILL) == 0);
  CHECK(soon(seconds(1), [&] { return !has_zombie() && kill(first, 0) != 0; }));
  CHECK(soon(seconds(5), is_back));

  signal_all(folder.path, SIGKILL);
  CHECK(soon(seconds(5), [&] { return is_back() && !has_zombie(); }));

  const auto session = session_in(cluster->connection());
  const Result<store::Rows> backend = session->run("SELECT pg_backend_pid()::text");
  REQUIRE(backend);
  REQUIRE(kill(std::stoi(std::string(backend->text(0, 0))), SIGKILL) == 0);
  // The postmaster answers for a moment, until it notices.
  CHECK(soon(seconds(5), [&] {
    return text_of(folder.path + "/server.log").find("reinitializing") != std::string::npos;
  }));
  CHECK(soon(seconds(5), is_back));

  // The backends of a killed server that are stopped cannot notice its end.
  const auto other = session_in(cluster->connection());
  const pid_t last = postmaster_of(folder.path);
  signal_all(folder.path, SIGSTOP);
  REQUIRE(kill(last, SIGKILL) == 0);
  CHECK(soon(seconds(10), [&] { return postmaster_of(folder.path) != last && is_back(); }));
}

TEST_CASE("a running cluster whose directory disappears is not replaced by an empty one") {
  const TemporaryFolder folder;
  const auto cluster = started({folder.path});
  const pid_t before = postmaster_of(folder.path);
  std::filesystem::rename(folder.path + "/postgres", folder.path + "/elsewhere");
  kill(before, SIGKILL);
  CHECK(soon(seconds(5), [&] { return !cluster->health().has_value(); }));
  std::this_thread::sleep_for(seconds(2));
  CHECK(!std::filesystem::exists(folder.path + "/postgres"));
  std::filesystem::rename(folder.path + "/elsewhere", folder.path + "/postgres");
  CHECK(soon(seconds(10), [&] { return cluster->health().has_value(); }));
}

TEST_CASE("the log of a running server stays small") {
  const TemporaryFolder folder;
  const auto cluster = started({folder.path});
  const std::string log = folder.path + "/server.log";
  std::ofstream(log, std::ios::app) << std::string(20 << 20, 'x') << '\n';
  CHECK(soon(seconds(5), [&] { return std::filesystem::file_size(log) < (1 << 20); }));
  CHECK(std::filesystem::file_size(log + ".old") >= (20 << 20));
  const auto session = session_in(cluster->connection());
  CHECK(!session->run("SELECT no_such_column"));
  ask(cluster->connection(), "DO $$ BEGIN RAISE WARNING 'a later line'; END $$");
  CHECK(soon(seconds(5), [&] { return text_of(log).find("a later line") != std::string::npos; }));
  CHECK(std::filesystem::file_size(log) < (1 << 20));
}

TEST_CASE("the server sees no secret of the program's environment") {
  const TemporaryFolder folder;
  setenv("WATERTIGHT_DATABASE_URL", "postgresql://me:a-secret@elsewhere/db", 1);
  setenv("SOME_TOKEN", "a-secret", 1);
  setenv("TZ", "Europe/Amsterdam", 1);
  const auto cluster = started({folder.path});
  for (const char* name : {"WATERTIGHT_DATABASE_URL", "SOME_TOKEN", "TZ"}) unsetenv(name);
  // Reads the file as the kernel has it: of this user, who may look at the process.
  const std::string environment =
      text_of("/proc/" + std::to_string(postmaster_of(folder.path)) + "/environ");
  CHECK(environment.find("LC_ALL=C") != std::string::npos);
  CHECK(environment.find("TZ=Europe/Amsterdam") != std::string::npos);
  CHECK(environment.find("a-secret") == std::string::npos);
}

TEST_CASE("a start says what it waits for, and ends soon when cancelled") {
  const TemporaryFolder folder;
  started({folder.path}).reset();
  const auto lock = store::FileLock::take(folder.path + "/cluster.lock",
                                          store::FileLock::Kind::exclusive, seconds(1));
  REQUIRE(lock);
  Told told;
  Clock::time_point cancelled;
  store::ClusterOptions options{folder.path};
  options.tell = [&told](const std::string& sentence) { told.add(sentence); };
  options.is_cancelled = [&] {
    if (!told.has("another process starts or stops the private database")) return false;
    if (cancelled == Clock::time_point()) cancelled = Clock::now();
    return true;
  };
  const auto cluster = store::PrivateCluster::start(options);
  REQUIRE(!cluster);
  CHECK(cluster.error().code == ErrorCode::cancelled);
  CHECK(Clock::now() - cancelled < seconds(1));
}

TEST_CASE("a start that is cancelled in any of its steps leaves nothing that runs or hinders") {
  const TemporaryFolder folder;
  const std::string data = folder.path + "/data";
  for (const int patience : {100, 700, 1500, 2500, 4000}) {
    const Clock::time_point deadline = Clock::now() + milliseconds(patience);
    store::ClusterOptions options{data};
    options.is_cancelled = [deadline] { return Clock::now() > deadline; };
    const auto cluster = store::PrivateCluster::start(options);
    if (cluster) continue;  // a fast machine was done before
    CHECK(cluster.error().code == ErrorCode::cancelled);
    CHECK(Clock::now() - deadline < seconds(3));
    CHECK(store::postgres_processes_in(data + "/postgres").empty());
    CHECK(!std::filesystem::exists(data + "/postgres.new"));
  }
  CHECK(ask(started({data})->connection(), "SELECT 'there'") == "there");
}

TEST_CASE("opening a store ends soon when cancelled, also while another process migrates") {
  const Database database;
  const auto other = session_in(database.connection());
  REQUIRE(other->run("BEGIN"));
  // A migration begins with this lock.
  REQUIRE(other->run("SELECT pg_advisory_xact_lock(x'7761746572746967'::bigint)"));
  const Clock::time_point deadline = Clock::now() + milliseconds(500);
  const auto store =
      store::open_postgres_store(database.connection(), 1, [&] { return Clock::now() > deadline; });
  CHECK(!store);
  CHECK(Clock::now() - deadline < seconds(2));
  CHECK(Clock::now() > deadline);
}

TEST_CASE("a cluster on a disk that is almost full is not healthy") {
  const TemporaryFolder folder;
  store::ClusterOptions options{folder.path};
  options.least_free_bytes = std::uint64_t{1} << 62;
  const auto cluster = started(options);
  CHECK(soon(seconds(5), [&] { return !cluster->health().has_value(); }));
  CHECK(cluster->health().error().message.find("almost full") != std::string::npos);
}

TEST_CASE("a user that cannot be looked up without free files is no user that is missing") {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{3, 3};
    setrlimit(RLIMIT_NOFILE, &none);
    const Result<std::string> name = store::user_name();
    const bool is_right =
        !name && name.error().message.find("Too many open files") != std::string::npos;
    _exit(is_right ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  CHECK(status == 0);
}

}  // namespace watertight::test::test_supervision
