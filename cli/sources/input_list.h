// SPDX-License-Identifier: GPL-3.0-or-later
//
// The inputs that the arguments of a command stand for: files, the files in folders, the members of
// zip archives, documents on web servers.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "files/files.h"

namespace watertight::cli {

/// The inputs of arguments, in their order; those of a folder (with its subfolders) and of an
/// archive by the bytes of their names. In folders and archives other files are skipped, with a
/// note on standard error. An argument that cannot be read is an input that gives the reason when
/// it is opened. Cost: linear in the number of files; reads the first bytes of each.
std::vector<files::InputFile> list_inputs(std::span<const std::string> arguments);

/// The only input that an argument stands for. Errors: invalid_argument if there are several.
Result<files::InputFile> single_input(const std::string& argument);

}  // namespace watertight::cli
