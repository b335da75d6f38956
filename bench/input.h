// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads files for the programs of bench/.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "formats/document.h"

namespace watertight::bench {

/// The document in a file. Errors: not_found; those of detect_format() and read_document().
inline Result<Document> read_file(const std::filesystem::path& path,
                                  const formats::ReadOptions& options = {}) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Error{ErrorCode::not_found, "cannot be opened"};
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const auto format = formats::detect_format(path.filename().string(), as_bytes(text));
  if (!format) return format.error();
  return formats::read_document(as_bytes(text), *format, options);
}

}  // namespace watertight::bench
