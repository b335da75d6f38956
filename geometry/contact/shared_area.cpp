// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/contact/shared_area.h"

#include <gmpxx.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "geometry/lattice/rational_lattice.h"
#include "geometry/predicates/rational_point.h"

namespace watertight::geometry {
namespace {

constexpr mp_bitcnt_t kBitsOfSum = 256;

/// A point in the plane of two axes.
using FlatPoint = std::array<mpq_class, 2>;
using FlatPolygon = std::vector<FlatPoint>;

/// A triangle in rational numbers.
struct ExactTriangle {
  std::array<RationalPoint, 3> corners;
  RationalPoint normal;  // twice the area long
};

ExactTriangle exact_triangle(const Surface& surface, Index number) {
  const Solid& solid = *surface.solid;
  ExactTriangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    triangle.corners[i] =
        world_point(solid.lattice(), solid.vertices()[surface.triangles[number][i]]);
  }
  triangle.normal =
      cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
  return triangle;
}

Vector3 normal_of(const WorldTriangle& triangle) {
  return cross(triangle.corners[1] - triangle.corners[0],
               triangle.corners[2] - triangle.corners[0]);
}

/// False if two triangles are certainly not in one plane. With M the largest coordinate and L the
/// largest extent, rounded corners and the determinant of differences are wrong by less than
/// 128 * 2^-53 * M * L^2, when each of its 6 products of 3 factors takes in the errors of its
/// factors and of the arithmetic.
bool may_be_coplanar(const WorldTriangle& a, const WorldTriangle& b) {
  double largest = 0;
  double extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = std::min(a.low[axis], b.low[axis]);
    const double high = std::max(a.high[axis], b.high[axis]);
    largest = std::max({largest, std::abs(low), std::abs(high)});
    extent = std::max(extent, high - low);
  }
  const double error =
      64 * std::numeric_limits<double>::epsilon() * std::max(largest, extent) * extent * extent;
  const Vector3 normal = normal_of(a);
  return std::ranges::all_of(b.corners, [&](const Vector3& corner) {
    return std::abs(dot(corner - a.corners[0], normal)) <= error;
  });
}

/// True if two triangles face each other at a distance that counts.
bool may_face(const WorldTriangle& a, const WorldTriangle& b, double tolerance) {
  if (tolerance == 0) return may_be_coplanar(a, b);
  const Vector3 normal_a = normal_of(a);
  const Vector3 normal_b = normal_of(b);
  const double cosine = std::cos(kMostAngleOfWalls * std::numbers::pi / 180);
  return dot(normal_a, normal_b) < -cosine * length(normal_a) * length(normal_b);
}

/// The axis on which both triangles stand most upright; nothing if a triangle has no area seen
/// along any such axis.
std::optional<std::size_t> common_axis(const ExactTriangle& a, const ExactTriangle& b) {
  std::optional<std::size_t> best;
  double best_share = 0;
  const auto share = [](const RationalPoint& normal, std::size_t axis) {
    const Vector3 rounded{normal[0].get_d(), normal[1].get_d(), normal[2].get_d()};
    return std::abs(rounded[axis]) / length(rounded);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.normal[axis] == 0 || b.normal[axis] == 0) continue;
    const double shares = share(a.normal, axis) + share(b.normal, axis);
    if (best && shares <= best_share) continue;
    best = axis;
    best_share = shares;
  }
  return best;
}

FlatPoint seen_along(const RationalPoint& point, std::size_t axis) {
  return {point[(axis + 1) % 3], point[(axis + 2) % 3]};
}

/// The coordinate along the axis of the plane of a triangle over a place.
mpq_class height_at(const ExactTriangle& plane, std::size_t axis, const FlatPoint& place) {
  const FlatPoint foot = seen_along(plane.corners[0], axis);
  return plane.corners[0][axis] - (plane.normal[(axis + 1) % 3] * (place[0] - foot[0]) +
                                   plane.normal[(axis + 2) % 3] * (place[1] - foot[1])) /
                                      plane.normal[axis];
}

/// The part of a convex polygon where a function, linear over the plane, is 0 or more.
template <class Linear>
FlatPolygon clipped(const FlatPolygon& polygon, const Linear& linear) {
  FlatPolygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const FlatPoint& from = polygon[i];
    const FlatPoint& to = polygon[(i + 1) % polygon.size()];
    const mpq_class at_from = linear(from);
    const mpq_class at_to = linear(to);
    if (at_from >= 0) kept.push_back(from);
    if (sgn(at_from) * sgn(at_to) < 0) {
      const mpq_class share = at_from / (at_from - at_to);
      kept.push_back({mpq_class(from[0] + share * (to[0] - from[0])),
                      mpq_class(from[1] + share * (to[1] - from[1]))});
    }
  }
  return kept;
}

/// Twice the area of a convex polygon.
mpq_class double_area(const FlatPolygon& polygon) {
  mpq_class sum = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum += (polygon[i][0] - polygon[0][0]) * (polygon[i + 1][1] - polygon[0][1]) -
           (polygon[i][1] - polygon[0][1]) * (polygon[i + 1][0] - polygon[0][0]);
  }
  return abs(sum);
}

/// The area of a facet by that which is seen along an axis.
mpf_class stretch(const RationalPoint& normal, std::size_t axis) {
  const mpq_class square = dot(normal, normal) / (normal[axis] * normal[axis]);
  return sqrt(mpf_class(square, kBitsOfSum));
}

/// The common part of two triangles as they are seen along an axis.
FlatPolygon common_part(const ExactTriangle& a, const ExactTriangle& b, std::size_t axis) {
  FlatPolygon part;
  for (const RationalPoint& corner : a.corners) part.push_back(seen_along(corner, axis));
  const int turn = sgn(b.normal[axis]);
  for (std::size_t i = 0; i < 3 && part.size() > 2; ++i) {
    const FlatPoint from = seen_along(b.corners[i], axis);
    const FlatPoint to = seen_along(b.corners[(i + 1) % 3], axis);
    part = clipped(part, [&](const FlatPoint& p) {
      return mpq_class(
          turn * ((to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0])));
    });
  }
  return part;
}

/// The area that two triangles share.
mpf_class area_of_pair(const ExactTriangle& a, const ExactTriangle& b, double tolerance) {
  const mpf_class none(0, kBitsOfSum);
  const std::optional<std::size_t> axis = common_axis(a, b);
  if (!axis || sgn(a.normal[*axis]) == sgn(b.normal[*axis])) return none;
  const auto gap = [&](const FlatPoint& p) {
    return mpq_class(height_at(a, *axis, p) - height_at(b, *axis, p));
  };
  FlatPolygon part;
  if (tolerance == 0) {
    for (const RationalPoint& corner : a.corners) {
      if (gap(seen_along(corner, *axis)) != 0) return none;
    }
  }
  part = common_part(a, b, *axis);
  const mpf_class mean = (stretch(a.normal, *axis) + stretch(b.normal, *axis)) / 2;
  if (tolerance > 0) {
    const mpq_class most = decimal(tolerance) * mpq_class(mean);
    part = clipped(part, [&](const FlatPoint& p) { return mpq_class(most - gap(p)); });
    part = clipped(part, [&](const FlatPoint& p) { return mpq_class(most + gap(p)); });
  }
  if (part.size() < 3) return none;
  return mpf_class(double_area(part), kBitsOfSum) * mean / 2;
}

/// The tolerance, and what roundings can add to a difference of coordinates.
double reach_of(double tolerance, std::span<const WorldTriangle> triangles) {
  double largest = 0;
  for (const WorldTriangle& triangle : triangles) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      largest = std::max({largest, std::abs(triangle.low[axis]), std::abs(triangle.high[axis])});
    }
  }
  return tolerance + 8 * std::numeric_limits<double>::epsilon() * std::max(largest, tolerance);
}

}  // namespace

double shared_area(const Surface& one, const Surface& other, double tolerance,
                   const CancelPoll& is_cancelled) {
  mpf_class sum(0, kBitsOfSum);
  const auto visit = [&](const WorldTriangle& a, const WorldTriangle& b) {
    if (may_face(a, b, tolerance)) {
      sum +=
          area_of_pair(exact_triangle(one, a.number), exact_triangle(other, b.number), tolerance);
    }
    return true;
  };
  std::vector<WorldTriangle> triangles = world_triangles(one);
  const double reach = reach_of(tolerance, triangles);
  visit_near_pairs(std::move(triangles), world_triangles(other), reach, is_cancelled, visit);
  return nearest(mpq_class(sum));
}

}  // namespace watertight::geometry
