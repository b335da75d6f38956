// SPDX-License-Identifier: GPL-3.0-or-later
//
// The embedded default (docs/decisions/0004-private-postgresql.md): a private PostgreSQL cluster in
// the data directory, on a Unix socket only. For `serve`, `ingest` and quickstart when no database
// URL is given.
#pragma once

#include <memory>
#include <string>

#include "base/result.h"

namespace watertight::store {

struct ClusterOptions {
  std::string data_directory;     // created with mode 0700
  std::string postgres_bin = {};  // "" = $WATERTIGHT_POSTGRES_BIN or the usual places
  bool supervise = true;          // start the server again if it dies while this object lives
};

/// A running private cluster. The last process that uses it stops it (fast shutdown) when its
/// object is destroyed; a process that is killed leaves it running for the next one to join.
class PrivateCluster {
 public:
  /// Creates the cluster when the directory is empty, recovers from a crash (stale postmaster.pid
  /// and socket lock, also when another process has the old number meanwhile; backends that a
  /// killed postmaster left), starts it or joins a running one; creates the database "watertight"
  /// and, where the server has it, the extension. Any number of processes may do so at once.
  /// Must not run as root. Only the operating system's user can connect (mode 0700, peer).
  /// Errors: unavailable with the reason and the last lines of the server log; invalid_argument.
  static Result<std::unique_ptr<PrivateCluster>> start(const ClusterOptions& options);
  virtual ~PrivateCluster() = default;
  /// libpq connection string to the database "watertight".
  virtual const std::string& connection() const = 0;
};

/// If the process is root: switches to the system user `watertight` (created by quickstart; see
/// README) after handing it `directory`. Does nothing for other users. Before any thread starts.
/// Errors: unavailable when there is no such user or it cannot use the directory;
/// invalid_argument for a directory that is someone else's or not one of ours.
Status drop_root_privileges(const std::string& directory);

}  // namespace watertight::store
