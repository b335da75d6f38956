// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/spline_table.h"

#include <algorithm>
#include <cstddef>

#include "base/assert.h"
#include "geometry/predicates/turn.h"

namespace watertight::spline {
namespace {

SplitSpline leaf_of(std::span<const Point> knots) {
  SplitSpline leaf;
  leaf.corners = {knots[0], knots[1], knots[2]};
  if (geometry::turn(knots[0], knots[1], knots[2]) < 0) std::swap(leaf.corners[1], leaf.corners[2]);
  leaf.doubled_area = twice_area(leaf.corners[0], leaf.corners[1], leaf.corners[2]);
  return leaf;
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
  if (knots.size() == 3) {
    spline = leaf_of(knots);
  } else {
    const BaseTriple triple = base_triple(knots);
    spline.doubled_area = triple.doubled_area;
    for (std::size_t j = 0; j < 3; ++j) {
      const auto place = static_cast<std::size_t>(triple.places[j]);
      spline.corners[j] = knots[place];
      std::vector<Index> fewer_numbers(numbers.begin(), numbers.end());
      std::vector<Point> fewer(knots.begin(), knots.end());
      fewer_numbers.erase(fewer_numbers.begin() + triple.places[j]);
      fewer.erase(fewer.begin() + triple.places[j]);
      spline.lower[j] = add(fewer_numbers, fewer);
    }
  }
  spline.inverse_area = 1 / spline.doubled_area;
  spline.rectangle = Rectangle::around(knots);
  const auto number = static_cast<Index>(splines_.size());
  splines_.push_back(spline);
  known_.emplace(key, number);
  return number;
}

}  // namespace watertight::spline
