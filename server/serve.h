// SPDX-License-Identifier: GPL-3.0-or-later
//
// Runs the service until a signal stops it: store, engines, routes and listener together.
#pragma once

#include <signal.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "server/routes.h"
#include "server/transport/listener.h"

namespace watertight::server {

struct ServeOptions {
  ServerOptions server;
  /// A second address that answers /healthz, /readyz and /metrics only, with a thread and
  /// connections of its own.
  std::optional<ServerOptions> probes = {};
  std::string base_url;                        // RouteOptions::base_url
  std::string cors_origin;                     // RouteOptions::cors_origin
  std::string keys_file;                       // of Gate::open(); "" = nobody needs a key
  bool reading_is_public = false;              // with keys_file: reading needs no key
  std::string user_field;                      // RouteOptions::user_field
  bool requires_preconditions = false;         // with every write of features
  std::uint64_t document_memory = 4ULL << 30;  // of the documents that are read whole, bytes
  std::size_t cache_bytes = 64ULL << 20;       // of the answers for items that are kept
  std::string jobs_folder;                     // "" = no jobs
  std::string connection;                      // libpq connection string or URL of the database
  std::size_t database_connections = 24;
  /// A hostile feature takes some 1.3 GB for its text or 200 MB for its reports at these limits.
  Limits limits{.feature_bytes = 32ULL << 20,
                .solids = 20'000,
                .placed_solids = 20'000,
                .expanded = 16ULL << 20};
  /// Whether the database can be used, answered at once; beside the answer of the store. Null:
  /// Done.
  std::function<Status()> database_health = nullptr;
};

/// Takes the signals that stop a program while it lives: SIGTERM, SIGINT, and SIGHUP unless it is
/// ignored (nohup). The first one is a request; a second one, or the end of the grace period after
/// the first, ends the process with exit status 1. Must be made before other threads start.
class StopSignals {
 public:
  /// The grace period of a program that starts.
  static constexpr std::chrono::seconds kStartGrace{5};

  StopSignals();
  ~StopSignals();  // gives the signals back
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Changes the grace period, for signals that are still to come.
  void set_grace(std::chrono::seconds grace) { grace_ = grace; }
  bool is_requested() const { return signal_ != 0; }
  /// Waits for the first signal and returns its number.
  int wait() const;

 private:
  void watch(const std::stop_token& stop);
  int next(const std::stop_token& stop, std::chrono::seconds longest) const;

  sigset_t signals_{};
  sigset_t before_{};
  std::atomic<std::chrono::seconds> grace_ = kStartGrace;
  std::atomic<int> signal_ = 0;
  std::jthread thread_;
};

/// Runs the service and blocks until it has stopped gracefully. Prints "listening on
/// http://ADDRESS:PORT" on standard output when requests are taken, and log lines on standard
/// error. Errors: unavailable (database, address), invalid_argument, those of Gate::open(),
/// cancelled (a signal came before it listened).
Status serve(const ServeOptions& options, StopSignals& signals);

/// Writes a line to standard error unless that would have to wait for its reader.
/// False if it was not written.
bool write_unless_full(std::string_view line);

}  // namespace watertight::server
