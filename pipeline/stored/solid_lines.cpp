// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/stored/solid_lines.h"

#include <algorithm>
#include <charconv>

#include "packing/feature_text.h"

namespace watertight::pipeline {

Result<std::pair<std::size_t, std::string_view>> take_line(std::string_view& skeleton,
                                                           std::string_view start,
                                                           std::size_t solids) {
  const std::size_t end = skeleton.find('\n');
  const std::string_view line = skeleton.substr(start.size(), end - start.size());
  std::size_t solid = 0;
  const auto [rest, error] = std::from_chars(line.data(), line.data() + line.size(), solid);
  if (end == std::string_view::npos || error != std::errc{} || solid >= solids ||
      rest == line.data() + line.size()) {
    return Error{ErrorCode::malformed, "a stored solid: the line has no number of a solid"};
  }
  skeleton.remove_prefix(end + 1);
  return std::pair(solid, line.substr(static_cast<std::size_t>(rest - line.data()) + 1));
}

Result<std::vector<SolidLines>> take_solid_lines(std::string_view& skeleton, std::size_t solids) {
  std::vector<SolidLines> lines(solids);
  for (;;) {
    const auto start = std::ranges::find_if(
        packing::kSolidLines, [&](std::string_view one) { return skeleton.starts_with(one); });
    if (start == packing::kSolidLines.end()) return lines;
    const auto line = take_line(skeleton, *start, solids);
    if (!line) return line.error();
    SolidLines& of_solid = lines[line->first];
    if (*start == packing::kUnprovenLine) of_solid.unproven = line->second;
    if (*start == packing::kMergedLine) of_solid.merged = line->second;
    if (*start == packing::kRepairedLine) of_solid.repaired = line->second;
  }
}

}  // namespace watertight::pipeline
