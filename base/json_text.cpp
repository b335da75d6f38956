// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.h"

#include <charconv>
#include <cmath>

namespace watertight {
namespace {

/// Length in bytes of the UTF-8 sequence at the front; 0 if the front is not UTF-8.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  }
  const unsigned second = byte(1);
  const bool is_overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool is_outside = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return is_overlong || is_outside ? 0 : length;
}

}  // namespace

std::string utf8_text(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const auto first = static_cast<unsigned char>(text.front());
    const bool is_control = (first < 0x20 && first != '\t' && first != '\n') || first == 0x7F;
    if (length == 0 || is_control) {
      clean += "\xEF\xBF\xBD";
    } else {
      clean += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return clean;
}

std::string json_string(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string json = "\"";
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const char c = text.front();
    if (length == 0) {
      json += "\xEF\xBF\xBD";
    } else if (c == '"' || c == '\\') {
      json += '\\';
      json += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      json += "\\u00";
      json += kHex[static_cast<unsigned char>(c) / 16U];
      json += kHex[static_cast<unsigned char>(c) % 16U];
    } else {
      json += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return json + '"';
}

namespace {

template <class Number>
std::string digits_of(Number number) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  return {buffer.data(), end};
}

}  // namespace

JsonText& JsonText::open(char bracket) {
  punctuate();
  text_ += bracket;
  is_first_ = true;
  return *this;
}

JsonText& JsonText::close(char bracket) {
  text_ += bracket;
  is_first_ = false;
  return *this;
}

JsonText& JsonText::key(std::string_view name) {
  punctuate();
  text_ += json_string(name);
  text_ += ':';
  is_first_ = true;
  return *this;
}

JsonText& JsonText::value(std::string_view string) { return raw(json_string(string)); }
JsonText& JsonText::value(bool truth) { return raw(truth ? "true" : "false"); }
JsonText& JsonText::value(std::int64_t number) { return raw(digits_of(number)); }
JsonText& JsonText::value(std::uint64_t number) { return raw(digits_of(number)); }
JsonText& JsonText::value(std::uint32_t number) { return raw(digits_of(number)); }
JsonText& JsonText::value(int number) { return raw(digits_of(number)); }

JsonText& JsonText::value(double number) {
  return raw(std::isfinite(number) ? digits_of(number) : "null");
}

JsonText& JsonText::value(const std::array<double, 3>& point) {
  open('[');
  for (const double coordinate : point) value(coordinate);
  return close(']');
}

JsonText& JsonText::raw(std::string_view json) {
  punctuate();
  text_ += json;
  return *this;
}

void JsonText::punctuate() {
  if (!is_first_) text_ += ',';
  is_first_ = false;
}

}  // namespace watertight
