// SPDX-License-Identifier: GPL-3.0-or-later
//
// Starting and watching PostgreSQL's programs (initdb, postgres) for private_cluster only. No shell
// is involved, so paths need no quoting.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"

namespace watertight::store {

struct SpawnOptions {
  std::string folder;        // working directory of the child
  std::string log;           // file that stdout and stderr are appended to
  bool own_session = false;  // signals to our terminal's process group do not reach the child
};

/// Starts `arguments[0]` (a path) with an environment free of PG*, LC_* and LANG* variables, no
/// descriptors but 0 to 2 and default signals. Errors: unavailable.
Result<pid_t> spawn(const std::vector<std::string>& arguments, const SpawnOptions& options);

/// "exited with status 1" or "was killed by signal 9" once the child has ended (it is then reaped);
/// empty while it runs. A process that is not our child never ends here.
std::optional<std::string> ended(pid_t child);

/// Waits for the end of a child and kills it after `limit`.
/// Errors: unavailable unless it ends with status 0.
Status wait_for(pid_t child, std::chrono::seconds limit, const std::string& name);

/// The last `lines` lines of a text file (at most 4 KiB); "" when it cannot be read.
std::string last_lines(const std::string& path, int lines);

}  // namespace watertight::store
