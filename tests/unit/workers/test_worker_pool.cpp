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
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/files.h"
#include "workers/worker_pool.h"

namespace watertight {
namespace {

workers::WorkerPool::Options faulty(std::size_t size = 1) {
  workers::WorkerPool::Options options;
  options.executable = test::program_path("faulty_worker");
  options.size = size;
  return options;
}

workers::WorkerLimits seconds(double wall) {
  workers::WorkerLimits limits;
  limits.wall_seconds = wall;
  return limits;
}

workers::JobResult run(workers::WorkerPool& pool, const std::string& request,
                       const workers::WorkerLimits& limits = {}) {
  return pool.run(as_bytes(request), limits);
}

std::string reply(const workers::JobResult& result) { return std::string(as_text(result.reply)); }

bool exists(pid_t process) { return kill(process, 0) == 0; }

/// True if, within two seconds, the process has ended or is a zombie.
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
  workers::WorkerPool pool(faulty());
  const std::string process = reply(run(pool, "process"));
  for (int i = 0; i < 50; ++i) {
    const workers::JobResult result = run(pool, "job " + std::to_string(i));
    REQUIRE(result.outcome == workers::JobOutcome::ok);
    REQUIRE(reply(result) == "job " + std::to_string(i));
  }
  CHECK(reply(run(pool, "process")) == process);
}

TEST_CASE("empty and large requests come back unchanged") {
  workers::WorkerPool pool(faulty());
  CHECK(run(pool, "").outcome == workers::JobOutcome::ok);
  const std::string large(20'000'000, 'x');
  const workers::JobResult result = run(pool, large);
  REQUIRE(result.outcome == workers::JobOutcome::ok);
  CHECK(reply(result) == large);
}

TEST_CASE("every fault of a worker has its own outcome and affects only its job") {
  workers::WorkerPool pool(faulty());
  const workers::WorkerLimits limits = seconds(0.3);
  const auto check = [&](const std::string& fault, workers::JobOutcome outcome,
                         const std::string& detail) {
    INFO(fault);
    const workers::JobResult result = run(pool, fault, limits);
    CHECK(workers::to_string(result.outcome) == workers::to_string(outcome));
    CHECK(result.detail.find(detail) != std::string::npos);
    CHECK(reply(result).empty());
    const workers::JobResult next = run(pool, "next", seconds(20));
    CHECK(next.outcome == workers::JobOutcome::ok);
  };
  check("crash", workers::JobOutcome::crashed, "signal 11");
  check("abort", workers::JobOutcome::crashed, "signal 6");
  check("exit", workers::JobOutcome::crashed, "status 7");
  check("orphan", workers::JobOutcome::crashed, "status 5");
  check("half-reply", workers::JobOutcome::crashed, "status 0");
  check("exception", workers::JobOutcome::failed, "thrown on purpose");
  check("hang", workers::JobOutcome::timed_out, "wall");
  check("slow-drip", workers::JobOutcome::timed_out, "wall");
  check("garbage", workers::JobOutcome::garbage, "");
  check("wrong-checksum", workers::JobOutcome::garbage, "checksum");
  check("huge-reply", workers::JobOutcome::garbage, "4294967295 bytes");
  check("stack", workers::JobOutcome::crashed, "signal 11");
  check("killed-mid-frame", workers::JobOutcome::crashed, "signal 9");
  check("half-header", workers::JobOutcome::timed_out, "wall");
  check("too-long", workers::JobOutcome::garbage, "bytes after the reply");
  check("flood", workers::JobOutcome::garbage, "bytes after the reply");
  check("unknown-status", workers::JobOutcome::garbage, "unknown status");
}

TEST_CASE("a reply longer than its limit is refused by its header") {
  workers::WorkerPool pool(faulty());
  workers::WorkerLimits limits;
  limits.reply_bytes = 500'000;
  const workers::JobResult result = run(pool, "flood", limits);
  CHECK(result.outcome == workers::JobOutcome::garbage);
  CHECK(result.detail == "reply of 1000000 bytes");
  CHECK(run(pool, "next").outcome == workers::JobOutcome::ok);
}

TEST_CASE("the CPU time of a job is counted, also when it is stopped or crashes") {
  workers::WorkerPool pool(faulty());
  workers::WorkerLimits limits;
  limits.wall_seconds = 120;
  limits.cpu_seconds = 0.3;
  const workers::JobResult spun = run(pool, "spin", limits);
  CHECK(spun.outcome == workers::JobOutcome::timed_out);
  CHECK(spun.detail == "CPU limit");
  CHECK(spun.cpu_seconds >= 0.3);
  CHECK(run(pool, "next").outcome == workers::JobOutcome::ok);
  // The CPU limit is for each job: the time of the first job does not count for the second.
  limits.cpu_seconds = 0.5;
  for (int i = 0; i < 8; ++i) {
    const workers::JobResult result = run(pool, "burn", limits);
    REQUIRE(workers::to_string(result.outcome) == "ok");
    CHECK(result.cpu_seconds >= 0.1);
    CHECK(result.cpu_seconds < 0.5);
  }
}

#if !defined(__SANITIZE_ADDRESS__)
TEST_CASE("a worker that wants too much memory is out of memory") {
  workers::WorkerPool pool(faulty());
  workers::WorkerLimits limits;
  limits.memory_bytes = std::uint64_t{256} << 20;
  CHECK(run(pool, "memory", limits).outcome == workers::JobOutcome::out_of_memory);
  CHECK(run(pool, std::string(300 << 20, 'x'), limits).outcome != workers::JobOutcome::ok);
  CHECK(run(pool, "next", limits).outcome == workers::JobOutcome::ok);
}
#endif

TEST_CASE("a worker that burns CPU is stopped by its CPU limit") {
  workers::WorkerPool pool(faulty());
  workers::WorkerLimits limits = seconds(30);
  limits.cpu_seconds = 0.1;
  const workers::JobResult result = run(pool, "spin", limits);
  CHECK(result.outcome == workers::JobOutcome::timed_out);
  CHECK(result.detail == "CPU limit");
}

TEST_CASE("a worker that sleeps is stopped long before its wall-clock limit") {
  workers::WorkerPool pool(faulty());
  workers::WorkerLimits limits = seconds(1e6);
  limits.sleep_seconds = 0.1;
  for (const std::string fault : {"hang", "half-header"}) {
    const workers::JobResult result = run(pool, fault, limits);
    CHECK(result.outcome == workers::JobOutcome::timed_out);
    CHECK(result.detail == "no CPU time used for too long");
  }
}

TEST_CASE("a job can be cancelled while it runs and while it waits for a process") {
  workers::WorkerPool pool(faulty());
  std::atomic<bool> stop = false;
  std::atomic<bool> started = false;
  workers::JobResult first;
  std::thread busy([&] {
    first = pool.run(as_bytes("hang"), {}, [&] {
      started = true;
      return stop.load();
    });
  });
  while (!started) std::this_thread::yield();
  int asked = 0;
  const workers::JobResult waiting = pool.run(as_bytes("next"), {}, [&] { return ++asked > 3; });
  CHECK(waiting.outcome == workers::JobOutcome::cancelled);
  stop = true;
  busy.join();
  CHECK(first.outcome == workers::JobOutcome::cancelled);
  CHECK(first.seconds < 10);
  CHECK(run(pool, "next").outcome == workers::JobOutcome::ok);
}

TEST_CASE("a worker that is killed between two jobs is replaced") {
  workers::WorkerPool pool(faulty());
  for (const int signal : {SIGKILL, SIGSEGV, SIGTERM}) {
    const std::string first = reply(run(pool, "process"));
    const pid_t process = std::stoi(first);
    kill(process, signal);
    siginfo_t info{};  // waits until the process has ended, and leaves it to the pool to reap
    REQUIRE(waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOWAIT) == 0);
    const workers::JobResult next = run(pool, "process");
    CHECK(next.outcome == workers::JobOutcome::ok);
    CHECK(reply(next) != first);
  }
}

TEST_CASE("a missing executable is not started") {
  workers::WorkerPool::Options options;
  options.executable = "/nonexistent/worker";
  workers::WorkerPool pool(options);
  const workers::JobResult result = run(pool, "job");
  CHECK(result.outcome == workers::JobOutcome::not_started);
  CHECK(result.detail.find("/nonexistent/worker") != std::string::npos);
}

TEST_CASE("a worker sees nothing of its host") {
  REQUIRE(setenv("WATERTIGHT_TEST_SECRET", "1", 1) == 0);
  sigset_t blocked;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &blocked, nullptr);
  const int leaked = open("/dev/null", O_RDONLY);  // opened without O_CLOEXEC
  workers::WorkerPool pool(faulty());
  const std::string text = reply(run(pool, "surroundings"));
  close(leaked);
  pthread_sigmask(SIG_UNBLOCK, &blocked, nullptr);
  CHECK(text ==
        "core=0\nhard=yes\nprivileges=no\nleader=yes\ndescriptors=0,1,2,3,\n/dev/null\n/dev/null\n/"
        "dev/null\nwritable=no\n"
        "blocked=no\nsecret=no\n");
}

TEST_CASE("a worker is replaced after its number of jobs") {
  workers::WorkerPool::Options options = faulty();
  options.jobs_per_process = 3;
  workers::WorkerPool pool(options);
  const std::string first = reply(run(pool, "process"));
  CHECK(reply(run(pool, "process")) == first);
  CHECK(reply(run(pool, "process")) == first);
  CHECK(reply(run(pool, "process")) != first);
}

TEST_CASE("an idle worker ends itself and the next job gets another") {
  workers::WorkerPool::Options options = faulty();
  options.idle_seconds = 0.05;
  workers::WorkerPool pool(options);
  const std::string first = reply(run(pool, "process"));
  CHECK(disappears(std::stoi(first)));
  const workers::JobResult next = run(pool, "process");
  CHECK(next.outcome == workers::JobOutcome::ok);
  CHECK(reply(next) != first);
}

TEST_CASE("a pool that is asked to reaps the workers that ended from idleness") {
  workers::WorkerPool::Options options = faulty();
  options.idle_seconds = 0.05;
  workers::WorkerPool pool(options);
  const pid_t process = std::stoi(reply(run(pool, "process")));
  CHECK(disappears(process));
  CHECK(kill(process, 0) == 0);  // a zombie has its number still
  bool is_reaped = false;
  for (int i = 0; i < 2500 && !is_reaped; ++i) {
    pool.reap();
    is_reaped = kill(process, 0) != 0;
    if (!is_reaped) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  CHECK(is_reaped);
}

TEST_CASE("a job that needs more memory than the one before gets another process") {
  workers::WorkerPool pool(faulty());
  workers::WorkerLimits little;
  little.memory_bytes = 1ULL << 30;
  workers::WorkerLimits more;
  more.memory_bytes = 2ULL << 30;
  const std::string first = reply(run(pool, "process", little));
  CHECK(reply(run(pool, "process", little)) == first);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  CHECK(reply(run(pool, "process", more)) != first);
#endif
}

TEST_CASE("jobs that arrive just as a worker ends from idleness are run all the same") {
  workers::WorkerPool::Options options = faulty();
  options.idle_seconds = 0.004;
  workers::WorkerPool pool(options);
  for (int i = 0; i < 60; ++i) {
    const workers::JobResult result = run(pool, "job");
    REQUIRE(workers::to_string(result.outcome) == "ok");
    std::this_thread::sleep_for(std::chrono::microseconds(3600 + 20 * i));
  }
}

TEST_CASE("concurrent jobs use different processes, at most as many as the pool has") {
  workers::WorkerPool pool(faulty(3));
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&pool, &wrong, t] {
      for (int i = 0; i < 30; ++i) {
        const std::string request = "thread " + std::to_string(t) + " job " + std::to_string(i);
        const workers::JobResult result = run(pool, request);
        if (result.outcome != workers::JobOutcome::ok || reply(result) != request) ++wrong;
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
    workers::WorkerPool pool(faulty(2));
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

std::size_t open_descriptors() {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    count += entry.is_symlink() ? 1U : 0U;
  }
  return count;
}

/// A fault, the expected outcome of its job, and the limits of the job.
struct Fault {
  std::string request;
  workers::JobOutcome outcome = workers::JobOutcome::ok;
  double wall_seconds = 120;
  double cpu_seconds = 60;
};

std::vector<Fault> faults() {
  std::vector<Fault> list = {{"crash", workers::JobOutcome::crashed},
                             {"abort", workers::JobOutcome::crashed},
                             {"exit", workers::JobOutcome::crashed},
                             {"orphan", workers::JobOutcome::crashed},
                             {"half-reply", workers::JobOutcome::crashed},
                             {"killed-mid-frame", workers::JobOutcome::crashed},
                             {"stack", workers::JobOutcome::crashed},
                             {"exception", workers::JobOutcome::failed},
                             {"garbage", workers::JobOutcome::garbage},
                             {"wrong-checksum", workers::JobOutcome::garbage},
                             {"huge-reply", workers::JobOutcome::garbage},
                             {"too-long", workers::JobOutcome::garbage},
                             {"unknown-status", workers::JobOutcome::garbage},
                             {"hang", workers::JobOutcome::timed_out, 0.05},
                             {"half-header", workers::JobOutcome::timed_out, 0.05},
                             {"slow-drip", workers::JobOutcome::timed_out, 0.05},
                             {"spin", workers::JobOutcome::timed_out, 120, 0.02}};
#if !defined(__SANITIZE_ADDRESS__)
  list.push_back({"memory", workers::JobOutcome::out_of_memory});
  list.push_back({"memory-bit-by-bit", workers::JobOutcome::out_of_memory});
#endif
  return list;
}

/// Runs jobs from several threads, every second one with a random fault, until `goes_on` is false.
/// Returns messages about wrong outcomes. `done` counts the jobs.
std::vector<std::string> run_random_faults(unsigned seed,
                                           const std::function<bool(std::size_t)>& goes_on,
                                           std::atomic<std::size_t>& done) {
  const std::vector<Fault> list = faults();
  std::vector<std::string> wrong;
  std::mutex mutex;
  workers::WorkerPool pool(faulty(4));
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 6; ++t) {
    threads.emplace_back([&, t] {
      std::mt19937 generator(seed * 100 + t);
      while (goes_on(done++)) {
        const auto number = generator();
        Fault job{"thread " + std::to_string(t) + " job " + std::to_string(number)};
        if (generator() % 2 == 0) job = list[number % list.size()];
        workers::WorkerLimits limits;
        limits.wall_seconds = job.wall_seconds;
        limits.cpu_seconds = job.cpu_seconds;
        limits.memory_bytes = std::uint64_t{256} << 20;
        const workers::JobResult result = pool.run(as_bytes(job.request), limits);
        const std::string expected = job.outcome == workers::JobOutcome::ok ? job.request : "";
        if (result.outcome == job.outcome && reply(result) == expected) continue;
        const std::lock_guard lock(mutex);
        wrong.push_back(job.request + ": " + std::string(workers::to_string(result.outcome)) +
                        ": " + result.detail);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  return wrong;
}

/// Checks random faults; returns the number of jobs.
std::size_t check_random_faults(unsigned seed, const std::function<bool(std::size_t)>& goes_on) {
  std::atomic<std::size_t> done = 0;
  run_random_faults(
      seed, [](std::size_t number) { return number < 8; }, done);
  done = 0;
  const std::size_t before = open_descriptors();
  for (const std::string& wrong : run_random_faults(seed, goes_on, done)) {
    INFO(wrong);
    CHECK(false);
  }
  CHECK(open_descriptors() == before);
  CHECK_FALSE(has_children());
  return done - 6;  // each thread counts one job more when it ends
}

TEST_CASE("random faults of concurrent jobs affect their own jobs only and leak nothing") {
  CHECK(check_random_faults(1, [](std::size_t number) { return number < 250; }) == 250);
}

// The test does not run by default: WATERTIGHT_SOAK_SECONDS=180 test_workers "[soak]".
TEST_CASE("random faults for a long time", "[.soak]") {
  const char* text = std::getenv("WATERTIGHT_SOAK_SECONDS");
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::seconds(text != nullptr ? std::strtol(text, nullptr, 10) : 60);
  const unsigned seed = std::random_device{}();
  const std::size_t jobs = check_random_faults(
      seed, [end](std::size_t) { return std::chrono::steady_clock::now() < end; });
  WARN(jobs << " jobs, seed " << seed);
}

/// Writes the id of the worker's process to the pipe, then waits for ever with a running job.
void be_a_host(int pipe_end) {
  workers::WorkerPool pool(faulty());
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
  workers::WorkerPool pool(faulty());
  std::string first;
  std::thread([&] { first = reply(run(pool, "process")); }).join();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(reply(run(pool, "process")) == first);
}

TEST_CASE("a helper is found in the named folder first") {
  const std::string folder =
      std::filesystem::path(test::program_path("faulty_worker")).parent_path().string();
  setenv("WATERTIGHT_LIBEXEC", folder.c_str(), 1);
  const Result<std::string> found = workers::find_helper("faulty_worker");
  REQUIRE(found.has_value());
  CHECK(*found == test::program_path("faulty_worker"));
  unsetenv("WATERTIGHT_LIBEXEC");
  const Result<std::string> missing = workers::find_helper("no-such-helper");
  REQUIRE_FALSE(missing.has_value());
  CHECK(missing.error().code == ErrorCode::unavailable);
  CHECK(missing.error().message.find("libexec/watertight") != std::string::npos);
  CHECK_FALSE(workers::find_helper("../bin/sh").has_value());
}

}  // namespace
}  // namespace watertight
