// SPDX-License-Identifier: GPL-3.0-or-later
//
// The example of the tests: squares with diagonals around a hole of squares.
#pragma once

#include <cstdint>
#include <vector>

#include "spline/blossom.h"
#include "spline/dms_surface.h"
#include "spline/knot_clouds.h"
#include "tests/random.h"

namespace watertight::samples {

using spline::Index;
using spline::Point;
using spline::Triangle;

/// A domain of 4 x 4 squares of size 1, of which the middle 2 x 2 are a hole that was filled: the
/// clouds of the vertices around it were made without it.
struct GridWithHole {
  spline::DomainArrays arrays;
  std::vector<Index> hole;  // triangles
  std::vector<Index> old;

  explicit GridWithHole(int degree, std::uint64_t seed = 1);
};

/// Random polynomials and points that are the same everywhere.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_.next() >> 11U) / 9007199254740992.0);
  }
  /// In the plane.
  Point point(double low, double high) {
    const double x = between(low, high);
    return {x, between(low, high), 0};
  }
  std::vector<Point> points_in_space(std::size_t count) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i) {
      points.push_back(point(-1, 1));
      points.back().z = between(-1, 1);
    }
    return points;
  }
  spline::Polynomial polynomial(int degree) {
    spline::Polynomial p;
    for (int a = 0; a <= degree; ++a) {
      for (int b = 0; a + b <= degree; ++b)
        p.c[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = between(-1, 1);
    }
    return p;
  }

 private:
  test::Random random_;
};

}  // namespace watertight::samples
