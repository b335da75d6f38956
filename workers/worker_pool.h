// SPDX-License-Identifier: GPL-3.0-or-later
//
// Helper processes that may crash, hang or exhaust memory without hurting the caller. A job is a
// frame of bytes in and a frame of bytes out over a socketpair; only the caller knows what the
// bytes mean. For delaunay's CDT engines; used by service, CLI and SQL alike.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/bytes.h"
#include "base/cancel.h"
#include "base/result.h"

namespace watertight::workers {

struct WorkerLimits {
  double wall_seconds = 20;
  double cpu_seconds = 15;                  // enforced to about 10 ms
  double sleep_seconds = 10;                // the longest time without any CPU time used
  std::uint64_t memory_bytes = 2ULL << 30;  // RLIMIT_AS of the process
  std::uint64_t reply_bytes = 1ULL << 30;
};

enum class JobOutcome : std::uint8_t {
  ok,
  failed,  // the handler threw: it knows that it has no answer
  crashed,
  timed_out,
  out_of_memory,
  garbage,
  cancelled,
  not_started
};
std::string_view to_string(JobOutcome outcome);

struct JobResult {
  JobOutcome outcome = JobOutcome::not_started;
  Bytes reply;             // the worker's answer, when ok
  std::string detail;      // e.g. "killed by signal 11"
  double seconds = 0;      // wall time
  double cpu_seconds = 0;  // CPU time of the worker: its start if it was new, framing and the job
};

/// A pool of processes of one executable. Thread-safe: concurrent run() calls use different
/// processes, at most `size` at a time. Processes start on first use, serve many jobs, and are
/// replaced after `jobs_per_process` jobs and after every outcome but ok. A process has its own
/// group, an empty private directory, all descriptors but the socket closed, stdout and stderr to
/// /dev/null, no core dumps, a parent-death signal, no new privileges, and the limits of its job,
/// soft and hard.
class WorkerPool {
 public:
  struct Options {
    std::string executable;  // absolute path
    std::size_t size = 2;
    std::size_t jobs_per_process = 500;
    double idle_seconds = 60;  // a process without a job for this long ends itself
  };
  explicit WorkerPool(Options options);
  ~WorkerPool();  // kills every process group and reaps it
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  JobResult run(ByteView request, const WorkerLimits& limits, const CancelPoll& cancel = {});
  /// Reaps processes that ended by themselves, as idle ones do. run() does so too; a program that
  /// may run no job for long calls this now and then.
  void reap();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The worker's side: reads frames from descriptor 3, answers each frame with `handle`, and ends at
/// the end of file or when idle. Returns the exit status for main().
int serve_jobs(const std::function<Bytes(ByteView)>& handle);

/// Finds a helper executable in the folder of the environment variable WATERTIGHT_LIBEXEC, the
/// folder of the running executable, `../libexec/watertight` beside it, or the installation's
/// libexec folder. Errors: unavailable, naming these folders.
Result<std::string> find_helper(const std::string& name);

}  // namespace watertight::workers
