// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mesh/mesh_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "formats/surface.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

bool is_blank_in_line(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

}  // namespace

void words_of(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (std::size_t at = 0; at < line.size();) {
    if (is_blank_in_line(line[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < line.size() && !is_blank_in_line(line[end])) ++end;
    words.push_back(line.substr(at, end - at));
    at = end;
  }
}

bool TextLines::next() {
  while (at_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view text = text_.substr(at_, end - at_);
    line_ = {text.substr(0, text.find('#')), at_, line_.number + 1};
    at_ = end + 1;
    words_of(line_.text, words_);
    if (!words_.empty()) return true;
  }
  return false;
}

Error TextLines::ended(const std::string& what) const {
  return Error{ErrorCode::malformed, "the file ends before " + what, text_.size(), {}};
}

std::optional<std::uint64_t> unsigned_word(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (status != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

Error error_at(const TextLine& line, std::string_view word, std::string message) {
  const auto column = static_cast<std::size_t>(word.data() - line.text.data());
  return Error{ErrorCode::malformed,
               "line " + std::to_string(line.number) + ": " + std::move(message),
               line.offset + column,
               {}};
}

Status append_vertex(const TextLine& line, std::span<const std::string_view> words,
                     DecimalVertices& vertices) {
  if (words.size() < 3) return error_at(line, line.text, "a vertex needs three coordinates");
  std::array<GridNumber, 3> position;
  bool is_rounded = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto exact = exact_number(words[axis]);
    if (!exact) return error_at(line, words[axis], exact.error().message);
    position[axis] = exact->value;
    is_rounded = is_rounded || exact->is_rounded;
  }
  vertices.positions.push_back(position);
  vertices.is_rounded.push_back(is_rounded);
  return Done{};
}

}  // namespace watertight::formats
