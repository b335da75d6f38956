// SPDX-License-Identifier: GPL-3.0-or-later
//
// Two triangles that do not meet are closest at a corner of one and a point of the other, or at a
// point of an edge of each: the least of these distances is their distance.
#include "validate/overlap/gap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/intersection/triangle_triangle.h"
#include "geometry/vector3.h"

namespace watertight::validate {
namespace {

using geometry::Vector3;
using geometry::operator+;
using geometry::operator-;
using geometry::operator*;
using geometry::cross;
using geometry::dot;
using Corners = std::array<Vector3, 3>;

/// Calls visit(a, b) for the triangles of two surfaces whose boxes, made wider by `margin` on each
/// side, meet, until it returns true. True if it did.
template <class Visit>
bool any_near_pair(const RegionSurface& first, const RegionSurface& second,
                   const std::array<double, 3>& margin, const Visit& visit) {
  const auto widened = [&](Box box) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] -= margin[static_cast<std::size_t>(axis)];
      box.max[axis] += margin[static_cast<std::size_t>(axis)];
    }
    return box;
  };
  for (const Index a : first.triangles_in(widened(second.box()))) {
    Box box;
    for (const Point& corner : first.corners(a)) box.include(corner);
    for (const Index b : second.triangles_in(widened(box))) {
      if (visit(a, b)) return true;
    }
  }
  return false;
}

/// The squared distance of a point and a segment.
double from_segment(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 along = b - a;
  const double size = dot(along, along);
  const double share = size > 0 ? std::clamp(dot(p - a, along) / size, 0.0, 1.0) : 0.0;
  const Vector3 rest = p - (a + along * share);
  return dot(rest, rest);
}

/// The squared distance of a point and a triangle.
double from_triangle(const Vector3& p, const Corners& t) {
  double least = std::min(
      {from_segment(p, t[0], t[1]), from_segment(p, t[1], t[2]), from_segment(p, t[2], t[0])});
  const Vector3 normal = cross(t[1] - t[0], t[2] - t[0]);
  const double size = dot(normal, normal);
  if (size == 0) return least;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 edge = t[(i + 1) % 3] - t[i];
    if (dot(cross(edge, p - t[i]), normal) < 0) return least;
  }
  const double height = dot(p - t[0], normal);
  return std::min(least, height * height / size);
}

/// The squared distance of two segments that do not meet.
double between_segments(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const double ends = std::min(
      {from_segment(a, c, d), from_segment(b, c, d), from_segment(c, a, b), from_segment(d, a, b)});
  const Vector3 u = b - a;
  const Vector3 v = d - c;
  const Vector3 w = a - c;
  const double uu = dot(u, u);
  const double uv = dot(u, v);
  const double vv = dot(v, v);
  const double size = uu * vv - uv * uv;
  if (size <= 0) return ends;
  const double s = (uv * dot(v, w) - vv * dot(u, w)) / size;
  const double t = (uu * dot(v, w) - uv * dot(u, w)) / size;
  if (s < 0 || s > 1 || t < 0 || t > 1) return ends;
  const Vector3 rest = w + u * s - v * t;
  return std::min(ends, dot(rest, rest));
}

double between_triangles(const Corners& s, const Corners& t) {
  double least = from_triangle(s[0], t);
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min({least, from_triangle(s[i], t), from_triangle(t[i], s)});
    for (std::size_t k = 0; k < 3; ++k) {
      least = std::min(least, between_segments(s[i], s[(i + 1) % 3], t[k], t[(k + 1) % 3]));
    }
  }
  return least;
}

bool do_meet(const RegionSurface& first, const RegionSurface& second, Index a, Index b) {
  const std::array<Point, 3> s = first.corners(a);
  const std::array<Point, 3> t = second.corners(b);
  const std::array<Point, 6> points{s[0], s[1], s[2], t[0], t[1], t[2]};
  return geometry::classify_contact(points, {0, 1, 2}, {3, 4, 5}) !=
         geometry::ContactClass::disjoint;
}

}  // namespace

bool do_touch(const RegionSurface& first, const RegionSurface& second) {
  return any_near_pair(first, second, {},
                       [&](Index a, Index b) { return do_meet(first, second, a, b); });
}

bool is_gap_at_most(const RegionSurface& first, const RegionSurface& second,
                    const StepMetres& step_metres, double metres) {
  std::array<double, 3> margin{};
  for (std::size_t axis = 0; axis < 3; ++axis) margin[axis] = metres / step_metres[axis][axis];
  const Point origin = first.box().min;
  const auto in_metres = [&](const std::array<Point, 3>& corners) {
    Corners result{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto row = static_cast<std::size_t>(axis);
        result[i][row] = (corners[i][axis] - origin[axis]) * step_metres[row][row];
      }
    }
    return result;
  };
  return any_near_pair(first, second, margin, [&](Index a, Index b) {
    return between_triangles(in_metres(first.corners(a)), in_metres(second.corners(b))) <=
               metres * metres ||
           do_meet(first, second, a, b);
  });
}

}  // namespace watertight::validate
