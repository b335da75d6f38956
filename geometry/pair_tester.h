// SPDX-License-Identifier: GPL-3.0-or-later
//
// The contact of two triangles, for many pairs of few triangles: their planes are computed once,
// in doubles with an error bound, and decide most pairs. What they leave open is classified
// exactly. Private to geometry/ (it includes CGAL).
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "geometry/contact_classifier.h"
#include "geometry/inline_predicates.h"

namespace watertight {

/// A triangle with its plane: the sign of normal . (x - corner[0]) is that of orient3d(corners, x)
/// where it exceeds error * (largest component of x - corner[0]).
struct PlaneTriangle {
  Triangle vertices;
  std::array<Point, 3> corner;
  Point normal;
  double error = 0;
};

class PairTester {
 public:
  /// Requires triangles in range; degenerate ones are not tested.
  PairTester(std::span<const Point> points, std::span<const Triangle> triangles)
      : points_(points), triangles_(triangles), classifier_(points) {}

  PlaneTriangle plane_triangle(Index triangle) const {
    PlaneTriangle result;
    result.vertices = triangles_[triangle];
    for (std::size_t i = 0; i < 3; ++i) result.corner[i] = points_[result.vertices[i]];
    const Point u = difference(result.corner[1], result.corner[0]);
    const Point v = difference(result.corner[2], result.corner[0]);
    result.normal = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const double size = std::abs(u.y * v.z) + std::abs(u.z * v.y) + std::abs(u.z * v.x) +
                        std::abs(u.x * v.z) + std::abs(u.x * v.y) + std::abs(u.y * v.x);
    result.error = InlinePredicates::kRelativeError * size + 3 * InlinePredicates::kUnderflow;
    return result;
  }

  /// True if a vertex repeats or the corners lie on one line, exactly.
  bool is_degenerate(Index triangle) const {
    const auto [a, b, c] = triangles_[triangle];
    if (a == b || b == c || c == a) return true;
    for (int axis = 2; axis >= 0; --axis) {
      if (InlinePredicates::orient2d(points_[a], points_[b], points_[c], axis) != 0) return false;
    }
    return true;
  }

  /// The contact of a and b; any that is no intersection stands for the others that are none.
  ContactClass contact(const PlaneTriangle& a, const PlaneTriangle& b) const {
    std::size_t common = 0;
    std::size_t in_a = 0;  // a common vertex; with three of them, the sums do not matter
    std::size_t in_b = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (a.vertices[i] != b.vertices[j]) continue;
        ++common;
        in_a += i;
        in_b += j;
      }
    }
    switch (common) {
      case 0:
        return without_common_vertex(a, b);
      case 1:
        return with_common_vertex(a, in_a, b, in_b);
      case 2:
        // The numbers of the corners sum to 3.
        if (side(a, b.corner[3 - in_b]) != 0) return ContactClass::shared_edge;
        return exact(a, b);
      default:
        return ContactClass::duplicate;
    }
  }

 private:
  static Point difference(const Point& p, const Point& q) {
    return {p.x - q.x, p.y - q.y, p.z - q.z};
  }

  ContactClass exact(const PlaneTriangle& a, const PlaneTriangle& b) const {
    return classifier_.classify(a.vertices, b.vertices);
  }

  /// orient3d of a and x if certain, else 0.
  static int side(const PlaneTriangle& a, const Point& x) {
    constexpr double kLargest = 1e300;  // nothing has overflowed
    const Point d = difference(x, a.corner[0]);
    const double value = a.normal.x * d.x + a.normal.y * d.y + a.normal.z * d.z;
    const double largest = std::max(std::max(std::abs(d.x), std::abs(d.y)), std::abs(d.z));
    const double error = a.error * largest + InlinePredicates::kUnderflow;
    if (!(error < kLargest * InlinePredicates::kRelativeError)) return 0;
    return (value > error ? 1 : 0) - (value < -error ? 1 : 0);
  }

  ContactClass without_common_vertex(const PlaneTriangle& a, const PlaneTriangle& b) const {
    if (is_on_one_side(a, b) || is_on_one_side(b, a)) return ContactClass::disjoint;
    return exact(a, b);
  }

  static bool is_on_one_side(const PlaneTriangle& plane, const PlaneTriangle& triangle) {
    const int first = side(plane, triangle.corner[0]);
    return first != 0 && side(plane, triangle.corner[1]) == first &&
           side(plane, triangle.corner[2]) == first;
  }

  /// As ContactClassifier decides it (see there), from certain signs only.
  ContactClass with_common_vertex(const PlaneTriangle& a, std::size_t in_a, const PlaneTriangle& b,
                                  std::size_t in_b) const {
    constexpr std::array<std::size_t, 3> kNext{1, 2, 0};
    const std::size_t next_in_a = kNext[in_a];
    const std::size_t next_in_b = kNext[in_b];
    const int s1 = side(a, b.corner[next_in_b]);
    const int s2 = side(a, b.corner[kNext[next_in_b]]);
    if (s1 * s2 > 0) return ContactClass::shared_vertex;
    const int t1 = side(b, a.corner[next_in_a]);
    const int t2 = side(b, a.corner[kNext[next_in_a]]);
    if (t1 * t2 > 0) return ContactClass::shared_vertex;
    if (s1 * s2 * t1 * t2 == 0) return exact(a, b);
    return (s2 > s1) != (t1 > t2) ? ContactClass::shared_vertex : ContactClass::crossing;
  }

  std::span<const Point> points_;
  std::span<const Triangle> triangles_;
  ContactClassifier<InlinePredicates> classifier_;
};

}  // namespace watertight
