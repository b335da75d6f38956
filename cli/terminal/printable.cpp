// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/terminal/printable.h"

#include "base/json_text.h"

namespace watertight::cli {
namespace {

/// The number of bytes to replace at the front of UTF-8 text; 0 if the terminal may have the first
/// character.
std::size_t length_of_control(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  if (byte(0) < 0x20 || byte(0) == 0x7F) return 1;
  if (byte(0) == 0xC2 && byte(1) < 0xA0) return 2;  // U+0080 to U+009F
  if (byte(0) != 0xE2) return 0;
  // U+200E and U+200F, U+2028 to U+202E; U+2066 to U+2069.
  const unsigned last = byte(2);
  const bool is_mark =
      byte(1) == 0x80 && (last == 0x8E || last == 0x8F || (last >= 0xA8 && last <= 0xAE));
  const bool is_isolate = byte(1) == 0x81 && last >= 0xA6 && last <= 0xA9;
  return is_mark || is_isolate ? 3 : 0;
}

}  // namespace

std::string printable(std::string_view text) {
  const std::string utf8 = utf8_text(text);
  std::string clean;
  clean.reserve(utf8.size());
  for (std::size_t at = 0; at < utf8.size();) {
    const std::size_t length = length_of_control(std::string_view(utf8).substr(at));
    if (length == 0) {
      clean += utf8[at++];
    } else {
      clean += "\xEF\xBF\xBD";
      at += length;
    }
  }
  return clean;
}

}  // namespace watertight::cli
