// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds and reads whole files, for tests and for the programs that tests start. The product reads
// files with limits (cli/files.h).
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "base/bytes.h"

namespace watertight::test {

/// The path of a file or folder that the project's sources have:
/// source_path("examples/delft.city.jsonl").
std::string source_path(const std::string& path);

/// The path of a program that was built with the tests.
std::string program_path(const std::string& name);

/// The content of a file.
/// Errors: throws, with the path, if the file cannot be read. That fails a test and ends a program.
inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw std::runtime_error("cannot read " + path.string());
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The content of a file as bytes. Errors: as read_text.
inline Bytes read_bytes(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  return {text.begin(), text.end()};
}

}  // namespace watertight::test
