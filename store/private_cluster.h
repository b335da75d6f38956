// SPDX-License-Identifier: GPL-3.0-or-later
//
// The embedded default (design section 7): a private PostgreSQL cluster in the data directory, on a
// Unix socket only. For `serve`, `ingest` and quickstart when no database URL is given.
#pragma once

#include <memory>
#include <string>

#include "base/result.h"

namespace watertight {

struct ClusterOptions {
  std::string data_directory;       // created with mode 0700
  std::string postgres_bin = {};    // "" = from pg_config or the usual places
};

/// A running private cluster. Destruction stops it (fast shutdown) if this object started it.
class PrivateCluster {
 public:
  /// Creates the cluster when the directory is empty, recovers from a crash (stale postmaster.pid
  /// and socket lock), starts it or joins a running one. Must not run as root.
  /// Errors: unavailable with the reason and the last lines of the server log.
  static Result<std::unique_ptr<PrivateCluster>> start(const ClusterOptions& options);
  virtual ~PrivateCluster() = default;
  /// libpq connection string to the database "watertight".
  virtual const std::string& connection() const = 0;
};

/// If the process is root: switches to the system user `watertight` (created by quickstart; see
/// README) after handing it `directory`. Does nothing for other users.
Status drop_root_privileges(const std::string& directory);

}  // namespace watertight
