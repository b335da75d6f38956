// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/spline_table.h"

#include <algorithm>
#include <cstddef>

#include "base/assert.h"
#include "geometry/predicates/turn.h"

namespace watertight::spline {
namespace {

/// The corners of a triangle that turns left.
std::array<Point, 3> left_turn_of(std::span<const Point> knots) {
  std::array<Point, 3> corners{knots[0], knots[1], knots[2]};
  if (geometry::turn(knots[0], knots[1], knots[2]) < 0) std::swap(corners[1], corners[2]);
  return corners;
}

}  // namespace

Index SplineTable::add(std::span<const Index> numbers, std::span<const Point> knots) {
  WATERTIGHT_ASSERT(numbers.size() == knots.size() && knots.size() >= 3);
  Key key;
  key.fill(geometry::kNone);
  std::ranges::copy(numbers, key.begin());
  std::ranges::sort(key);  // what is not used is greater than all numbers
  if (const auto found = known_.find(key); found != known_.end()) return found->second;

  SplitSpline spline;
  std::array<Point, 3> corners;
  if (knots.size() == 3) {
    corners = left_turn_of(knots);
    spline.doubled_area = twice_area(corners[0], corners[1], corners[2]);
  } else {
    const BaseTriple triple = base_triple(knots);
    spline.doubled_area = triple.doubled_area;
    for (std::size_t j = 0; j < 3; ++j) {
      const auto place = static_cast<std::size_t>(triple.places[j]);
      corners[j] = knots[place];
      std::vector<Index> fewer_numbers(numbers.begin(), numbers.end());
      std::vector<Point> fewer(knots.begin(), knots.end());
      fewer_numbers.erase(fewer_numbers.begin() + triple.places[j]);
      fewer.erase(fewer.begin() + triple.places[j]);
      spline.lower[j] = add(fewer_numbers, fewer);
    }
  }
  for (std::size_t j = 0; j < 3; ++j) spline.places[j] = {corners[j].x, corners[j].y};
  spline.inverse_area = 1 / spline.doubled_area;
  const auto number = static_cast<Index>(splines_.size());
  splines_.push_back(spline);
  rectangles_.push_back(Rectangle::around(knots));
  known_.emplace(key, number);
  return number;
}

}  // namespace watertight::spline
