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

/// A running private cluster. The last process that uses the cluster stops it (fast shutdown) by
/// destroying this object; a killed process leaves the cluster running for the next process to
/// join.
class PrivateCluster {
 public:
  /// Creates the cluster when the directory is empty, recovers it after a crash, starts it or joins
  /// a running one; creates the database "watertight" and, where the server has it, the extension.
  /// Recovery removes a stale postmaster.pid and socket lock, also when another process has the old
  /// number meanwhile, and waits for backends that a killed postmaster left. Any number of
  /// processes may call this at once. Must not run as root. Only the operating system's user can
  /// connect (mode 0700, peer). Errors: unavailable with the reason and the last lines of the
  /// server log; invalid_argument.
  static Result<std::unique_ptr<PrivateCluster>> start(const ClusterOptions& options);
  virtual ~PrivateCluster() = default;
  /// The libpq connection string to the database "watertight".
  virtual const std::string& connection() const = 0;
};

/// If the process runs as root: gives `directory` to the system user `watertight` (created by
/// quickstart; see README) and becomes that user. Does nothing for other users. Must be called
/// before any thread starts. Errors: unavailable when there is no such user or it cannot use the
/// directory; invalid_argument for a directory that is not the user's, unless it is root's and
/// empty.
Status drop_root_privileges(const std::string& directory);

}  // namespace watertight::store
