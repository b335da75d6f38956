// SPDX-License-Identifier: GPL-3.0-or-later
//
// The files in the data directory of a private cluster, and the processes that work there. For
// private_cluster only.
//
//   DATA/cluster.lock    held exclusively while someone starts or stops the cluster
//   DATA/cluster.users   held shared by every process that uses the cluster
//   DATA/server.log      PostgreSQL's messages; server.log.old has the ones before
//   DATA/socket/         the Unix socket (elsewhere when the path is too long for one)
//   DATA/postgres/       PostgreSQL's own directory (PGDATA)
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"

namespace watertight::store {

/// A lock on a file (flock), shared by processes and freed when its holder ends in any way.
class FileLock {
 public:
  FileLock() = default;
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();

  enum class Kind { shared, exclusive };
  /// Opens (and creates) `path` and takes the lock. Errors: unavailable when the file cannot be
  /// opened, or other processes hold the lock for longer than `patience`; cancelled.
  static Result<FileLock> take(const std::string& path, Kind kind, std::chrono::seconds patience,
                               const CancelPoll& is_cancelled = {});
  /// Turns a shared lock into an exclusive one without waiting; false when another process holds
  /// the lock too.
  bool try_exclusive();

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

/// The statements of a file postmaster.pid.
struct PostmasterFile {
  pid_t pid = 0;
  std::string socket_folder;  // "" while the server starts
  std::string state;          // "starting", "ready", "stopping"; "" early in a start
};
std::optional<PostmasterFile> read_postmaster_file(const std::string& pgdata);

/// Whether `pid` is a PostgreSQL process that works in `pgdata` (a real path). False for another
/// program that took over the number of a dead postmaster.
bool is_postgres_in(pid_t pid, const std::string& pgdata);
/// All PostgreSQL processes that work in `pgdata`: postmaster, backends, and backends that a killed
/// postmaster left.
std::vector<pid_t> postgres_processes_in(const std::string& pgdata);

/// Continues the processes in `pgdata` that a SIGSTOP has stopped; a debugger's are left alone.
void continue_stopped_processes(const std::string& pgdata);

/// The folder of PostgreSQL's programs: `wanted` unless it is "", or else the usual places, first
/// those for `version`, the major version of an existing cluster or "". Errors: unavailable.
Result<std::string> find_programs(const std::string& wanted, const std::string& version);
/// The name of this process's user. Errors: unavailable.
Result<std::string> user_name();

/// Whether a log has more than 16 MiB.
bool is_large_log(const std::string& path);
/// Moves the content of such a log to `path`.old. Its writers, which must append, go on; the
/// lines that they write meanwhile can be lost.
void bound_log(const std::string& path);

/// Creates `folder` with mode 0700, or accepts an existing folder of this user that is empty or
/// holds a cluster. Returns the folder's real path. Errors: invalid_argument, unavailable.
Result<std::string> prepare_data_directory(const std::string& folder);

/// Creates the folder for the Unix socket and returns its path: in `data` if that path fits a
/// socket address and a connection string, else a short path in /tmp, private to the user and named
/// after `data`. Errors: unavailable.
Result<std::string> prepare_socket_folder(const std::string& data);

/// Replaces a file by `content`, which is on the disk before the old file goes; sync_folder() then
/// makes the replacement last. Errors: unavailable.
Status write_file(const std::string& path, const std::string& content);
Status sync_folder(const std::string& path);

/// "cannot <what>: <errno's words>"
Error system_error(const std::string& what);

}  // namespace watertight::store
