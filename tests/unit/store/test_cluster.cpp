// SPDX-License-Identifier: GPL-3.0-or-later
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "fixture.h"
#include "store/cluster_files.h"

namespace watertight::test::test_cluster {
namespace {

std::unique_ptr<store::PrivateCluster> started(const store::ClusterOptions& options) {
  Result<std::unique_ptr<store::PrivateCluster>> cluster = store::PrivateCluster::start(options);
  INFO((cluster ? std::string() : to_string(cluster.error())));
  REQUIRE(cluster);
  return std::move(*cluster);
}

ErrorCode refusal(const store::ClusterOptions& options) {
  const Result<std::unique_ptr<store::PrivateCluster>> cluster =
      store::PrivateCluster::start(options);
  REQUIRE(!cluster);
  CHECK(!cluster.error().message.empty());
  return cluster.error().code;
}

pid_t postmaster_of(const std::string& data) {
  const auto file = store::read_postmaster_file(data + "/postgres");
  return file ? file->pid : 0;
}

unsigned mode_of(const std::string& path) {
  struct stat status {};
  REQUIRE(stat(path.c_str(), &status) == 0);
  return status.st_mode & 0777;
}

}  // namespace

TEST_CASE("a cluster is created, private, joined, and stopped by its last user") {
  const TemporaryFolder folder;
  const std::string data = folder.path + "/it's a \"new\" data $directory";
  auto first = started({data});
  CHECK(mode_of(data) == 0700);
  CHECK(mode_of(data + "/postgres") == 0700);
  CHECK(mode_of(data + "/socket") == 0700);
  CHECK(ask(first->connection(), "SELECT current_database()::text") == "watertight");
  CHECK(ask(first->connection(), "SELECT current_setting('listen_addresses')").empty());
  CHECK(ask(first->connection(), "SELECT current_setting('data_checksums')") == "on");
  auto second = started({data});
  CHECK(second->connection() == first->connection());
  const pid_t postmaster = postmaster_of(data);
  first.reset();
  CHECK(ask(second->connection(), "SELECT 'still here'") == "still here");
  second.reset();
  CHECK(store::postgres_processes_in(data + "/postgres").empty());
  CHECK(postmaster > 0);
  CHECK(postmaster_of(data) == 0);
}

TEST_CASE("a cluster recovers from every way its server can have died") {
  const TemporaryFolder folder;
  const std::string data = folder.path;
  const auto kill_server = [&] {
    auto cluster = started({data, {}, false});
    ask(cluster->connection(), "CREATE TABLE IF NOT EXISTS t (x int)");
    ask(cluster->connection(), "INSERT INTO t VALUES (1)");
    const pid_t pid = postmaster_of(data);
    kill(pid, SIGKILL);
    while (!store::postgres_processes_in(data + "/postgres").empty()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  };
  const auto rows = [&] {
    const auto cluster = started({data});
    return ask(cluster->connection(), "SELECT count(*)::text FROM t");
  };

  kill_server();  // leaves postmaster.pid and the socket's lock file
  REQUIRE(postmaster_of(data) > 0);
  CHECK(rows() == "1");

  // The number of the server's process now belongs to another process of the same user.
  kill_server();
  const std::string recycled = std::to_string(getpid());
  const auto file = store::read_postmaster_file(data + "/postgres");
  REQUIRE(file);
  for (const std::string& path :
       {data + "/postgres/postmaster.pid", data + "/socket/.s.PGSQL.5432.lock"}) {
    std::ofstream(path) << recycled << '\n'
                        << data << "/postgres\n1\n5432\n"
                        << data << "/socket\n";
  }
  CHECK(rows() == "2");

  // The lock file was cut off.
  kill_server();
  std::ofstream(data + "/postgres/postmaster.pid").close();
  CHECK(rows() == "3");

  // The creation of a cluster was interrupted.
  std::filesystem::create_directory(data + "/postgres.new");
  CHECK(rows() == "3");
}

TEST_CASE("a killed user leaves the cluster to the next one") {
  const TemporaryFolder folder;
  int ready[2];
  REQUIRE(pipe(ready) == 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto cluster = store::PrivateCluster::start({folder.path});
    const char answer = cluster ? 'y' : 'n';
    if (write(ready[1], &answer, 1) == 1) pause();
    _exit(1);
  }
  char answer = 0;
  REQUIRE(read(ready[0], &answer, 1) == 1);
  REQUIRE(answer == 'y');
  const pid_t before = postmaster_of(folder.path);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  {
    const auto cluster = started({folder.path});
    CHECK(postmaster_of(folder.path) == before);
    CHECK(ask(cluster->connection(), "SELECT 'joined'") == "joined");
  }
  CHECK(store::postgres_processes_in(folder.path + "/postgres").empty());
}

TEST_CASE("processes that start a new cluster at the same time share it") {
  const TemporaryFolder folder;
  int go[2];
  REQUIRE(pipe(go) == 0);
  std::vector<pid_t> children;
  for (int i = 0; i < 3; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      close(go[1]);
      char byte = 0;
      // The closing of the pipe starts all processes at once.
      if (read(go[0], &byte, 1) != 0) _exit(9);
      auto cluster = store::PrivateCluster::start({folder.path});
      if (!cluster) _exit(2);
      auto store = store::open_postgres_store((*cluster)->connection());
      const StoredFeature feature = sample_feature("from " + std::to_string(i));
      const bool stored = store && (*store)->put(std::span(&feature, 1));
      cluster->reset();
      _exit(stored ? 0 : 3);
    }
    children.push_back(child);
  }
  close(go[0]);
  close(go[1]);
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(status == 0);
  }
  const auto cluster = started({folder.path});
  CHECK(ask(cluster->connection(), "SELECT count(*)::text FROM watertight.feature") == "3");
}

TEST_CASE("a path that no socket address or connection string can hold has its socket elsewhere") {
  const TemporaryFolder folder;
  const std::string data = folder.path + "/a, " + std::string(120, 'd');
  auto cluster = started({data});
  CHECK(ask(cluster->connection(), "SELECT 'there'") == "there");
  const auto file = store::read_postmaster_file(data + "/postgres");
  REQUIRE(file);
  CHECK(file->socket_folder.starts_with("/tmp/watertight-"));
  CHECK(file->socket_folder.size() < 60);
  CHECK(mode_of(file->socket_folder) == 0700);
  cluster.reset();
  CHECK(!std::filesystem::exists(file->socket_folder));
  // A connection string takes a path with a comma as two hosts.
  const Result<std::string> with_comma = store::prepare_socket_folder("/a,b");
  REQUIRE(with_comma);
  CHECK(with_comma->starts_with("/tmp/watertight-"));
  std::filesystem::remove(*with_comma);
}

TEST_CASE("a cluster is not made in a folder that holds something else") {
  const TemporaryFolder folder;
  std::ofstream(folder.path + "/thesis.txt") << "mine";
  CHECK(refusal({folder.path}) == ErrorCode::invalid_argument);
  CHECK(std::filesystem::exists(folder.path + "/thesis.txt"));
  CHECK(refusal({""}) == ErrorCode::invalid_argument);
  CHECK(refusal({folder.path + "/a\nb"}) == ErrorCode::invalid_argument);
  CHECK(refusal({"/proc/nothing/here"}) == ErrorCode::unavailable);
  CHECK(refusal({"/usr"}) == ErrorCode::invalid_argument);
  CHECK(refusal({folder.path + "/data", "/no/programs/here"}) == ErrorCode::unavailable);
}

TEST_CASE("a server that cannot start is reported with its own message") {
  const TemporaryFolder folder;
  started({folder.path}).reset();
  std::ofstream(folder.path + "/postgres/postgresql.conf", std::ios::app)
      << "no_such_setting = 1\n";
  const auto cluster = store::PrivateCluster::start({folder.path});
  REQUIRE(!cluster);
  CHECK(cluster.error().code == ErrorCode::unavailable);
  CHECK(cluster.error().message.find("no_such_setting") != std::string::npos);
}

TEST_CASE("the database has the extension exactly where the server offers it") {
  const TemporaryFolder folder;
  const auto cluster = started({folder.path});
  CHECK(ask(cluster->connection(),
            "SELECT (SELECT count(*) FROM pg_available_extensions WHERE name = 'watertight') ="
            " (SELECT count(*) FROM pg_extension WHERE extname = 'watertight') AND"
            " (SELECT count(DISTINCT proname) FROM pg_proc WHERE proname = 'wt_encode') ="
            " (SELECT count(*) FROM pg_extension WHERE extname = 'watertight')") ==
        std::string("\1", 1));
  // tests/sql sets the variable for a server that has the extension.
  if (std::getenv("WATERTIGHT_POSTGRES_BIN") != nullptr) {
    CHECK(ask(cluster->connection(), "SELECT wt_version()") == "0.1.0");
  }
}

TEST_CASE("a user other than root stays this user") {
  const uid_t before = geteuid();
  CHECK(store::drop_root_privileges("/nowhere/at/all"));
  CHECK(geteuid() == before);
}

}  // namespace watertight::test::test_cluster
