// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exact signs for points in one box, inlined into the loops of this folder. Private to delaunay/.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/point.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {

/// geometry::orient3d with a filter whose bound is computed once. A term of the determinant passes
/// through at most 8 roundings of u = 2^-53, and the six terms are at most the product of the sides
/// of the box: the value is wrong by less than 9 u times six times this product, and by less than
/// the last term below if products underflow. The bound is larger than the roundings of the bound
/// itself. Signs that the filter does not decide are computed exactly.
class Signs {
 public:
  Signs() = default;
  /// For points in a box, which may be empty.
  explicit Signs(const geometry::Box& box) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;
    constexpr double kUnderflow = 1e-200;
    if (box.is_empty()) return;
    const double x = box.max.x - box.min.x;
    const double y = box.max.y - box.min.y;
    const double z = box.max.z - box.min.z;
    error_ = 6 * 16 * kUnit * (x * y * z) + kUnderflow * (x + y + z) + kUnderflow;
  }

  int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) const {
    const Point u{b.x - a.x, b.y - a.y, b.z - a.z};
    const Point v{c.x - a.x, c.y - a.y, c.z - a.z};
    const Point w{d.x - a.x, d.y - a.y, d.z - a.z};
    const double value = w.x * (u.y * v.z - u.z * v.y) + w.y * (u.z * v.x - u.x * v.z) +
                         w.z * (u.x * v.y - u.y * v.x);
    const int sign = decided(value);
    return sign != 0 ? sign : geometry::orient3d(a, b, c, d);
  }

  /// The sign of orient3d from its rounded value, summed up as above; 0 if that does not decide.
  int decided(double value) const {
    // An overflow makes the bound infinite or the value no number: neither is decided here.
    return (value > error_ ? 1 : 0) - (value < -error_ ? 1 : 0);
  }

 private:
  double error_ = 0;
};

/// How edges turn around one segment. What a sign needs of a vertex is computed once.
class SegmentTurns {
 public:
  /// Keeps a reference to the points.
  SegmentTurns(const std::vector<Point>& points, const Signs& signs)
      : points_(points), signs_(signs) {}

  /// Begins with another segment.
  void begin(Index a, Index b) {
    a_ = a;
    b_ = b;
    if (of_vertex_.size() < points_.size()) of_vertex_.resize(points_.size());
    ++segment_;
  }

  /// The sign of orient3d(a, b, p, q) for vertices p and q that are not ends of the segment.
  int turn(Index p, Index q) {
    const Point& normal = at(p).normal;
    const Point& w = at(q).offset;
    const int sign = signs_.decided(w.x * normal.x + w.y * normal.y + w.z * normal.z);
    if (sign != 0) return sign;
    return geometry::orient3d(points_[a_], points_[b_], points_[p], points_[q]);
  }

 private:
  struct OfVertex {
    Point offset;  // from a
    Point normal;  // of the plane of the segment and the vertex
    std::uint64_t segment = 0;
  };

  const OfVertex& at(Index p) {
    OfVertex& vertex = of_vertex_[p];
    if (vertex.segment != segment_) {
      const Point& a = points_[a_];
      const Point u{points_[b_].x - a.x, points_[b_].y - a.y, points_[b_].z - a.z};
      const Point v{points_[p].x - a.x, points_[p].y - a.y, points_[p].z - a.z};
      vertex = {v, {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x}, segment_};
    }
    return vertex;
  }

  const std::vector<Point>& points_;
  Signs signs_;
  Index a_ = 0;
  Index b_ = 0;
  std::vector<OfVertex> of_vertex_;
  std::uint64_t segment_ = 0;  // the number of segments so far
};

}  // namespace watertight::delaunay
