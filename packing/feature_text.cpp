// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/feature_text.h"

#include <algorithm>
#include <array>

namespace watertight::packing {
namespace {

// Where a text is short because it names the feature's id often, these bytes stand for the id.
constexpr char kHasMarks = '\x02';
constexpr char kIdMark = '\x01';
constexpr std::size_t kShortestId = 3;

/// Takes a line about solids off the front of the text, without its line feed; "" without one.
std::string_view take_line(std::string_view& text) {
  constexpr std::array kStarts{kMergedLine,   kUnprovenLine, kRepairedLine,
                               kMeasuresLine, kReportLine,   kFindingsLine};
  const std::size_t end = text.find('\n');
  const bool is_line =
      std::ranges::any_of(kStarts, [&](auto start) { return text.starts_with(start); });
  if (!is_line || end == std::string_view::npos) return {};
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

}  // namespace

std::string_view model_line(std::string_view text) {
  while (!take_line(text).empty()) continue;
  return text.starts_with('{') ? text.substr(0, text.find('\n')) : std::string_view();
}

std::string_view repair_of(std::string_view text, std::uint64_t solid) {
  const std::string start = std::string(kRepairedLine) + std::to_string(solid) + ' ';
  for (;;) {
    const std::string_view line = take_line(text);
    if (line.empty()) return {};
    if (line.starts_with(start)) return line.substr(start.size());
  }
}

std::string with_marks(const std::string& text, const std::string& id) {
  std::string marked(1, kHasMarks);
  if (text.starts_with(kHasMarks)) return marked += text;  // the byte twice: without marks
  if (id.size() < kShortestId || text.find(kIdMark) != std::string::npos) return text;
  std::size_t place = 0;
  for (std::size_t found = 0; (found = text.find(id, place)) != std::string::npos;) {
    marked.append(text, place, found - place);
    marked += kIdMark;
    place = found + id.size();
  }
  return marked.append(text, place);
}

Result<std::string> without_marks(const std::string& marked, const std::string& id,
                                  std::uint64_t most_bytes) {
  if (!marked.starts_with(kHasMarks)) return marked;
  std::string text;
  if (marked.find(kHasMarks, 1) == 1) return text.append(marked, 1);
  for (std::size_t place = 1; place < marked.size();) {
    const std::size_t found = std::min(marked.find(kIdMark, place), marked.size());
    text.append(marked, place, found - place);
    if (found < marked.size()) text += id;
    if (text.size() > most_bytes) {
      return Error{ErrorCode::limit_exceeded,
                   "a packed text of more than " + std::to_string(most_bytes) + " bytes"};
    }
    place = found + 1;
  }
  return text;
}

}  // namespace watertight::packing
