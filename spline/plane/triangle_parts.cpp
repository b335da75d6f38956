// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/plane/triangle_parts.h"

#include <algorithm>

namespace watertight::spline {
namespace {

constexpr double kAlongEdge = kPartsAlongEdge;
constexpr double kMargin = 1e-6;  // of a part's size; more than rounding can move a point

/// A place as shares of the corners b and c, in steps of a part.
Point at_steps(const std::array<Point, 3>& corners, double b, double c) {
  const auto& [p, q, r] = corners;
  return {p.x + b / kAlongEdge * (q.x - p.x) + c / kAlongEdge * (r.x - p.x),
          p.y + b / kAlongEdge * (q.y - p.y) + c / kAlongEdge * (r.y - p.y), 0};
}

}  // namespace

// Rows of parts run along edge ab. Row r has 2 * (4 - r) - 1 parts, upright ones at even places;
// the rows before it have (8 - r) * r parts.
std::size_t part_of(const std::array<Point, 3>& corners, const Point& u) {
  const double area = twice_area(corners[0], corners[1], corners[2]);
  const double along =
      kAlongEdge * std::clamp(twice_area(corners[0], u, corners[2]) / area, 0.0, 1.0);
  const double across =
      kAlongEdge * std::clamp(twice_area(corners[0], corners[1], u) / area, 0.0, 1.0);
  const auto row = std::min(static_cast<std::size_t>(across), kPartsAlongEdge - 1);
  const auto column = std::min(static_cast<std::size_t>(along), kPartsAlongEdge - 1 - row);
  const bool is_beyond =
      along - static_cast<double>(column) + across - static_cast<double>(row) > 1;
  const bool has_inverted = column + 1 < kPartsAlongEdge - row;
  return (2 * kPartsAlongEdge - row) * row + 2 * column + (is_beyond && has_inverted ? 1 : 0);
}

std::array<Point, 3> part_corners(const std::array<Point, 3>& corners, std::size_t part) {
  std::size_t row = 0;
  while ((2 * kPartsAlongEdge - row - 1) * (row + 1) <= part) ++row;
  const std::size_t place = part - (2 * kPartsAlongEdge - row) * row;
  const auto b = static_cast<double>(place / 2);
  const auto c = static_cast<double>(row);
  // Upright parts reach from (b, c) to b + 1 and c + 1, others back from (b + 1, c + 1).
  const double sign = place % 2 == 0 ? 1 : -1;
  const double first_b = sign > 0 ? b - kMargin : b + 1 + kMargin;
  const double first_c = sign > 0 ? c - kMargin : c + 1 + kMargin;
  const double reach = sign * (1 + 3 * kMargin);
  return {at_steps(corners, first_b, first_c), at_steps(corners, first_b + reach, first_c),
          at_steps(corners, first_b, first_c + reach)};
}

}  // namespace watertight::spline
