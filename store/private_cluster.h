// SPDX-License-Identifier: GPL-3.0-or-later
//
// The embedded default (docs/decisions/0004-private-postgresql.md): a private PostgreSQL cluster in
// the data directory, on a Unix socket only. For `serve`, `ingest` and quickstart when no database
// URL is given.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/cancel.h"
#include "base/result.h"

namespace watertight::store {

struct ClusterOptions {
  std::string data_directory;     // created with mode 0700
  std::string postgres_bin = {};  // "" = $WATERTIGHT_POSTGRES_BIN or the usual places
  bool supervise = true;          // look after the server while this object lives
  /// Ends start() within about a second; asked in start() alone.
  CancelPoll is_cancelled = {};
  /// Takes sentences about what start() waits for, and what the supervisor does. Must not wait.
  /// Called from any thread.
  std::function<void(const std::string&)> tell = {};
  /// A server that has not answered for this long is continued if a SIGSTOP has stopped it, and
  /// then killed and recovered.
  std::chrono::seconds continue_after{30};
  std::chrono::seconds kill_after{120};
  /// health() is an error while the disk has less room: PostgreSQL ends when its log (WAL, in files
  /// of 16 MiB) cannot grow.
  std::uint64_t least_free_bytes = 64ULL << 20;
};

/// A running private cluster. The last process that uses the cluster stops it (fast shutdown) by
/// destroying this object; a killed process leaves the cluster running for the next process to
/// join. A thread looks after the server: it starts a server again that died or was told to shut
/// down, continues or kills one that does not answer, and bounds the size of its log. Of several
/// processes that use a cluster, the one that holds cluster.lock acts.
class PrivateCluster {
 public:
  /// Creates the cluster when the directory is empty, recovers it after a crash, starts it or joins
  /// a running one; creates the database "watertight" and, where the server has it, the extension.
  /// Recovery removes a stale postmaster.pid and socket lock, also when another process has the old
  /// number meanwhile, and waits for backends that a killed postmaster left. Any number of
  /// processes may call this at once. Must not run as root. Only the operating system's user can
  /// connect (mode 0700, peer). Errors: unavailable with the reason and the last lines of the
  /// server log; cancelled; invalid_argument.
  static Result<std::unique_ptr<PrivateCluster>> start(const ClusterOptions& options);
  virtual ~PrivateCluster() = default;
  /// The libpq connection string to the database "watertight".
  virtual const std::string& connection() const = 0;
  /// Whether the server takes connections and its disk has room, as the supervisor saw it a moment
  /// ago; Done without a supervisor. Answers at once. Thread-safe. Errors: unavailable.
  virtual Status health() const = 0;
};

/// The calling thread, threads that it starts, and their children can gain no privileges any more,
/// by setuid programs for example. Errors: unavailable.
Status forbid_new_privileges();

/// If the process runs as root: gives `directory` to the system user `watertight` (created by
/// quickstart; see README) and becomes that user. Does nothing for other users. Must be called
/// before any thread starts. Errors: unavailable when there is no such user or it cannot use the
/// directory; invalid_argument for a directory that is not the user's, unless it is root's and
/// empty.
Status drop_root_privileges(const std::string& directory);

}  // namespace watertight::store
