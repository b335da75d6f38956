// SPDX-License-Identifier: GPL-3.0-or-later
//
// Starts and watches PostgreSQL's programs (initdb, postgres), for private_cluster only. No shell
// is started, so paths need no quoting.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"

namespace watertight::store {

struct SpawnOptions {
  std::string folder;  // working directory of the child
  std::string log;     // file that stdout and stderr are appended to
};

/// Starts `arguments[0]` (a path) as a session of its own with default signals, no descriptors but
/// 0 to 2, and a short environment: LC_ALL is C, and from this process come search paths, HOME, TZ,
/// TMPDIR and the options of sanitizers alone, so that no secret reaches the child. Errors:
/// unavailable.
Result<pid_t> spawn(const std::vector<std::string>& arguments, const SpawnOptions& options);

/// How a child ended: "exited with status 1" or "was killed by signal 9"; nullopt while the child
/// runs. A child that ended is reaped. Always nullopt for a process that is not our child.
std::optional<std::string> ended(pid_t child);

/// Waits for the end of a child, and kills it with its session after `limit` or when cancelled.
/// Errors: cancelled; unavailable unless it ends with status 0.
Status wait_for(pid_t child, std::chrono::seconds limit, const std::string& name,
                const CancelPoll& is_cancelled);

/// The last `lines` lines of a text file (at most 4 KiB); "" when it cannot be read.
std::string last_lines(const std::string& path, int lines);

}  // namespace watertight::store
