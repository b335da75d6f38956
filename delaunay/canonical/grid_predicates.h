// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exact signs for points whose coordinates are integers in [0, 2^30). Private to delaunay/: inlined
// into the loops of small_delaunay.cpp, without any library.
//
// Signs are computed in doubles first. All differences of coordinates are exact. A value computed
// from exact numbers, each of whose monomials passes through at most k roundings, is wrong by at
// most k u / (1 - k u) times the sum of the monomials' magnitudes, u = 2^-53 (Higham, Accuracy and
// Stability of Numerical Algorithms, 2002, lemma 3.1). With x, y, z the sides of the points' box, V
// = x y z and L = x^2 + y^2 + z^2 that sum is at most 6 V for an orientation and 24 L V for a
// sphere; k is 5 and 11. If the sum itself is at most 2^53, no step rounds at all.
// Signs that doubles do not decide are computed in integers. A 2 x 2 minor is below 2^61, an
// orientation below 2^93, a squared distance below 2^62 and so the determinant of a sphere below
// 2^157.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/assert.h"
#include "geometry/point.h"

namespace watertight::delaunay {

class GridPredicates {
 public:
  /// For points in the box from the origin to `extent`, whose coordinates are integers below 2^30.
  explicit GridPredicates(const Point& extent) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // the unit roundoff u
    constexpr double kExact = 9007199254740992.0;
    const double volume = extent.x * extent.y * extent.z;
    const double lift = extent.x * extent.x + extent.y * extent.y + extent.z * extent.z;
    // 5 * 6 and 11 * 24 enlarged by more than the roundings of these lines themselves.
    if (6 * volume > kExact) orientation_error_ = 32 * kUnit * volume;
    if (24 * lift * volume > kExact) sphere_error_ = 280 * kUnit * (lift * volume);
  }

  /// Sign of det(b - a, c - a, d - a): positive if d sees a, b, c turn clockwise.
  int orientation(const Point& a, const Point& b, const Point& c, const Point& d) const {
    const Point u = difference(b, a);
    const Point v = difference(c, a);
    const Point w = difference(d, a);
    const double value = w.x * (u.y * v.z - u.z * v.y) + w.y * (u.z * v.x - u.x * v.z) +
                         w.z * (u.x * v.y - u.y * v.x);
    if (value > orientation_error_) return 1;
    if (value < -orientation_error_) return -1;
    return orientation_error_ == 0 ? 0 : exact_orientation(u, v, w);
  }

  /// 1 if p lies inside the sphere through the corners of a tetrahedron of positive orientation,
  /// -1 outside, 0 on it.
  int side_of_sphere(const std::array<const Point*, 4>& t, const Point& p) const {
    const Point a = difference(*t[0], p);
    const Point b = difference(*t[1], p);
    const Point c = difference(*t[2], p);
    const Point d = difference(*t[3], p);
    const double ab = a.x * b.y - b.x * a.y;
    const double bc = b.x * c.y - c.x * b.y;
    const double cd = c.x * d.y - d.x * c.y;
    const double da = d.x * a.y - a.x * d.y;
    const double ac = a.x * c.y - c.x * a.y;
    const double bd = b.x * d.y - d.x * b.y;
    const double abc = a.z * bc - b.z * ac + c.z * ab;
    const double bcd = b.z * cd - c.z * bd + d.z * bc;
    const double cda = c.z * da + d.z * ac + a.z * cd;
    const double dab = d.z * ab + a.z * bd + b.z * da;
    const double value = (square(a) * bcd - square(b) * cda) + (square(c) * dab - square(d) * abc);
    if (value > sphere_error_) return 1;
    if (value < -sphere_error_) return -1;
    return sphere_error_ == 0 ? 0 : exact_side_of_sphere(a, b, c, d);
  }

  /// True if p lies inside the sphere of side_of_sphere() once ties are broken: as if each point
  /// were lifted above the paraboloid, lexicographically greater ones infinitely farther. Requires
  /// five distinct points.
  bool is_in_perturbed_sphere(const std::array<const Point*, 4>& t, const Point& p) const {
    const int side = side_of_sphere(t, p);
    return side != 0 ? side > 0 : is_in_lifted_sphere(t, p);
  }

 private:
  __extension__ typedef __int128 Wide;            // NOLINT(modernize-use-using)
  __extension__ typedef unsigned __int128 UWide;  // NOLINT(modernize-use-using)

  /// An exact sum of products of a Wide below 2^93 and an integer below 2^62: high 2^64 + low.
  class ProductSum {
   public:
    void add(Wide factor, std::int64_t lift) {
      const UWide product = UWide{static_cast<std::uint64_t>(factor)} * static_cast<UWide>(lift);
      low_ += static_cast<std::uint64_t>(product);
      high_ += (factor >> 64) * lift + static_cast<Wide>(product >> 64);
    }
    int sign() const {
      const Wide high = high_ + static_cast<Wide>(low_ >> 64);
      if (high != 0) return high > 0 ? 1 : -1;
      return static_cast<std::uint64_t>(low_) != 0 ? 1 : 0;
    }

   private:
    Wide high_ = 0;
    UWide low_ = 0;
  };

  struct GridPoint {
    explicit GridPoint(const Point& p)
        : x(static_cast<std::int64_t>(p.x)),
          y(static_cast<std::int64_t>(p.y)),
          z(static_cast<std::int64_t>(p.z)) {}
    std::int64_t square() const { return x * x + y * y + z * z; }
    std::int64_t x, y, z;
  };

  static Point difference(const Point& p, const Point& q) {
    return {p.x - q.x, p.y - q.y, p.z - q.z};
  }
  static double square(const Point& p) { return p.x * p.x + p.y * p.y + p.z * p.z; }

  static int exact_orientation(const Point& first, const Point& second, const Point& third) {
    const GridPoint u(first);
    const GridPoint v(second);
    const GridPoint w(third);
    const Wide value = Wide{w.x} * (u.y * v.z - u.z * v.y) + Wide{w.y} * (u.z * v.x - u.x * v.z) +
                       Wide{w.z} * (u.x * v.y - u.y * v.x);
    return value > 0 ? 1 : value < 0 ? -1 : 0;
  }

  static int exact_side_of_sphere(const Point& p, const Point& q, const Point& r, const Point& s) {
    const GridPoint a(p);
    const GridPoint b(q);
    const GridPoint c(r);
    const GridPoint d(s);
    const std::int64_t ab = a.x * b.y - b.x * a.y;
    const std::int64_t bc = b.x * c.y - c.x * b.y;
    const std::int64_t cd = c.x * d.y - d.x * c.y;
    const std::int64_t da = d.x * a.y - a.x * d.y;
    const std::int64_t ac = a.x * c.y - c.x * a.y;
    const std::int64_t bd = b.x * d.y - d.x * b.y;
    ProductSum sum;
    sum.add(Wide{b.z} * cd - Wide{c.z} * bd + Wide{d.z} * bc, a.square());
    sum.add(-(Wide{c.z} * da + Wide{d.z} * ac + Wide{a.z} * cd), b.square());
    sum.add(Wide{d.z} * ab + Wide{a.z} * bd + Wide{b.z} * da, c.square());
    sum.add(-(Wide{a.z} * bc - Wide{b.z} * ac + Wide{c.z} * ab), d.square());
    return sum.sign();
  }

  /// Decides for five cospherical points by lifting the greatest of them. If that is p, p moves out
  /// of the sphere. Else p moves in if p and the lifted point are on the same side of the other
  /// three points, and out if they are on different sides. If these four are coplanar, the next
  /// greatest point decides.
  bool is_in_lifted_sphere(std::array<const Point*, 4> t, const Point& p) const {
    const Point* above = nullptr;
    for (int round = 0; round < 2; ++round) {
      const Point* greatest = &p;
      std::size_t place = 4;
      for (std::size_t i = 0; i < 4; ++i) {
        if (above != nullptr && !(*t[i] < *above)) continue;
        if (!(*greatest < *t[i])) continue;
        greatest = t[i];
        place = i;
      }
      if (place == 4) return false;
      std::array<const Point*, 4> replaced = t;
      replaced[place] = &p;
      const int sign = orientation(*replaced[0], *replaced[1], *replaced[2], *replaced[3]);
      if (sign != 0) return sign > 0;
      above = greatest;
    }
    WATERTIGHT_ASSERT(false);
    return false;
  }

  double orientation_error_ = 0;
  double sphere_error_ = 0;
};

}  // namespace watertight::delaunay
