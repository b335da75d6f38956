// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/part21/part21.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "formats/text/json_events.h"

namespace watertight::formats {
namespace {

constexpr std::string_view kStart = "ISO-10303-21";
constexpr std::size_t kNumberDigits = 400;  // the longest number that is read

bool is_part21_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }
bool is_part21_word(char c) {
  return is_decimal_digit(c) || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
         c == '-';
}

/// The parts of a text between blanks and comments.
class Scanner {
 public:
  Scanner(std::string_view text, std::size_t at) : text_(text), at_(at) {}

  std::size_t at() const { return at_; }
  bool is_at_end() const { return at_ >= text_.size(); }
  char front() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip(std::size_t count) { at_ += count; }

  Error error(std::string message, std::size_t offset) const {
    return Error{ErrorCode::malformed, std::move(message), offset, {}};
  }
  Error error(std::string message) const { return error(std::move(message), at_); }

  Status skip_blanks() {
    while (!is_at_end()) {
      if (is_part21_blank(text_[at_])) {
        ++at_;
      } else if (text_.substr(at_, 2) == "/*") {
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) return error("a comment has no end");
        at_ = end + 2;
      } else {
        break;
      }
    }
    return Done{};
  }

  /// Takes a character after blanks. Errors: malformed if another one stands there.
  Status take(char wanted) {
    if (Status status = skip_blanks(); !status) return status;
    if (front() != wanted) return error(std::string("'") + wanted + "' should stand here");
    ++at_;
    return Done{};
  }

  std::string_view word() {
    const std::size_t begin = at_;
    while (!is_at_end() && is_part21_word(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  /// The text of a string whose quote is next.
  Result<std::string_view> quoted() {
    const std::size_t begin = ++at_;
    while (true) {
      const std::size_t end = text_.find('\'', at_);
      if (end == std::string_view::npos) return error("a string has no end", begin - 1);
      at_ = end + 1;
      if (front() != '\'') return text_.substr(begin, end - begin);
      ++at_;
    }
  }

  Result<std::uint64_t> id() {
    const std::size_t begin = ++at_;  // after '#'
    std::uint64_t id = 0;
    const auto [end, problem] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), id);
    if (problem != std::errc()) return error("a number should follow '#'", begin - 1);
    at_ = static_cast<std::size_t>(end - text_.data());
    return id;
  }

  /// Goes behind the ';' that ends a statement.
  Status skip_statement() {
    const std::size_t begin = at_;
    while (!is_at_end()) {
      const char c = text_[at_];
      if (c == ';') {
        ++at_;
        return Done{};
      }
      if (c == '\'') {
        if (auto text = quoted(); !text) return text.error();
      } else if (c == '/' && text_.substr(at_, 2) == "/*") {
        if (Status status = skip_blanks(); !status) return status;
      } else {
        ++at_;
      }
    }
    return error("a statement has no ';'", begin);
  }

 private:
  std::string_view text_;
  std::size_t at_;
};

/// Reads values of an instance.
class ValueReader {
 public:
  ValueReader(std::string_view text, std::size_t at, std::uint32_t nesting)
      : text_(text), scan_(text, at), nesting_(nesting) {}

  Result<StepInstance> instance(std::uint64_t id, std::size_t offset) {
    StepInstance instance{id, offset, {}};
    if (Status status = scan_.skip_blanks(); !status) return status.error();
    const bool is_complex = scan_.front() == '(';
    if (is_complex) scan_.skip(1);
    do {
      if (Status status = scan_.skip_blanks(); !status) return status.error();
      StepEntity entity{scan_.word(), {}};
      if (entity.type.empty()) return scan_.error("the name of an entity should stand here");
      auto values = list(0);
      if (!values) return values.error();
      entity.values = *std::move(values);
      instance.entities.push_back(std::move(entity));
      if (Status status = scan_.skip_blanks(); !status) return status.error();
    } while (is_complex && scan_.front() != ')' && !scan_.is_at_end());
    if (is_complex) scan_.skip(1);
    if (Status status = scan_.take(';'); !status) return status.error();
    return instance;
  }

 private:
  Result<std::vector<StepValue>> list(std::uint32_t depth) {
    if (depth > nesting_) {
      return Error{ErrorCode::limit_exceeded,
                   "lists are nested deeper than " + std::to_string(nesting_), scan_.at()};
    }
    if (Status status = scan_.take('('); !status) return status.error();
    std::vector<StepValue> values;
    if (Status status = scan_.skip_blanks(); !status) return status.error();
    if (scan_.front() == ')') {
      scan_.skip(1);
      return values;
    }
    while (true) {
      auto next = value(depth);
      if (!next) return next.error();
      values.push_back(*std::move(next));
      if (Status status = scan_.skip_blanks(); !status) return status.error();
      const char c = scan_.front();
      if (c != ',' && c != ')') return scan_.error("',' or ')' should stand here");
      scan_.skip(1);
      if (c == ')') return values;
    }
  }

  Result<StepValue> value(std::uint32_t depth) {
    if (Status status = scan_.skip_blanks(); !status) return status.error();
    StepValue value;
    const char c = scan_.front();
    if (c == '$' || c == '*') {
      scan_.skip(1);
      value.kind = c == '$' ? StepValue::Kind::omitted : StepValue::Kind::derived;
    } else if (c == '#') {
      auto id = scan_.id();
      if (!id) return id.error();
      value.kind = StepValue::Kind::reference;
      value.id = *id;
    } else if (c == '\'' || c == '"') {
      auto text = c == '\'' ? scan_.quoted() : binary();
      if (!text) return text.error();
      value.kind = StepValue::Kind::text;
      value.text = *text;
    } else if (c == '(') {
      auto items = list(depth + 1);
      if (!items) return items.error();
      value.kind = StepValue::Kind::list;
      value.items = *std::move(items);
    } else if (c == '.' && !is_decimal_digit(peek())) {
      scan_.skip(1);
      value.kind = StepValue::Kind::enumeration;
      value.text = scan_.word();
      if (Status status = scan_.take('.'); !status) return status.error();
    } else if (is_decimal_digit(c) || c == '-' || c == '+' || c == '.') {
      return number();
    } else {
      value.kind = StepValue::Kind::typed;
      value.text = scan_.word();
      if (value.text.empty()) return scan_.error("a value should stand here");
      auto items = list(depth + 1);
      if (!items) return items.error();
      value.items = *std::move(items);
    }
    return value;
  }

  char peek() const { return scan_.at() + 1 < text_.size() ? text_[scan_.at() + 1] : '\0'; }

  Result<std::string_view> binary() {
    const std::size_t begin = scan_.at() + 1;
    const std::size_t end = text_.find('"', begin);
    if (end == std::string_view::npos) return scan_.error("a binary has no end");
    scan_.skip(end + 1 - scan_.at());
    return text_.substr(begin, end - begin);
  }

  Result<StepValue> number() {
    const std::size_t begin = scan_.at();
    if (scan_.front() == '+') scan_.skip(1);
    const std::string_view rest = text_.substr(scan_.at(), kNumberDigits);
    StepValue value;
    value.kind = StepValue::Kind::number;
    const auto [end, problem] =
        std::from_chars(rest.data(), rest.data() + rest.size(), value.number);
    if (problem != std::errc() || !std::isfinite(value.number)) {
      return scan_.error("this is not a number that a double can hold", begin);
    }
    scan_.skip(static_cast<std::size_t>(end - rest.data()));
    return value;
  }

  std::string_view text_;
  Scanner scan_;
  std::uint32_t nesting_;
};

/// The first string in FILE_SCHEMA(('...')).
std::string_view first_string(std::string_view statement) {
  const std::size_t begin = statement.find('\'');
  if (begin == std::string_view::npos) return {};
  const std::size_t end = statement.find('\'', begin + 1);
  if (end == std::string_view::npos) return {};
  return statement.substr(begin + 1, end - begin - 1);
}

int hex_digit_value(char c) {
  if (is_decimal_digit(c)) return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

void append_character(std::uint32_t code, std::string& out) {
  const bool is_character = code != 0 && code <= 0x10FFFF && (code < 0xD800 || code >= 0xE000);
  append_utf8(out, is_character ? code : 0xFFFD);
}

/// The number of `digits` hexadecimal digits at a place, or nothing.
std::optional<std::uint32_t> hex_number(std::string_view text, std::size_t at, std::size_t digits) {
  if (at + digits > text.size()) return std::nullopt;
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    const int value = hex_digit_value(text[at + i]);
    if (value < 0) return std::nullopt;
    number = number * 16 + static_cast<std::uint32_t>(value);
  }
  return number;
}

}  // namespace

std::string instance_name(std::uint64_t id) {
  std::string name(1, '#');
  return name.append(std::to_string(id));
}

bool is_part21(std::string_view text) {
  while (!text.empty() && is_part21_blank(text.front())) text.remove_prefix(1);
  return text.starts_with(kStart);
}

std::string decoded_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("''")) {
      out += '\'';
      at += 2;
    } else if (rest.starts_with("\\\\")) {
      out += '\\';
      at += 2;
    } else if (rest.starts_with("\\X2\\") || rest.starts_with("\\X4\\")) {
      const std::size_t digits = rest[2] == '2' ? 4 : 8;
      std::size_t next = at + 4;
      while (const auto code = hex_number(text, next, digits)) {
        append_character(*code, out);
        next += digits;
      }
      at = text.substr(next).starts_with("\\X0\\") ? next + 4 : next;
    } else if (const auto code = hex_number(text, at + 3, 2); rest.starts_with("\\X\\") && code) {
      append_character(*code, out);
      at += 5;
    } else if (rest.starts_with("\\S\\") && rest.size() > 3) {
      append_character(0x80U + static_cast<unsigned char>(rest[3]), out);
      at += 4;
    } else if (static_cast<unsigned char>(text[at]) >= 0x80) {
      append_character(static_cast<unsigned char>(text[at++]), out);
    } else {
      out += text[at++];
    }
  }
  return out;
}

Result<Part21> Part21::read(std::string_view text, const Limits& limits) {
  Part21 file(text, limits);
  if (Status status = file.search(); !status) return status.error();
  return file;
}

Status Part21::search() {
  Scanner scan(text_, 0);
  if (!is_part21(text_)) {
    return scan.error("the text does not start with '" + std::string(kStart) + ";'");
  }
  bool has_data = false;
  bool is_in_data = false;
  while (true) {
    if (Status status = scan.skip_blanks(); !status) return status;
    if (scan.is_at_end()) break;
    const std::size_t begin = scan.at();
    if (is_in_data && scan.front() == '#') {
      auto id = scan.id();
      if (!id) return id.error();
      if (Status status = scan.take('='); !status) return status;
      if (Status status = scan.skip_blanks(); !status) return status;
      places_.push_back({*id, {}, scan.at()});
      places_.back().type = scan.word();
      if (Status status = scan.skip_statement(); !status) return status;
      continue;
    }
    const std::string_view word = scan.word();
    if (Status status = scan.skip_statement(); !status) return status;
    if (word == "FILE_SCHEMA") schema_ = first_string(text_.substr(begin, scan.at() - begin));
    if (word == "DATA") has_data = is_in_data = true;
    if (word == "ENDSEC") is_in_data = false;
    if (word == "END-ISO-10303-21") break;
  }
  if (!has_data || is_in_data) {
    return scan.error(has_data ? "the file ends within its DATA section, before 'ENDSEC;'"
                               : "the file has no DATA section");
  }
  std::sort(places_.begin(), places_.end(), [](const StepPlace& a, const StepPlace& b) {
    return a.id != b.id ? a.id < b.id : a.offset < b.offset;
  });
  const auto twice =
      std::adjacent_find(places_.begin(), places_.end(),
                         [](const StepPlace& a, const StepPlace& b) { return a.id == b.id; });
  if (twice != places_.end()) {
    return scan.error(instance_name(twice->id) + " is defined twice", std::next(twice)->offset);
  }
  return Done{};
}

const StepPlace* Part21::find(std::uint64_t id) const {
  const auto at = std::lower_bound(
      places_.begin(), places_.end(), id,
      [](const StepPlace& place, std::uint64_t wanted) { return place.id < wanted; });
  return at != places_.end() && at->id == id ? &*at : nullptr;
}

Result<StepInstance> Part21::instance(std::uint64_t id) const {
  const StepPlace* place = find(id);
  if (place == nullptr) {
    return Error{ErrorCode::malformed, "there is no instance #" + std::to_string(id), {}, {}};
  }
  return ValueReader(text_, place->offset, limits_.nesting).instance(id, place->offset);
}

std::string_view Part21::type_of(std::uint64_t id) const {
  const StepPlace* place = find(id);
  return place != nullptr ? place->type : std::string_view{};
}

}  // namespace watertight::formats
