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
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "pipeline/stored/attributes.h"
#include "server/access/gate.h"
#include "server/budget.h"
#include "server/export_files.h"
#include "server/items/representation_cache.h"
#include "server/jobs/jobs.h"
#include "server/metrics/metrics.h"

namespace watertight::server {
namespace {

/// Writes lines to standard error and never waits for its reader: a line that finds the pipe full
/// is dropped, and the next line that is written says how many were.
class StandardErrorSink final : public spdlog::sinks::base_sink<std::mutex> {
 private:
  // A write of at most PIPE_BUF bytes to a pipe that is ready does not wait.
  static constexpr std::size_t kLongestLine = 4000;

  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    if (dropped_ > 0 &&
        write_unless_full("event=log-lines-dropped count=" + std::to_string(dropped_) + "\n")) {
      dropped_ = 0;
    }
    if (dropped_ > 0 || !write_unless_full({line.data(), std::min(line.size(), kLongestLine)}))
      ++dropped_;
  }
  void flush_() override {}

  std::uint64_t dropped_ = 0;
};

std::shared_ptr<spdlog::logger> make_logger() {
  auto logger =
      std::make_shared<spdlog::logger>("watertight", std::make_shared<StandardErrorSink>());
  logger->set_pattern("time=%Y-%m-%dT%H:%M:%S.%e%z level=%l %v");
  return logger;
}

/// Asks the store again and again whether it can be used, so that probes are answered at once, and
/// calls `tidy_up` each time.
class ReadinessMonitor {
 public:
  ReadinessMonitor(SolidStore& store, std::function<void()> tidy_up)
      : store_(store), tidy_up_(std::move(tidy_up)), thread_([this] { run(); }) {}
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
      tidy_up_();
      Status status = store_.ping();
      std::unique_lock lock(mutex_);
      const auto pause = status ? kPause : kPauseWhileAway;
      status_ = std::move(status);
      asked_ = std::chrono::steady_clock::now();
      if (changed_.wait_for(lock, pause, [this] { return is_stopping_; })) return;
    }
  }

  SolidStore& store_;
  const std::function<void()> tidy_up_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_stopping_ = false;
  Status status_ = Done{};
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
  std::thread thread_;
};

std::string url_of(const ServerOptions& options, std::uint16_t port) {
  const bool is_v6 = options.address.find(':') != std::string::npos;
  std::string url = options.is_encrypted() ? "https://" : "http://";
  url += is_v6 ? "[" + options.address + "]" : options.address;
  return url + ":" + std::to_string(port);
}

/// The gate of the options; null if nobody needs a key. Errors: those of Gate::open().
Result<std::unique_ptr<Gate>> open_gate(const ServeOptions& options) {
  if (options.keys_file.empty()) return std::unique_ptr<Gate>();
  auto opened =
      Gate::open(options.keys_file, options.reading_is_public ? Scope::read : Scope::none);
  if (opened) return opened;
  Error error = std::move(opened).error();
  error.message.insert(0, "the keys in " + options.keys_file + ": ");
  return error;
}

/// The jobs in a folder; null without one. Errors: those of Jobs::open().
Result<std::unique_ptr<Jobs>> open_jobs(const std::string& folder, const Service& service,
                                        const LogLine& log) {
  if (folder.empty()) return std::unique_ptr<Jobs>();
  return Jobs::open(folder, service, log);
}

/// The probes on an address of their own; null without one. Errors: those of HttpServer::start().
Result<std::unique_ptr<HttpServer>> start_probes(const ServeOptions& options,
                                                 const Service& service, const LogLine& log) {
  if (!options.probes) return std::unique_ptr<HttpServer>();
  auto probes = HttpServer::start(*options.probes, probe_application(service), log);
  if (probes) log("event=probes url=" + url_of(*options.probes, (*probes)->port()));
  return probes;
}

/// Reads keys that have changed, and says so.
void log_refresh(Gate& gate, spdlog::logger& logger) {
  const auto refreshed = gate.refresh();
  if (refreshed && *refreshed) logger.info("event=keys-read");
  if (!refreshed) {
    logger.error("event=keys-wrong kept=old error=\"" + to_string(refreshed.error()) + "\"");
  }
}

RouteOptions route_options(const ServeOptions& options) {
  RouteOptions chosen;
  chosen.limits = options.limits;
  chosen.requires_preconditions = options.requires_preconditions;
  chosen.base_url = options.base_url;
  chosen.is_encrypted = options.server.is_encrypted();
  chosen.cors_origin = options.cors_origin;
  chosen.user_field = options.user_field;
  return chosen;
}

}  // namespace

bool write_unless_full(std::string_view line) {
  pollfd out{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&out, 1, 0) != 1 || (out.revents & POLLOUT) == 0) return false;
  return ::write(STDERR_FILENO, line.data(), line.size()) >= 0;
}

StopSignals::StopSignals() {
  sigemptyset(&signals_);
  for (const int signal : {SIGTERM, SIGINT}) sigaddset(&signals_, signal);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaddset(&signals_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

StopSignals::~StopSignals() {
  thread_.request_stop();
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

int StopSignals::wait() const {
  signal_.wait(0);
  return signal_;
}

void StopSignals::watch(const std::stop_token& stop) {
  const int first = next(stop, std::chrono::hours(24 * 365 * 100));
  if (first == 0) return;
  signal_ = first;
  signal_.notify_all();
  const int second = next(stop, grace_.load());
  if (stop.stop_requested()) return;
  write_unless_full("watertight: ended at once, by signal " +
                    std::to_string(second == 0 ? first : second) + "\n");
  _exit(1);
}

/// The next signal; 0 after `longest` or when the object ends.
int StopSignals::next(const std::stop_token& stop, std::chrono::seconds longest) const {
  const auto deadline = std::chrono::steady_clock::now() + longest;
  constexpr timespec kTick{0, 50'000'000};
  while (!stop.stop_requested() && std::chrono::steady_clock::now() < deadline) {
    if (const int signal = sigtimedwait(&signals_, nullptr, &kTick); signal > 0) return signal;
  }
  return 0;
}

Status serve(const ServeOptions& options, StopSignals& signals) {
  for (const int signal : {SIGPIPE, SIGUSR1, SIGUSR2}) std::signal(signal, SIG_IGN);
  const auto is_stopping = [&signals] { return signals.is_requested(); };
  auto store = store::open_postgres_store(
      options.connection, options.database_connections, is_stopping,
      [](const std::string& sentence) {
        write_unless_full("watertight: store: " + sentence + "\n");
      },
      pipeline::read_attributes);
  if (is_stopping()) return Error{ErrorCode::cancelled, "stopped before the service listened"};
  if (!store) return std::move(store).error();
  const auto logger = make_logger();
  const auto opened = open_gate(options);
  if (!opened) return opened.error();
  Gate* const gate = opened->get();
  delaunay::EngineWorkers workers;
  ExportFiles export_files;
  ReadinessMonitor monitor(**store, [&] {
    workers.reap();  // helper processes that ended
    export_files.forget_old();
    if (gate != nullptr) log_refresh(*gate, *logger);
  });
  const auto readiness = [&options, &monitor] {
    Status health = options.database_health ? options.database_health() : Done{};
    return health ? monitor.status() : health;
  };
  RepresentationCache cache(options.cache_bytes);
  Budget document_memory(options.document_memory);
  Service service{store->get(), &workers, {}, readiness, &cache, &export_files, &document_memory};
  service.options = route_options(options);
  service.gate = gate;
  Metrics metrics;
  service.metrics = &metrics;
  const LogLine log = [logger](const std::string& line) { logger->info(line); };
  const auto jobs = open_jobs(options.jobs_folder, service, log);
  if (!jobs) return jobs.error();
  service.jobs = jobs->get();
  const auto probes = start_probes(options, service, log);
  if (!probes) return probes.error();
  Application application = make_application(service);
  application.interrupt = [&store] { (*store)->interrupt(); };
  auto server = HttpServer::start(options.server, std::move(application), log);
  if (!server) return std::move(server).error();

  const std::string url = url_of(options.server, (*server)->port());
  std::printf("listening on %s\n", url.c_str());
  std::fflush(stdout);
  logger->info("event=listening url=" + url);
  const auto drain = static_cast<std::int64_t>(options.server.drain_seconds);
  signals.set_grace(std::chrono::seconds(drain + 30));
  logger->info("event=stopping signal=" + std::to_string(signals.wait()));
  // The job that runs is interrupted at once; what clients wait for has time.
  if (*jobs) (*jobs)->stop();
  (*server)->stop();
  logger->info("event=stopped");
  return Done{};
}

}  // namespace watertight::server
