// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/serve.h"

#include <poll.h>
#include <pthread.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <mutex>
#include <thread>

#include "server/items/representation_cache.h"

namespace watertight::server {
namespace {

/// The signals that stop the service, to be waited for.
sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  return signals;
}

/// Writes lines to standard error and never waits for its reader: a line that finds the pipe full
/// is dropped, and the next line that is written says how many were.
class StandardErrorSink final : public spdlog::sinks::base_sink<std::mutex> {
 private:
  // A write of at most PIPE_BUF bytes to a pipe that is ready does not wait.
  static constexpr std::size_t kLongestLine = 4000;

  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    if (dropped_ > 0 && write("event=log-lines-dropped count=" + std::to_string(dropped_) + "\n")) {
      dropped_ = 0;
    }
    if (dropped_ > 0 || !write({line.data(), std::min(line.size(), kLongestLine)})) ++dropped_;
  }
  void flush_() override {}

  static bool write(std::string_view text) {
    pollfd out{STDERR_FILENO, POLLOUT, 0};
    if (::poll(&out, 1, 0) != 1 || (out.revents & POLLOUT) == 0) return false;
    return ::write(STDERR_FILENO, text.data(), text.size()) >= 0;
  }

  std::uint64_t dropped_ = 0;
};

std::shared_ptr<spdlog::logger> make_logger() {
  auto logger =
      std::make_shared<spdlog::logger>("watertight", std::make_shared<StandardErrorSink>());
  logger->set_pattern("time=%Y-%m-%dT%H:%M:%S.%e%z level=%l %v");
  return logger;
}

/// Asks the store again and again whether it can be used, so that probes are answered at once.
class ReadinessMonitor {
 public:
  explicit ReadinessMonitor(SolidStore& store) : store_(store), thread_([this] { run(); }) {}
  ~ReadinessMonitor() {
    {
      const std::lock_guard lock(mutex_);
      is_stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  ReadinessMonitor(const ReadinessMonitor&) = delete;
  ReadinessMonitor& operator=(const ReadinessMonitor&) = delete;

  Status status() const {
    const std::lock_guard lock(mutex_);
    if (std::chrono::steady_clock::now() - asked_ < kOld) return status_;
    return Error{ErrorCode::unavailable, "the database does not answer"};
  }

 private:
  static constexpr std::chrono::milliseconds kPause{1000};
  static constexpr std::chrono::milliseconds kPauseWhileAway{250};
  static constexpr std::chrono::seconds kOld{5};  // an answer of then says nothing of now

  void run() {
    for (;;) {
      Status status = store_.ping();
      std::unique_lock lock(mutex_);
      const auto pause = status ? kPause : kPauseWhileAway;
      status_ = std::move(status);
      asked_ = std::chrono::steady_clock::now();
      if (changed_.wait_for(lock, pause, [this] { return is_stopping_; })) return;
    }
  }

  SolidStore& store_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_stopping_ = false;
  Status status_ = Done{};
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
  std::thread thread_;
};

std::string url_of(const ServerOptions& options, std::uint16_t port) {
  const bool is_v6 = options.address.find(':') != std::string::npos;
  return "http://" + (is_v6 ? "[" + options.address + "]" : options.address) + ":" +
         std::to_string(port);
}

/// Ends the process when another stop signal comes or the stop takes longer than `longest`.
void end_at_next_signal(std::chrono::seconds longest,
                        const std::shared_ptr<spdlog::logger>& logger) {
  std::thread([longest, logger] {
    const sigset_t signals = stop_signals();
    const timespec patience{longest.count(), 0};
    const int signal = sigtimedwait(&signals, nullptr, &patience);
    logger->info("event=ended-at-once signal=" + std::to_string(std::max(signal, 0)));
    _exit(1);
  }).detach();
}

}  // namespace

void hold_stop_signals() {
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

Status serve(const ServeOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);
  hold_stop_signals();
  auto store = store::open_postgres_store(options.connection, options.database_connections);
  if (!store) return std::move(store).error();
  delaunay::EngineWorkers workers;
  ReadinessMonitor monitor(**store);
  RepresentationCache cache(options.cache_bytes);
  Service service{store->get(), &workers, {}, [&monitor] { return monitor.status(); }, &cache};
  service.options.limits = options.limits;
  service.options.requires_preconditions = options.requires_preconditions;
  const auto logger = make_logger();
  const LogLine log = [logger](const std::string& line) { logger->info(line); };
  std::unique_ptr<HttpServer> probes;
  if (options.probes) {
    auto started = HttpServer::start(*options.probes, probe_application(service), log);
    if (!started) return std::move(started).error();
    probes = *std::move(started);
    logger->info("event=probes url=" + url_of(*options.probes, probes->port()));
  }
  Application application = make_application(service);
  application.interrupt = [&store] { (*store)->interrupt(); };
  auto server = HttpServer::start(options.server, std::move(application), log);
  if (!server) return std::move(server).error();

  const std::string url = url_of(options.server, (*server)->port());
  std::printf("listening on %s\n", url.c_str());
  std::fflush(stdout);
  logger->info("event=listening url=" + url);
  const sigset_t signals = stop_signals();
  int signal = 0;
  sigwait(&signals, &signal);
  logger->info("event=stopping signal=" + std::to_string(signal));
  const auto drain = static_cast<std::int64_t>(options.server.drain_seconds);
  end_at_next_signal(std::chrono::seconds(drain + 30), logger);
  (*server)->stop();
  logger->info("event=stopped");
  return Done{};
}

}  // namespace watertight::server
