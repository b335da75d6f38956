// SPDX-License-Identifier: GPL-3.0-or-later
//
// JSON text, written member by member into a string. For reports and outcomes; documents are read
// and written by formats/.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace watertight {

/// `text` as a JSON string with quotes; bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

/// `text` as UTF-8. Control characters, except tab and line feed, and bytes that are not UTF-8
/// become U+FFFD.
std::string utf8_text(std::string_view text);

/// Writes JSON objects and arrays member by member; the caller keeps them balanced.
class JsonText {
 public:
  JsonText& open(char bracket);   // '{' or '['
  JsonText& close(char bracket);  // '}' or ']'
  JsonText& key(std::string_view name);
  JsonText& value(std::string_view string);
  JsonText& value(const char* string) { return value(std::string_view(string)); }
  JsonText& value(bool truth);
  JsonText& value(double number);  // the shortest text that reads back; null when not finite
  JsonText& value(std::int64_t number);
  JsonText& value(std::uint64_t number);
  JsonText& value(std::uint32_t number);
  JsonText& value(int number);
  JsonText& value(const std::array<double, 3>& point);
  JsonText& raw(std::string_view json);  // a value that is JSON already
  /// The text written since the last call.
  std::string take() { return std::exchange(text_, {}); }

 private:
  void punctuate();

  std::string text_;
  bool is_first_ = true;
};

}  // namespace watertight
