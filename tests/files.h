// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whole files, for tests and for the programs that tests start. Not for the product, which has
// limits (cli/files.h).
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "base/bytes.h"

namespace watertight::test {

/// Everything that a file holds, as it is.
/// Errors: throws, with the path, if it cannot be read. That fails a test and ends a program.
inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw std::runtime_error("cannot read " + path.string());
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The same as bytes.
inline Bytes read_bytes(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  return {text.begin(), text.end()};
}

}  // namespace watertight::test
