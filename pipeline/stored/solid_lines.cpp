// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/stored/solid_lines.h"

#include <charconv>

#include "packing/feature_text.h"

namespace watertight::pipeline {

using packing::kMergedLine;
using packing::kUnprovenLine;

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
    const bool is_unproven = skeleton.starts_with(kUnprovenLine);
    if (!is_unproven && !skeleton.starts_with(kMergedLine)) return lines;
    const auto line = take_line(skeleton, is_unproven ? kUnprovenLine : kMergedLine, solids);
    if (!line) return line.error();
    SolidLines& of_solid = lines[line->first];
    (is_unproven ? of_solid.unproven : of_solid.merged) = line->second;
  }
}

}  // namespace watertight::pipeline
