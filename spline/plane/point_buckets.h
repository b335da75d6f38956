// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points of the plane by squares, for questions about what is near. Internal to spline/.
#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "spline/simplex_spline.h"

namespace watertight::spline {

class PointBuckets {
 public:
  /// Points nearer than `reach` to a place are among those that all_near asks.
  explicit PointBuckets(double reach) : reach_(reach > 0 ? reach : 1) {}

  void add(const Point& place, std::size_t number) { squares_[square_of(place)].push_back(number); }

  /// Whether a condition holds for the numbers of all points near a place.
  template <class Condition>
  bool all_near(const Point& place, const Condition& condition) const {
    const auto [column, row] = square_of(place);
    for (const double x : {-1.0, 0.0, 1.0}) {
      for (const double y : {-1.0, 0.0, 1.0}) {
        const auto square = squares_.find({column + x, row + y});
        if (square == squares_.end()) continue;
        for (const std::size_t number : square->second) {
          if (!condition(number)) return false;
        }
      }
    }
    return true;
  }

 private:
  std::pair<double, double> square_of(const Point& place) const {
    return {std::floor(place.x / reach_), std::floor(place.y / reach_)};
  }

  double reach_;
  std::map<std::pair<double, double>, std::vector<std::size_t>> squares_;
};

}  // namespace watertight::spline
