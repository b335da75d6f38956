// SPDX-License-Identifier: GPL-3.0-or-later
//
// Simplex splines split into splines of lower degree, each kept once: neighbouring functions share
// most of their parts. Internal to spline/.
#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>

#include "spline/plane/triangle_grid.h"
#include "spline/simplex_spline.h"

namespace watertight::spline {

/// A spline: constant in a half-open triangle, or a sum of three of one degree less.
struct SplitSpline {
  std::array<Point, 3> corners;  // of the triangle, which turns left; or of the base triple
  double doubled_area = 0;       // signed
  double inverse_area = 0;       // 1 / doubled_area
  Rectangle rectangle;           // around all knots; the spline is 0 outside of it
  std::array<Index, 3> lower{geometry::kNone, geometry::kNone, geometry::kNone};

  bool is_leaf() const { return lower[0] == geometry::kNone; }
};

class SplineTable {
 public:
  /// The number of the spline with these knots (3 to kMostKnots, of which no three lie on a line),
  /// given by numbers of the caller and their points. Its parts have smaller numbers.
  Index add(std::span<const Index> numbers, std::span<const Point> knots);

  const SplitSpline& operator[](Index spline) const { return splines_[spline]; }
  std::size_t size() const { return splines_.size(); }

  /// Splines are found by their knots only while they are added.
  void finish() { known_.clear(); }

 private:
  using Key = std::array<Index, kMostKnots>;  // sorted, filled with kNone

  std::vector<SplitSpline> splines_;
  std::map<Key, Index> known_;
};

}  // namespace watertight::spline
