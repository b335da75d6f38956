// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the predicates where their filter fails: points in one plane or on one line, or near it,
// with coordinates on both sides of the sizes at which another arithmetic is used.
#include "geometry/predicates/predicates.h"

#include <CGAL/Exact_rational.h>

#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>

namespace watertight {
namespace {

using Number = CGAL::Exact_rational;

Number difference(const Point& p, const Point& q, int axis) {
  return Number(p[axis]) - Number(q[axis]);
}

int sign_of(const Number& value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

int exact_orient2d(const Point& a, const Point& b, const Point& c, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const Number area =
      difference(b, a, u) * difference(c, a, v) - difference(b, a, v) * difference(c, a, u);
  return sign_of(area);
}

int exact_orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  Number volume(0);
  for (int k = 0; k < 3; ++k) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    volume += difference(d, a, k) * (difference(b, a, u) * difference(c, a, v) -
                                     difference(b, a, v) * difference(c, a, u));
  }
  return sign_of(volume);
}

/// The point a + i (b - a) + j (c - a), or one a step beside it: exact for integers below 2^53.
Point near_plane(const Point& a, const Point& b, const Point& c, std::mt19937_64& random) {
  const double i = double(random() % 3) - 1, j = double(random() % 3) - 1;
  Point d;
  for (int k = 0; k < 3; ++k) d[k] = a[k] + i * (b[k] - a[k]) + j * (c[k] - a[k]);
  d[int(random() % 3)] += double(random() % 3) - 1;
  return d;
}

TEST_CASE("orientations near zero are exact for coordinates of every size") {
  std::mt19937_64 random(3);
  std::array<int, 3> signs{};
  for (const int bits : {4, 17, 18, 19, 20, 21, 30, 38, 39, 40, 41, 49}) {
    const auto coordinate = [&] {
      return double(random() % (std::uint64_t{1} << bits)) - std::ldexp(1.0, bits - 1);
    };
    for (int round = 0; round < 300; ++round) {
      const Point a{coordinate(), coordinate(), coordinate()};
      const Point b{coordinate(), coordinate(), coordinate()};
      const Point c{coordinate(), coordinate(), coordinate()};
      const Point d = near_plane(a, b, c, random);
      const Point e = near_plane(a, b, b, random);
      INFO(bits << " bits, round " << round);
      const int sign = exact_orient3d(a, b, c, d);
      CHECK(geometry::orient3d(a, b, c, d) == sign);
      ++signs[std::size_t(sign + 1)];
      for (int axis = 0; axis < 3; ++axis) {
        CHECK(geometry::orient2d(a, b, e, axis) == exact_orient2d(a, b, e, axis));
      }
    }
  }
  for (const int count : signs) CHECK(count > 100);
}

}  // namespace
}  // namespace watertight
