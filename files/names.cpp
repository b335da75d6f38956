// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/names.h"

#include "base/ascii.h"
#include "formats/document.h"

namespace watertight::files {
namespace {

constexpr std::string_view kCompressedEndings[] = {".gz", ".gzip", ".zst", ".zstd"};

}  // namespace

std::string name_without_compression(std::string_view name) {
  const std::string lower = lower_case(name);
  for (const std::string_view ending : kCompressedEndings) {
    if (lower.ends_with(ending)) return std::string(name.substr(0, name.size() - ending.size()));
  }
  if (lower.ends_with(".tgz")) return std::string(name.substr(0, name.size() - 4)) + ".tar";
  return std::string(name);
}

bool is_document_name(std::string_view name) {
  const std::string plain_name = lower_case(name_without_compression(name));
  return plain_name.ends_with(".wt") || formats::has_known_ending(plain_name);
}

}  // namespace watertight::files
