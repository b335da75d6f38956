// SPDX-License-Identifier: GPL-3.0-or-later
//
// The contact of two triangles, for many pairs of few triangles. The plane of each triangle is
// computed once, in doubles with an error bound, and the planes decide most pairs. Where corners
// are small integers, as on a lattice, the planes are exact and also decide neighbours in a planar
// facet. All other pairs are classified exactly. Private to geometry/ (it includes CGAL).
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "geometry/intersection/contact_classifier.h"
#include "geometry/predicates/inline_predicates.h"

namespace watertight::geometry {

/// A triangle with its plane: the sign of normal . (x - corner[0]) is that of orient3d(corners, x)
/// where it exceeds error * (largest component of x - corner[0]).
struct PlaneTriangle {
  Triangle vertices;
  std::array<Point, 3> corner;
  Point normal;
  double error = 0;
  bool is_small = false;  // the corners are integers near the origin: the normal is exact
};

class PairTester {
 public:
  /// Requires triangles in range; degenerate ones are not tested.
  PairTester(std::span<const Point> points, std::span<const Triangle> triangles)
      : points_(points), triangles_(triangles), classifier_(points) {}

  /// A corner of the triangle. Triangles that are compared measure their corners from one origin.
  const Point& origin(Index triangle) const { return points_[triangles_[triangle][0]]; }

  PlaneTriangle plane_triangle(Index triangle, const Point& origin) const {
    PlaneTriangle result;
    result.vertices = triangles_[triangle];
    result.is_small = true;
    for (std::size_t i = 0; i < 3; ++i) {
      result.corner[i] = points_[result.vertices[i]];
      result.is_small = result.is_small && is_near(result.corner[i], origin);
    }
    const Point u = InlinePredicates::difference(result.corner[1], result.corner[0]);
    const Point v = InlinePredicates::difference(result.corner[2], result.corner[0]);
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

  /// The contact of a and b if it is an intersection; else any class that is no intersection.
  ContactClass contact(const PlaneTriangle& a, const PlaneTriangle& b) const {
    std::size_t common = 0;
    // The sums of the indices of the common vertices in a and in b. Not used if all three are
    // common.
    std::size_t in_a = 0;
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
        // The indices of the three corners of a triangle add up to 3, so the index of the corner
        // opposite the common edge is 3 less the sum.
        return with_common_edge(a, 3 - in_a, b, 3 - in_b);
      default:
        return ContactClass::duplicate;
    }
  }

 private:
  ContactClass exact(const PlaneTriangle& a, const PlaneTriangle& b) const {
    return classifier_.classify(a.vertices, b.vertices);
  }

  static constexpr int kUnknown = 2;
  static constexpr std::array<std::size_t, 3> kNext{1, 2, 0};

  static bool is_near(const Point& x, const Point& origin) {
    constexpr double kNear = 524288.0;  // 2^19, so that differences of two corners are below 2^20
    for (int axis = 0; axis < 3; ++axis) {
      if (!InlinePredicates::has_short_difference(x[axis], origin[axis], kNear)) return false;
    }
    return true;
  }

  /// The sign of orient3d of the corners of a and one corner of b, or kUnknown.
  static int side(const PlaneTriangle& a, const PlaneTriangle& b, std::size_t corner) {
    constexpr double kLargest = 1e300;  // a bound of numbers that have not overflowed
    const Point d = InlinePredicates::difference(b.corner[corner], a.corner[0]);
    const double value = a.normal.x * d.x + a.normal.y * d.y + a.normal.z * d.z;
    const double largest = std::max(std::max(std::abs(d.x), std::abs(d.y)), std::abs(d.z));
    const double error = a.error * largest + InlinePredicates::kUnderflow;
    if (std::abs(value) > error && error < kLargest * InlinePredicates::kRelativeError) {
      return InlinePredicates::sign_of(value);
    }
    return a.is_small && b.is_small ? exact_side(a.normal, d) : kUnknown;
  }

  /// The sign of normal . d, in 64-bit integers: components of the normal are below 2^41, those of
  /// d below 2^20.
  static int exact_side(const Point& normal, const Point& d) {
    const auto whole = [](double number) { return static_cast<std::int64_t>(number); };
    return InlinePredicates::sign_of(whole(normal.x) * whole(d.x) + whole(normal.y) * whole(d.y) +
                                     whole(normal.z) * whole(d.z));
  }

  ContactClass without_common_vertex(const PlaneTriangle& a, const PlaneTriangle& b) const {
    if (is_on_one_side(a, b) || is_on_one_side(b, a)) return ContactClass::disjoint;
    return exact(a, b);
  }

  static bool is_on_one_side(const PlaneTriangle& plane, const PlaneTriangle& triangle) {
    const int first = side(plane, triangle, 0);
    return is_beside(first) && side(plane, triangle, 1) == first &&
           side(plane, triangle, 2) == first;
  }

  static bool is_beside(int sign) { return sign == 1 || sign == -1; }

  /// The contact of triangles with one common vertex, by the signs s1, s2, t1 and t2 that
  /// ContactClassifier::with_common_vertex() explains.
  ContactClass with_common_vertex(const PlaneTriangle& a, std::size_t in_a, const PlaneTriangle& b,
                                  std::size_t in_b) const {
    const int s1 = side(a, b, kNext[in_b]);
    const int s2 = side(a, b, kNext[kNext[in_b]]);
    if (is_beside(s1) && s1 == s2) return ContactClass::shared_vertex;
    if (s1 == 0 && s2 == 0) {
      const bool is_apart = is_apart_at(a, in_a, b, in_b) || is_apart_at(b, in_b, a, in_a);
      return is_apart ? ContactClass::shared_vertex : exact(a, b);
    }
    const int t1 = side(b, a, kNext[in_a]);
    const int t2 = side(b, a, kNext[kNext[in_a]]);
    if (is_beside(t1) && t1 == t2) return ContactClass::shared_vertex;
    if (s1 == kUnknown || s2 == kUnknown || t1 == kUnknown || t2 == kUnknown) return exact(a, b);
    return (s2 > s1) != (t1 > t2) ? ContactClass::shared_vertex : exact(a, b);
  }

  ContactClass with_common_edge(const PlaneTriangle& a, std::size_t apex_of_a,
                                const PlaneTriangle& b, std::size_t apex_of_b) const {
    const int s = side(a, b, apex_of_b);
    if (is_beside(s)) return ContactClass::shared_edge;
    if (s == kUnknown) return exact(a, b);
    const Flat flat(a);
    const std::size_t from = kNext[apex_of_a];
    const double turn = flat.turn(a.corner[from], a.corner[kNext[from]], b.corner[apex_of_b]);
    return turn < 0 ? ContactClass::shared_edge : exact(a, b);
  }

  /// The projection of a triangle with an exact normal along the largest component of the normal,
  /// such that the triangle turns left. The products of integers below 2^20 are exact.
  struct Flat {
    explicit Flat(const PlaneTriangle& a) {
      const Point size{std::abs(a.normal.x), std::abs(a.normal.y), std::abs(a.normal.z)};
      const int axis = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;
      first = axis == 2 ? 0 : axis + 1;
      second = axis == 0 ? 2 : axis - 1;
      if (a.normal[axis] < 0) std::swap(first, second);
    }
    /// Positive if c is to the left of the way from a to b.
    double turn(const Point& a, const Point& b, const Point& c) const {
      return (b[first] - a[first]) * (c[second] - a[second]) -
             (b[second] - a[second]) * (c[first] - a[first]);
    }
    /// Negative if b and c, on a line through a, are on different sides of a.
    double along(const Point& a, const Point& b, const Point& c) const {
      return (b[first] - a[first]) * (c[first] - a[first]) +
             (b[second] - a[second]) * (c[second] - a[second]);
    }
    int first;
    int second;
  };

  /// True if the line of an edge of a at the common vertex separates two triangles of one plane, so
  /// that only the common vertex remains.
  static bool is_apart_at(const PlaneTriangle& a, std::size_t in_a, const PlaneTriangle& b,
                          std::size_t in_b) {
    const Flat flat(a);
    const Point& common = a.corner[in_a];
    const Point& next = a.corner[kNext[in_a]];
    const Point& last = a.corner[kNext[kNext[in_a]]];
    bool is_beside_next = true;
    bool is_beside_last = true;
    for (const std::size_t i : {kNext[in_b], kNext[kNext[in_b]]}) {
      const Point& x = b.corner[i];
      const double of_next = flat.turn(common, next, x);
      const double of_last = -flat.turn(common, last, x);
      is_beside_next =
          is_beside_next && (of_next < 0 || (of_next == 0 && flat.along(common, next, x) < 0));
      is_beside_last =
          is_beside_last && (of_last < 0 || (of_last == 0 && flat.along(common, last, x) < 0));
    }
    return is_beside_next || is_beside_last;
  }

  std::span<const Point> points_;
  std::span<const Triangle> triangles_;
  ContactClassifier<InlinePredicates> classifier_;
};

}  // namespace watertight::geometry
