// SPDX-License-Identifier: GPL-3.0-or-later
//
// The pool, which chooses the process that runs a job, and the conversation with that process.
#include "workers/worker_pool.h"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/checksum.h"
#include "workers/frames.h"
#include "workers/worker_process.h"

namespace watertight::workers {
namespace {

using Clock = std::chrono::steady_clock;

/// The time after which a waiting pool asks again whether the job is cancelled.
constexpr std::chrono::milliseconds kPollInterval{5};
/// The most bytes that are read from the socket at once.
constexpr std::size_t kChunk = std::size_t{1} << 16;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One job's conversation: sends the request, collects the reply, watches the limits and the
/// caller.
class Conversation {
 public:
  Conversation(WorkerProcess& process, ByteView request, const WorkerLimits& limits,
               const CancelPoll& cancel)
      : process_(process), unsent_body_(request), limits_(limits), cancel_(cancel) {
    ByteWriter header;
    header.u32(static_cast<std::uint32_t>(request.size()));
    header.u32(crc32c(request));
    header_ = std::move(header).bytes();
    unsent_header_ = header_;
  }

  /// Runs the job. The CPU time of a process that did not answer is known only when it has ended.
  JobResult run() {
    if (converse()) return std::move(*result_);
    const Ending ending = process_.end();
    if (!result_) explain(ending);
    if (ending.known) {
      result_->cpu_seconds = std::max(ending.cpu_seconds - process_.accounted(), 0.0);
    }
    return std::move(*result_);
  }

  /// True if the process ended on its own before it saw this job, because it was idle for too long.
  bool was_idle_end() const { return was_idle_end_; }

 private:
  /// True if the process answered and can take another job. If no result is there, the stream
  /// ended.
  bool converse() {
    const Clock::time_point start = Clock::now();
    while (!result_) {
      if (cancel_ && cancel_()) {
        finish(JobOutcome::cancelled, "cancelled by the caller");
      } else if (seconds_since(start) >= limits_.wall_seconds) {
        finish(JobOutcome::timed_out, "wall-clock limit");
      } else if (cpu_of_job() >= limits_.cpu_seconds) {
        finish(JobOutcome::timed_out, "CPU limit");
      } else if (sleeps()) {
        finish(JobOutcome::timed_out, "no CPU time used for too long");
      } else {
        wait();
        if (!is_sent() && !transmit()) return false;
        if (!receive()) return false;
        parse();
      }
    }
    return result_->outcome == JobOutcome::ok;
  }

  bool is_sent() const { return unsent_header_.empty() && unsent_body_.empty(); }

  /// CPU time of the job so far, with the start of a new process; 0 once the process has ended.
  double cpu_of_job() const {
    return std::max(process_.cpu_seconds().value_or(0) - process_.accounted(), 0.0);
  }

  /// True if the process has used no CPU time for so long that it is not just waiting for a busy
  /// machine.
  bool sleeps() {
    const double used = cpu_of_job();
    if (used != last_used_) {
      last_used_ = used;
      last_progress_ = Clock::now();
    }
    return seconds_since(last_progress_) >= limits_.sleep_seconds;
  }

  void finish(JobOutcome outcome, std::string detail) {
    result_.emplace();
    result_->outcome = outcome;
    result_->detail = std::move(detail);
  }

  void wait() {
    pollfd watched{process_.socket(), POLLIN, 0};
    if (!is_sent()) watched.events |= POLLOUT;
    poll(&watched, 1, static_cast<int>(kPollInterval.count()));
  }

  /// Sends what the socket takes. False if the process has gone.
  bool transmit() {
    for (ByteView* part : {&unsent_header_, &unsent_body_}) {
      while (!part->empty()) {
        const ssize_t sent = send(process_.socket(), part->data(), part->size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
        *part = part->subspan(static_cast<std::size_t>(sent));
      }
    }
    return true;
  }

  /// Receives one chunk at most, so that a process that writes fast cannot keep the pool from
  /// reading the clock. False if the stream has ended.
  bool receive() {
    std::array<std::uint8_t, kChunk> chunk{};
    bool has_ended = false;
    while (true) {
      const ssize_t got = recv(process_.socket(), chunk.data(), chunk.size(), 0);
      if (got > 0) {
        received_.insert(received_.end(), chunk.data(), chunk.data() + got);
        return true;
      }
      if (got == 0) return false;
      if (errno == EINTR) continue;
      if (errno != EAGAIN && errno != EWOULDBLOCK) return false;
      if (has_ended) return false;
      // A child of the process may hold the socket open after the process itself has ended. The
      // bytes that the process wrote before that are still to be read.
      has_ended = process_.has_ended();
      if (!has_ended) return true;
    }
  }

  /// Makes a result once the reply is complete, or once it is clear that it never will be.
  void parse() {
    if (received_.size() < kReplyHeader) return;
    ByteReader reader(received_);
    const std::size_t length = reader.u32();
    const std::uint32_t checksum = reader.u32();
    const std::uint8_t status = reader.u8();
    if (status > static_cast<std::uint8_t>(ReplyStatus::exception)) {
      finish(JobOutcome::garbage, "reply with an unknown status");
    } else if (length > limits_.reply_bytes) {
      finish(JobOutcome::garbage, "reply of " + std::to_string(length) + " bytes");
    } else if (received_.size() > kReplyHeader + length) {
      finish(JobOutcome::garbage, "bytes after the reply");
    } else if (received_.size() == kReplyHeader + length) {
      conclude(static_cast<ReplyStatus>(status), checksum);
    }
  }

  void conclude(ReplyStatus status, std::uint32_t checksum) {
    received_.erase(received_.begin(), received_.begin() + kReplyHeader);
    if (!is_sent()) {
      finish(JobOutcome::garbage, "a reply before the end of the request");
    } else if (crc32c(received_) != checksum) {
      finish(JobOutcome::garbage, "reply with a wrong checksum");
    } else if (status == ReplyStatus::out_of_memory) {
      finish(JobOutcome::out_of_memory, "out of memory");
    } else if (status == ReplyStatus::exception) {
      finish(JobOutcome::failed, "exception: " + std::string(as_text(received_)));
    } else {
      finish(JobOutcome::ok, {});
      result_->reply = std::move(received_);
      result_->cpu_seconds = cpu_of_job();
    }
  }

  /// Makes the result for a stream that ended without a whole reply.
  void explain(const Ending& ending) {
    was_idle_end_ = ending.known && !ending.by_signal && ending.code == kExitIdle;
    if (ending.by_signal && ending.code == SIGXCPU) {
      finish(JobOutcome::timed_out, "CPU limit");
    } else {
      finish(JobOutcome::crashed, to_string(ending));
    }
  }

  WorkerProcess& process_;
  Bytes header_;
  ByteView unsent_header_;
  ByteView unsent_body_;
  const WorkerLimits& limits_;
  const CancelPoll& cancel_;
  Bytes received_;
  double last_used_ = -1;  // CPU time of the job when it was last seen to grow
  Clock::time_point last_progress_;
  std::optional<JobResult> result_;
  bool was_idle_end_ = false;
};

}  // namespace

std::string_view to_string(JobOutcome outcome) {
  switch (outcome) {
    case JobOutcome::ok:
      return "ok";
    case JobOutcome::failed:
      return "failed";
    case JobOutcome::crashed:
      return "crashed";
    case JobOutcome::timed_out:
      return "timed-out";
    case JobOutcome::out_of_memory:
      return "out-of-memory";
    case JobOutcome::garbage:
      return "garbage";
    case JobOutcome::cancelled:
      return "cancelled";
    case JobOutcome::not_started:
      return "not-started";
  }
  return "";
}

struct WorkerPool::State {
  explicit State(Options given) : options(std::move(given)) {
    options.size = std::max<std::size_t>(options.size, 1);
    options.jobs_per_process = std::max<std::size_t>(options.jobs_per_process, 1);
  }

  Options options;
  std::mutex mutex;
  std::condition_variable returned;
  std::vector<WorkerProcess> idle;
  std::size_t running = 0;

  /// Waits for a free place. False if cancelled meanwhile.
  bool enter(const CancelPoll& cancel) {
    std::unique_lock lock(mutex);
    while (running >= options.size) {
      returned.wait_for(lock, kPollInterval);
      if (cancel && cancel()) return false;
    }
    ++running;
    return true;
  }

  void leave(std::optional<WorkerProcess> process) {
    {
      const std::lock_guard lock(mutex);
      --running;
      if (process) idle.push_back(std::move(*process));
    }
    returned.notify_one();
  }

  /// Reaps idle processes that ended or that wrote without a request.
  void reap() {
    std::vector<WorkerProcess> ended;  // is destroyed, which may take a moment, without the mutex
    const std::lock_guard lock(mutex);
    const auto gone = std::stable_partition(idle.begin(), idle.end(),
                                            [](const WorkerProcess& p) { return p.is_waiting(); });
    std::move(gone, idle.end(), std::back_inserter(ended));
    idle.erase(gone, idle.end());
  }

  /// A waiting process of the pool, or a new one.
  Result<WorkerProcess> take() {
    reap();
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) {
        WorkerProcess process = std::move(idle.back());
        idle.pop_back();
        return process;
      }
    }
    return WorkerProcess::start(options.executable, options.idle_seconds);
  }

  JobResult converse(ByteView request, const WorkerLimits& limits, const CancelPoll& cancel,
                     std::optional<WorkerProcess>& kept) {
    JobResult result;
    // A process can end from idleness at the very moment it gets a job: then another process runs
    // the job. A new process is never idle for long, so the loop ends.
    for (std::size_t attempt = 0; attempt <= options.size + 1; ++attempt) {
      Result<WorkerProcess> process = take();
      if (!process) {
        result.detail = process.error().message;
        return result;
      }
      if (Status limited = process->limit(limits.cpu_seconds, limits.memory_bytes); !limited) {
        result.detail = limited.error().message;
        continue;  // the process ended meanwhile
      }
      Conversation conversation(*process, request, limits, cancel);
      result = conversation.run();
      if (conversation.was_idle_end()) continue;
      process->count_job(result.cpu_seconds);
      if (result.outcome == JobOutcome::ok && process->jobs_done() < options.jobs_per_process) {
        kept = std::move(*process);
      }
      return result;
    }
    result.outcome = JobOutcome::not_started;
    return result;
  }
};

WorkerPool::WorkerPool(Options options) : state_(std::make_unique<State>(std::move(options))) {}

WorkerPool::~WorkerPool() = default;

void WorkerPool::reap() { state_->reap(); }

JobResult WorkerPool::run(ByteView request, const WorkerLimits& limits, const CancelPoll& cancel) {
  JobResult result;
  if (request.size() > std::numeric_limits<std::uint32_t>::max()) {
    result.detail = "request of more than 4 GiB";
    return result;
  }
  if (!state_->enter(cancel)) {
    result.outcome = JobOutcome::cancelled;
    result.detail = "cancelled by the caller";
    return result;
  }
  const Clock::time_point start = Clock::now();
  std::optional<WorkerProcess> kept;
  result = state_->converse(request, limits, cancel, kept);
  state_->leave(std::move(kept));
  result.seconds = seconds_since(start);
  return result;
}

}  // namespace watertight::workers
