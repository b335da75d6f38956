// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/paths/json_tokens.h"

#include <algorithm>

namespace watertight::columns {
namespace {

constexpr std::string_view kStructure = "{}[],: \t\r\n";

std::size_t end_of_quoted(std::string_view text, std::size_t start) {
  for (std::size_t i = start; i < text.size(); ++i) {
    if (text[i] == '"') return i;
    if (text[i] == '\\') ++i;
  }
  return text.size();
}

}  // namespace

Mark JsonTokens::next_mark() {
  std::size_t i = is_quoted_ && !rest_.empty() ? 1 : 0;
  is_quoted_ = false;
  std::size_t followed = 0;
  const auto follow = [&] {
    path_.follow(rest_.substr(followed, i - followed));
    followed = i;
  };
  while (i < rest_.size()) {
    if (kStructure.find(rest_[i]) != std::string_view::npos) {
      ++i;
      continue;
    }
    if (rest_[i] != '"') break;
    follow();
    const std::size_t end = end_of_quoted(rest_, i + 1);
    const bool is_key = path_.is_in_object() && end + 1 < rest_.size() && rest_[end + 1] == ':';
    if (!is_key || path_.has_ids_for_keys()) {
      is_quoted_ = true;
      ++i;
      break;
    }
    i = end + 1;
  }
  follow();
  const Mark mark{rest_.substr(0, i), i == rest_.size()};
  rest_.remove_prefix(i);
  return mark;
}

std::string_view JsonTokens::next_value() {
  std::size_t end = 0;
  if (is_quoted_) {
    end = end_of_quoted(rest_, 0);
  } else {
    while (end < rest_.size() && kStructure.find(rest_[end]) == std::string_view::npos &&
           rest_[end] != '"') {
      ++end;
    }
  }
  const std::string_view value = rest_.substr(0, end);
  rest_.remove_prefix(end);
  return value;
}

}  // namespace watertight::columns
