// SPDX-License-Identifier: GPL-3.0-or-later
//
// One helper process: started, limited, killed with its group and reaped. Private to workers/.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>

#include "base/result.h"

namespace watertight::workers {

/// How a process ended: killed, or by itself.
struct Ending {
  bool by_signal = false;
  int code = 0;            // signal number or exit status
  bool known = false;      // false if somebody else reaped the process
  double cpu_seconds = 0;  // CPU time of its whole life
};
std::string to_string(const Ending& ending);

/// Owns a process and the pool's end of its socket. Not copyable; the destructor ends the process.
class WorkerProcess {
 public:
  /// Starts `executable` as described at WorkerPool. Errors: unavailable, with the system's reason.
  static Result<WorkerProcess> start(const std::string& executable, double idle_seconds);

  WorkerProcess(WorkerProcess&& other) noexcept;
  WorkerProcess& operator=(WorkerProcess&& other) noexcept;
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;
  ~WorkerProcess();

  int socket() const { return socket_; }
  std::size_t jobs_done() const { return jobs_done_; }

  /// Sets the memory limit, and the CPU limit counted from now; for the first job also hard limits:
  /// the same memory, and an hour more of CPU time. Errors: unavailable if the process has ended,
  /// or if the job needs more than its hard limits.
  Status limit(double cpu_seconds, std::uint64_t memory_bytes);
  /// CPU time since the process started; nullopt once it has ended.
  std::optional<double> cpu_seconds() const;
  /// CPU time at the end of the last job that the process answered.
  double accounted() const { return accounted_; }
  void count_job(double cpu_seconds) {
    ++jobs_done_;
    accounted_ += cpu_seconds;
  }
  /// True if the process has ended (and waits to be reaped).
  bool has_ended() const;
  /// True if the process waits for a job: it runs, and has sent no bytes without a request.
  bool is_waiting() const;
  /// Kills the whole group if it still runs, and reaps the process.
  Ending end();

 private:
  WorkerProcess(pid_t process, int socket) : process_(process), socket_(socket) {}
  Status set_limit(int resource, std::uint64_t soft, std::uint64_t hard) const;

  pid_t process_ = -1;
  int socket_ = -1;
  std::size_t jobs_done_ = 0;
  double accounted_ = 0;
  bool has_hard_limits_ = false;
};

}  // namespace watertight::workers
