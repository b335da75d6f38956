// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/fitted_plane.h"

#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <vector>

namespace watertight {
namespace {

using Points = std::vector<std::array<double, 3>>;

/// A square of side 2 whose corners are alternately `height` above and below its plane.
Points saddle(double height) {
  return {{-1, -1, height}, {1, -1, -height}, {1, 1, height}, {-1, 1, -height}};
}

TEST_CASE("all corners of a saddle are as far from its plane as it is high") {
  const geometry::PlaneDistance measured = geometry::distance_to_fitted_plane(saddle(0.125), 0.01);
  CHECK(std::fabs(measured.distance - 0.125) < 1e-15);
  CHECK(measured.point == 0);
}

TEST_CASE("a size that is a power of two changes a distance by that factor exactly") {
  const double expected = geometry::distance_to_fitted_plane(saddle(0.1), 0.01).distance;
  for (const int exponent : {-1000, -300, 17, 900}) {
    Points points = saddle(0.1);
    for (auto& p : points) {
      for (double& x : p) x = std::ldexp(x, exponent);
    }
    CHECK(geometry::distance_to_fitted_plane(points, std::ldexp(0.01, exponent)).distance ==
          std::ldexp(expected, exponent));
  }
}

TEST_CASE(
    "where doubles cannot find the plane of a needle its distance is still that of the plane") {
  // A needle 1e9 long and 1 wide, and one point 0.3 off the plane of the others.
  const Points needle{{0, 0, 0}, {1e9, 0, 0}, {1e9, 1, 0}, {0, 1, 0}, {5e8, 0.5, 0.3}};
  const double measured = geometry::distance_to_fitted_plane(needle, 0.01).distance;
  // The least squares plane is 0.06 up, the mean of the five points, and by symmetry not tilted.
  CHECK(std::fabs(measured - 0.24) < 1e-12);
}

TEST_CASE("fewer than four points, and equal ones, are on their plane") {
  CHECK(geometry::distance_to_fitted_plane(Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 5}}, 0).distance ==
        0);
  CHECK(geometry::distance_to_fitted_plane(Points(7, {3, 3, 3}), 0).distance == 0);
}

}  // namespace
}  // namespace watertight
