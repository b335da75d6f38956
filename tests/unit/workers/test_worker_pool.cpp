// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "workers/worker_pool.h"

namespace watertight {
namespace {

WorkerPool::Options faulty(std::size_t size = 1) {
  WorkerPool::Options options;
  options.executable = FAULTY_WORKER;
  options.size = size;
  return options;
}

WorkerLimits seconds(double wall) {
  WorkerLimits limits;
  limits.wall_seconds = wall;
  return limits;
}

JobResult run(WorkerPool& pool, const std::string& request, const WorkerLimits& limits = {}) {
  return pool.run(as_bytes(request), limits);
}

std::string reply(const JobResult& result) { return std::string(as_text(result.reply)); }

bool exists(pid_t process) { return kill(process, 0) == 0; }

/// True if the process is gone, or a zombie, within two seconds.
bool disappears(pid_t process) {
  for (int i = 0; i < 400 && exists(process); ++i) {
    std::ifstream file("/proc/" + std::to_string(process) + "/stat");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    if (text.find(") Z ") != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return !exists(process);
}

bool has_children() {
  siginfo_t info{};
  return waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) == 0;
}

TEST_CASE("a worker answers many jobs from one process") {
  WorkerPool pool(faulty());
  const std::string process = reply(run(pool, "process"));
  for (int i = 0; i < 50; ++i) {
    const JobResult result = run(pool, "job " + std::to_string(i));
    REQUIRE(result.outcome == JobOutcome::ok);
    REQUIRE(reply(result) == "job " + std::to_string(i));
  }
  CHECK(reply(run(pool, "process")) == process);
}

TEST_CASE("empty and large requests come back unchanged") {
  WorkerPool pool(faulty());
  CHECK(run(pool, "").outcome == JobOutcome::ok);
  const std::string large(20'000'000, 'x');
  const JobResult result = run(pool, large);
  REQUIRE(result.outcome == JobOutcome::ok);
  CHECK(reply(result) == large);
}

TEST_CASE("every fault of a worker has its own outcome and costs only its job") {
  WorkerPool pool(faulty());
  const WorkerLimits limits = seconds(0.3);
  const auto check = [&](const std::string& fault, JobOutcome outcome, const std::string& detail) {
    INFO(fault);
    const JobResult result = run(pool, fault, limits);
    CHECK(to_string(result.outcome) == to_string(outcome));
    CHECK(result.detail.find(detail) != std::string::npos);
    CHECK(reply(result).empty());
    const JobResult next = run(pool, "next", seconds(20));
    CHECK(next.outcome == JobOutcome::ok);
  };
  check("crash", JobOutcome::crashed, "signal 11");
  check("abort", JobOutcome::crashed, "signal 6");
  check("exit", JobOutcome::crashed, "status 7");
  check("orphan", JobOutcome::crashed, "status 5");
  check("half-reply", JobOutcome::crashed, "status 0");
  check("exception", JobOutcome::failed, "thrown on purpose");
  check("hang", JobOutcome::timed_out, "wall");
  check("slow-drip", JobOutcome::timed_out, "wall");
  check("garbage", JobOutcome::garbage, "");
  check("wrong-checksum", JobOutcome::garbage, "checksum");
  check("huge-reply", JobOutcome::garbage, "4294967295 bytes");
}

#if !defined(__SANITIZE_ADDRESS__)
TEST_CASE("a worker that wants too much memory is out of memory") {
  WorkerPool pool(faulty());
  WorkerLimits limits;
  limits.memory_bytes = std::uint64_t{256} << 20;
  CHECK(run(pool, "memory", limits).outcome == JobOutcome::out_of_memory);
  CHECK(run(pool, std::string(300 << 20, 'x'), limits).outcome != JobOutcome::ok);
  CHECK(run(pool, "next", limits).outcome == JobOutcome::ok);
}
#endif

TEST_CASE("a worker that burns CPU is stopped by its CPU limit") {
  WorkerPool pool(faulty());
  WorkerLimits limits = seconds(30);
  limits.cpu_seconds = 0.1;
  const JobResult result = run(pool, "spin", limits);
  CHECK(result.outcome == JobOutcome::timed_out);
  CHECK(result.detail == "CPU limit");
}

TEST_CASE("a job can be cancelled while it runs and while it waits for a process") {
  WorkerPool pool(faulty());
  std::atomic<bool> stop = false;
  std::atomic<bool> started = false;
  JobResult first;
  std::thread busy([&] {
    first = pool.run(as_bytes("hang"), {}, [&] {
      started = true;
      return stop.load();
    });
  });
  while (!started) std::this_thread::yield();
  int asked = 0;
  const JobResult waiting = pool.run(as_bytes("next"), {}, [&] { return ++asked > 3; });
  CHECK(waiting.outcome == JobOutcome::cancelled);
  stop = true;
  busy.join();
  CHECK(first.outcome == JobOutcome::cancelled);
  CHECK(first.seconds < 10);
  CHECK(run(pool, "next").outcome == JobOutcome::ok);
}

TEST_CASE("a missing executable is not started") {
  WorkerPool::Options options;
  options.executable = "/nonexistent/worker";
  WorkerPool pool(options);
  const JobResult result = run(pool, "job");
  CHECK(result.outcome == JobOutcome::not_started);
  CHECK(result.detail.find("/nonexistent/worker") != std::string::npos);
}

TEST_CASE("a worker sees nothing of its host") {
  REQUIRE(setenv("WATERTIGHT_TEST_SECRET", "1", 1) == 0);
  sigset_t blocked;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &blocked, nullptr);
  const int leaked = open("/dev/null", O_RDONLY);  // without O_CLOEXEC
  WorkerPool pool(faulty());
  const std::string text = reply(run(pool, "surroundings"));
  close(leaked);
  pthread_sigmask(SIG_UNBLOCK, &blocked, nullptr);
  CHECK(text ==
        "core=0\nleader=yes\ndescriptors=0,1,2,3,\n/dev/null\n/dev/null\n/dev/null\nwritable=no\n"
        "blocked=no\nsecret=no\n");
}

TEST_CASE("a worker is replaced after its number of jobs") {
  WorkerPool::Options options = faulty();
  options.jobs_per_process = 3;
  WorkerPool pool(options);
  const std::string first = reply(run(pool, "process"));
  CHECK(reply(run(pool, "process")) == first);
  CHECK(reply(run(pool, "process")) == first);
  CHECK(reply(run(pool, "process")) != first);
}

TEST_CASE("an idle worker ends itself and the next job gets another") {
  WorkerPool::Options options = faulty();
  options.idle_seconds = 0.05;
  WorkerPool pool(options);
  const std::string first = reply(run(pool, "process"));
  CHECK(disappears(std::stoi(first)));
  const JobResult next = run(pool, "process");
  CHECK(next.outcome == JobOutcome::ok);
  CHECK(reply(next) != first);
}

TEST_CASE("jobs that arrive just as a worker ends from idleness are run all the same") {
  WorkerPool::Options options = faulty();
  options.idle_seconds = 0.004;
  WorkerPool pool(options);
  for (int i = 0; i < 60; ++i) {
    const JobResult result = run(pool, "job");
    REQUIRE(to_string(result.outcome) == "ok");
    std::this_thread::sleep_for(std::chrono::microseconds(3600 + 20 * i));
  }
}

TEST_CASE("concurrent jobs use different processes, at most as many as the pool has") {
  WorkerPool pool(faulty(3));
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&pool, &wrong, t] {
      for (int i = 0; i < 30; ++i) {
        const std::string request = "thread " + std::to_string(t) + " job " + std::to_string(i);
        const JobResult result = run(pool, request);
        if (result.outcome != JobOutcome::ok || reply(result) != request) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
}

TEST_CASE("a pool leaves no process behind, not even a worker's children") {
  pid_t worker = 0;
  pid_t child = 0;
  {
    WorkerPool pool(faulty(2));
    worker = std::stoi(reply(run(pool, "process")));
    child = std::stoi(reply(run(pool, "child")));
    CHECK(exists(worker));
    CHECK(exists(child));
    run(pool, "crash");
    run(pool, "orphan");
  }
  CHECK_FALSE(exists(worker));
  CHECK(disappears(child));
  CHECK_FALSE(has_children());
}

/// Tells the worker's number through the pipe, then waits for ever with a job running.
void be_a_host(int pipe_end) {
  WorkerPool pool(faulty());
  const std::string process = reply(run(pool, "process"));
  if (write(pipe_end, process.data(), process.size()) <= 0) return;
  run(pool, "hang", seconds(60));
}

TEST_CASE("a worker's job ends when its host is killed") {
  for (const bool is_main_thread : {true, false}) {
    INFO(is_main_thread);
    int pipes[2];
    REQUIRE(pipe(pipes) == 0);
    const pid_t host = fork();
    if (host == 0) {
      if (is_main_thread) be_a_host(pipes[1]);
      std::thread([&] { be_a_host(pipes[1]); }).join();
      _exit(0);
    }
    close(pipes[1]);
    char text[32] = {};
    REQUIRE(read(pipes[0], text, sizeof text - 1) > 0);
    close(pipes[0]);
    const pid_t worker = std::atoi(text);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK(exists(worker));
    kill(host, SIGKILL);
    waitpid(host, nullptr, 0);
    CHECK(disappears(worker));
  }
}

TEST_CASE("a worker started by a thread that ended keeps working") {
  WorkerPool pool(faulty());
  std::string first;
  std::thread([&] { first = reply(run(pool, "process")); }).join();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(reply(run(pool, "process")) == first);
}

TEST_CASE("a helper is found in the named folder first") {
  const std::string folder = std::filesystem::path(FAULTY_WORKER).parent_path().string();
  setenv("WATERTIGHT_LIBEXEC", folder.c_str(), 1);
  const Result<std::string> found = find_helper("faulty_worker");
  REQUIRE(found.has_value());
  CHECK(*found == FAULTY_WORKER);
  unsetenv("WATERTIGHT_LIBEXEC");
  const Result<std::string> missing = find_helper("no-such-helper");
  REQUIRE_FALSE(missing.has_value());
  CHECK(missing.error().code == ErrorCode::unavailable);
  CHECK(missing.error().message.find("libexec/watertight") != std::string::npos);
  CHECK_FALSE(find_helper("../bin/sh").has_value());
}

}  // namespace
}  // namespace watertight
