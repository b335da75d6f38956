// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/paths/xml_tokens.h"

#include <algorithm>

namespace watertight::columns {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// The characters of numbers, and the bytes that stand for positions of solids.
bool is_of_number(char c) {
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E' ||
         (c > '\0' && c < '\t');
}

/// The number of values in a list of numbers, 0 for any other content.
std::size_t list_size(std::string_view content) {
  std::size_t size = 0;
  bool is_in_value = false;
  for (const char c : content) {
    if (is_blank(c)) {
      is_in_value = false;
      continue;
    }
    if (!is_of_number(c)) return 0;
    if (!is_in_value) ++size;
    is_in_value = true;
  }
  return size;
}

std::size_t value_end(std::string_view text) {
  std::size_t end = 0;
  while (end < text.size() && !is_blank(text[end]) && text[end] != '<') ++end;
  return end;
}

}  // namespace

Mark XmlTokens::next_mark() {
  std::size_t i = 0;
  if (quote_ != '\0' && !rest_.empty()) ++i;
  quote_ = '\0';
  while (i < rest_.size()) {
    const char c = rest_[i];
    if (is_in_tag_) {
      ++i;
      if (c == '>') is_in_tag_ = false;
      if (c != '"' && c != '\'') continue;
      quote_ = c;
      break;
    }
    if (c == '<') {
      is_in_tag_ = true;
      ++i;
    } else if (is_blank(c)) {
      ++i;
    } else {
      break;
    }
  }
  const Mark mark{rest_.substr(0, i), i == rest_.size()};
  rest_.remove_prefix(i);
  return mark;
}

std::string_view XmlTokens::next_value() {
  std::size_t end = 0;
  if (quote_ != '\0') {
    end = std::min(rest_.find(quote_), rest_.size());
  } else {
    if (items_ == 0) {
      const std::string_view content = rest_.substr(0, rest_.find('<'));
      items_ = list_size(content);
      end = content.size();
      while (end > 0 && is_blank(content[end - 1])) --end;
    }
    if (items_ > 0) {
      --items_;
      end = value_end(rest_);
    }
  }
  const std::string_view value = rest_.substr(0, end);
  rest_.remove_prefix(end);
  return value;
}

}  // namespace watertight::columns
