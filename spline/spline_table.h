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

/// A spline: constant in a half-open triangle, or a sum of three of one degree less. It is small,
/// as each value needs about a hundred of them.
struct SplitSpline {
  std::array<std::array<double, 2>, 3> places{};  // of corners()
  double doubled_area = 0;                        // of the corners, signed
  double inverse_area = 0;                        // 1 / doubled_area
  std::array<Index, 3> lower{geometry::kNone, geometry::kNone, geometry::kNone};

  bool is_leaf() const { return lower[0] == geometry::kNone; }
  /// The corners of the triangle, which turns left; or of the base triple.
  std::array<Point, 3> corners() const {
    return {Point{places[0][0], places[0][1], 0}, Point{places[1][0], places[1][1], 0},
            Point{places[2][0], places[2][1], 0}};
  }
};

class SplineTable {
 public:
  /// The number of the spline with these knots (3 to kMostKnots, of which no three lie on a line),
  /// given by numbers of the caller and their points. Its parts have smaller numbers.
  Index add(std::span<const Index> numbers, std::span<const Point> knots);

  const SplitSpline& operator[](Index spline) const { return splines_[spline]; }
  /// Around all knots of a spline, which is 0 outside of it.
  const Rectangle& rectangle(Index spline) const { return rectangles_[spline]; }
  /// The gradients of the barycentric coordinates in its corners.
  std::array<Point, 3> gradients(Index spline) const {
    return barycentric_gradients(splines_[spline].corners(), splines_[spline].doubled_area);
  }
  std::size_t size() const { return splines_.size(); }

  /// Splines are found by their knots only while they are added.
  void finish() { known_.clear(); }

 private:
  using Key = std::array<Index, kMostKnots>;  // sorted, filled with kNone

  std::vector<SplitSpline> splines_;
  std::vector<Rectangle> rectangles_;  // of the splines
  std::map<Key, Index> known_;
};

}  // namespace watertight::spline
