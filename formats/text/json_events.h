// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads JSON text as events with a third of the instructions of nlohmann-json, whose lexer took a
// third of the time of reading. It calls the functions of nlohmann's SAX interface with the same
// values. It has no errors: for a text that it does not read to the end, nlohmann's parser is the
// judge, with its messages and places. Internal to formats/.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace watertight::formats {

/// Appends a code point as UTF-8.
void append_utf8(std::string& out, std::uint32_t code_point);

/// The length of the UTF-8 sequence at the start of a text, 0 if there is none that is well formed.
std::size_t utf8_length(std::string_view text);

template <class Handler>
class JsonEvents {
 public:
  JsonEvents(std::string_view text, Handler& handler) : rest_(text), handler_(handler) {}

  /// True if the text is one JSON value and the handler took all its events. Requires a text
  /// without NUL. Cost: linear.
  bool run() {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    while (read_start()) {
      if (!is_complete_) continue;  // a value of an array or object comes next
      bool has_next = false;
      while (!has_next && !is_array_.empty()) {
        if (!read_next(has_next)) return false;
      }
      if (has_next) continue;
      skip_blanks();
      return rest_.empty();
    }
    return false;
  }

 private:
  char peek() const { return rest_.empty() ? '\0' : rest_.front(); }
  bool take(char c) {
    if (peek() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void skip_blanks() {
    std::size_t count = 0;
    const auto is_blank = [](char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; };
    while (count < rest_.size() && is_blank(rest_[count])) ++count;
    rest_.remove_prefix(count);
  }

  /// Reads a value, or the start of an array or object up to its first value; says which by
  /// is_complete_.
  bool read_start() {
    skip_blanks();
    is_complete_ = true;
    switch (peek()) {
      case '{':
        rest_.remove_prefix(1);
        if (!handler_.start_object(kUnknownSize)) return false;
        skip_blanks();
        if (take('}')) return handler_.end_object();
        is_complete_ = false;
        is_array_.push_back(false);
        return read_key();
      case '[':
        rest_.remove_prefix(1);
        if (!handler_.start_array(kUnknownSize)) return false;
        skip_blanks();
        if (take(']')) return handler_.end_array();
        is_complete_ = false;
        is_array_.push_back(true);
        return true;
      case '"':
        return read_string() && handler_.string(text_);
      case 't':
        return take_word("true") && handler_.boolean(true);
      case 'f':
        return take_word("false") && handler_.boolean(false);
      case 'n':
        return take_word("null") && handler_.null();
      default:
        return read_number();
    }
  }

  /// Reads what follows a value in an array or object: a comma (`has_next`), or the end.
  bool read_next(bool& has_next) {
    skip_blanks();
    const bool is_array = is_array_.back();
    if (take(',')) {
      has_next = true;
      return is_array || read_key();
    }
    is_array_.pop_back();
    return is_array ? take(']') && handler_.end_array() : take('}') && handler_.end_object();
  }

  bool read_key() {
    skip_blanks();
    if (!read_string() || !handler_.key(text_)) return false;
    skip_blanks();
    return take(':');
  }

  bool take_word(std::string_view word) {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }

  std::size_t digits_at(std::size_t begin) const {
    std::size_t end = begin;
    while (end < rest_.size() && rest_[end] >= '0' && rest_[end] <= '9') ++end;
    return end - begin;
  }

  bool read_number() {
    const bool is_negative = peek() == '-';
    std::size_t end = is_negative ? 1 : 0;
    const std::size_t whole = digits_at(end);
    if (whole == 0 || (whole > 1 && rest_[end] == '0')) return false;
    end += whole;
    bool is_whole = true;
    if (end < rest_.size() && rest_[end] == '.') {
      const std::size_t decimals = digits_at(end + 1);
      if (decimals == 0) return false;
      end += 1 + decimals;
      is_whole = false;
    }
    if (end < rest_.size() && (rest_[end] == 'e' || rest_[end] == 'E')) {
      ++end;
      if (end < rest_.size() && (rest_[end] == '+' || rest_[end] == '-')) ++end;
      const std::size_t digits = digits_at(end);
      if (digits == 0) return false;
      end += digits;
      is_whole = false;
    }
    const std::string_view number = rest_.substr(0, end);
    rest_.remove_prefix(end);
    if (std::int64_t value = 0; is_whole && is_negative && parse(number, value)) {
      return handler_.number_integer(value);
    }
    if (std::uint64_t value = 0; is_whole && !is_negative && parse(number, value)) {
      return handler_.number_unsigned(value);
    }
    double value = 0;
    if (!parse(number, value)) return false;
    text_ = number;
    return handler_.number_float(value, text_);
  }

  /// False if the type cannot hold the number.
  template <class Number>
  static bool parse(std::string_view text, Number& value) {
    return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc{};
  }

  /// Reads a string into text_.
  bool read_string() {
    if (!take('"')) return false;
    text_.clear();
    std::size_t end = 0;
    for (;;) {
      while (end < rest_.size() && kIsPlain[static_cast<unsigned char>(rest_[end])]) ++end;
      if (end == rest_.size()) return false;
      const auto byte = static_cast<unsigned char>(rest_[end]);
      if (byte >= 0x80) {
        const std::size_t length = utf8_length(rest_.substr(end));
        if (length == 0) return false;
        end += length;
        continue;
      }
      text_ += rest_.substr(0, end);
      rest_.remove_prefix(end);
      end = 0;
      if (take('"')) return true;
      if (!read_escape()) return false;
    }
  }

  bool read_escape() {
    if (!take('\\') || rest_.empty()) return false;
    const char c = rest_.front();
    rest_.remove_prefix(1);
    if (c == 'u') return read_code_point();
    const std::size_t which = kEscaped.find(c);
    if (which == std::string_view::npos) return false;
    text_ += kUnescaped[which];
    return true;
  }

  /// Reads the four digits after \u, and a second half if they are the first of two.
  bool read_code_point() {
    std::uint32_t value = 0;
    if (!read_hex(value) || (value >= 0xDC00 && value < 0xE000)) return false;
    if (value >= 0xD800 && value < 0xDC00) {
      std::uint32_t low = 0;
      if (!take_word("\\u") || !read_hex(low) || low < 0xDC00 || low >= 0xE000) return false;
      value = 0x10000 + ((value - 0xD800) << 10U) + (low - 0xDC00);
    }
    append_utf8(text_, value);
    return true;
  }

  bool read_hex(std::uint32_t& value) {
    if (rest_.size() < 4) return false;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + 4, value, 16);
    if (error != std::errc{} || end != rest_.data() + 4) return false;
    rest_.remove_prefix(4);
    return true;
  }

  static constexpr std::size_t kUnknownSize = static_cast<std::size_t>(-1);
  static constexpr std::string_view kEscaped = "\"\\/bfnrt";
  static constexpr std::string_view kUnescaped = "\"\\/\b\f\n\r\t";
  static constexpr std::array<bool, 256> kIsPlain = [] {
    std::array<bool, 256> is_plain{};
    for (std::size_t byte = 0x20; byte < 0x80; ++byte) is_plain[byte] = byte != '"' && byte != '\\';
    return is_plain;
  }();

  std::string_view rest_;
  Handler& handler_;
  std::vector<bool> is_array_;  // the arrays and objects that are open
  bool is_complete_ = false;
  std::string text_;  // the last string or number
};

}  // namespace watertight::formats
