// SPDX-License-Identifier: GPL-3.0-or-later
//
// A Watertight file that an argument stands for, read in ranges: on a disk or on a web server.
#pragma once

#include <string>

#include "pipeline/file/container_file.h"

namespace watertight::cli {

/// Opens a Watertight file, or reads one whole that comes from a pipe. A torn end is reported on
/// standard error and left out, but not on a web server, where the file may be being copied.
/// Errors: those of open_random() and open_http_file(), and of ContainerFile::open().
Result<pipeline::ContainerFile> open_container(const std::string& argument);

/// Says on standard error that a file is torn, if it is.
void warn_of_torn(const std::string& name, const pipeline::ContainerFile& file);

}  // namespace watertight::cli
