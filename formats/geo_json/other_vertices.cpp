// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/geo_json/other_vertices.h"

#include <algorithm>

#include "formats/city_json/model.h"
#include "formats/text/numbers.h"

namespace watertight::formats {

std::optional<CoordinateRanges> ranges_of_other_vertices(
    std::string_view skeleton, const std::optional<geometry::Transform>& transform) {
  const auto parsed = parse_json(skeleton, kOwnText);
  const Json* vertices = parsed ? find_member(*parsed, "vertices") : nullptr;
  const Json* others = vertices == nullptr ? nullptr : find_member(*vertices, "others");
  if (others == nullptr || !others->is_array()) return std::nullopt;
  const bool is_moved = transform && string_member(*vertices, "kind") == "integers";
  std::array<double, 3> scale{1, 1, 1};
  std::array<double, 3> translate{};
  for (std::size_t axis = 0; is_moved && axis < 3; ++axis) {
    scale[axis] = geometry::rounded(transform->scale[axis]);
    translate[axis] = geometry::rounded(transform->translate[axis]);
  }
  std::optional<CoordinateRanges> ranges;
  std::size_t axis = 0;  // of the number that comes next
  std::array<double, 3> position{};
  for (const Json& value : *others) {
    if (value.is_array()) continue;  // an element that is no vertex
    const auto number = exact_number(json_text(value));
    if (!number) return std::nullopt;
    position[axis] = geometry::rounded(number->value) * scale[axis] + translate[axis];
    if (++axis < 3) continue;
    axis = 0;
    if (!ranges) ranges = CoordinateRanges{position, position};
    for (std::size_t i = 0; i < 3; ++i) {
      ranges->min[i] = std::min(ranges->min[i], position[i]);
      ranges->max[i] = std::max(ranges->max[i], position[i]);
    }
  }
  return ranges;
}

}  // namespace watertight::formats
