// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/contact/distance.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "geometry/lattice/rational_lattice.h"
#include "geometry/mass/mass.h"
#include "geometry/predicates/rational_point.h"

namespace watertight::geometry {
namespace {

/// Distances in doubles are those of points that are really in the triangles, so they are never too
/// small; where two edges are nearly parallel they can be too large, by less than this share of the
/// extent of the two triangles. Pairs within it are compared in rational numbers.
constexpr double kShareOfExtent = 1e-6;

template <class Number>
using Corners = std::array<std::array<Number, 3>, 3>;

template <class Number>
Number square_distance(const std::array<Number, 3>& p, const std::array<Number, 3>& q) {
  const std::array<Number, 3> way = p - q;
  return dot(way, way);
}

template <class Number>
std::array<Number, 3> along(const std::array<Number, 3>& from, const std::array<Number, 3>& way,
                            const Number& share) {
  return {Number(from[0] + share * way[0]), Number(from[1] + share * way[1]),
          Number(from[2] + share * way[2])};
}

template <class Number>
Number clamped(const Number& value) {
  if (value < 0) return Number(0);
  return value > 1 ? Number(1) : value;
}

/// The square of the distance of a point from the segment of two others.
template <class Number>
Number to_segment(const std::array<Number, 3>& point, const std::array<Number, 3>& from,
                  const std::array<Number, 3>& to) {
  const std::array<Number, 3> way = to - from;
  const Number square = dot(way, way);
  if (square == 0) return square_distance(point, from);
  const Number share = clamped(Number(dot(point - from, way) / square));
  return square_distance(point, along(from, way, share));
}

/// The square of the distance of a point from a triangle.
template <class Number>
Number to_triangle(const std::array<Number, 3>& point, const Corners<Number>& corners) {
  Number least = to_segment(point, corners[2], corners[0]);
  bool is_over = true;
  const std::array<Number, 3> normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<Number, 3>& from = corners[i];
    const std::array<Number, 3>& to = corners[(i + 1) % 3];
    if (i < 2) least = std::min(least, to_segment(point, from, to));
    is_over = is_over && dot(cross(to - from, point - from), normal) >= 0;
  }
  const Number square = dot(normal, normal);
  if (!is_over || square == 0) return least;
  const Number height = dot(point - corners[0], normal);
  return std::min(least, Number(height * height / square));
}

/// The square of the distance of two segments if neither end of them is nearest; else at least
/// that.
template <class Number>
std::optional<Number> between_segments(const std::array<Number, 3>& p,
                                       const std::array<Number, 3>& p_to,
                                       const std::array<Number, 3>& q,
                                       const std::array<Number, 3>& q_to) {
  const std::array<Number, 3> u = p_to - p;
  const std::array<Number, 3> v = q_to - q;
  const std::array<Number, 3> w = p - q;
  const Number uu = dot(u, u);
  const Number uv = dot(u, v);
  const Number vv = dot(v, v);
  const Number uw = dot(u, w);
  const Number vw = dot(v, w);
  const Number determinant = uu * vv - uv * uv;
  if (determinant <= 0) return std::nullopt;
  const Number at_u = clamped(Number((uv * vw - vv * uw) / determinant));
  const Number at_v = clamped(Number((uv * at_u + vw) / vv));
  return square_distance(along(p, u, at_u), along(q, v, at_v));
}

/// The square of the distance of two triangles that do not cross.
template <class Number>
Number between_triangles(const Corners<Number>& a, const Corners<Number>& b) {
  Number least = to_triangle(a[0], b);
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0) least = std::min(least, to_triangle(a[i], b));
    least = std::min(least, to_triangle(b[i], a));
    for (std::size_t j = 0; j < 3; ++j) {
      const auto square = between_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
      if (square) least = std::min(least, *square);
    }
  }
  return least;
}

int side_of(const Corners<mpq_class>& plane, const RationalPoint& point) {
  return sgn(dot(cross(plane[1] - plane[0], plane[2] - plane[0]), RationalPoint(point - plane[0])));
}

/// The sign of the volume of a tetrahedron.
int turn_around(const RationalPoint& from, const RationalPoint& to, const RationalPoint& a,
                const RationalPoint& b) {
  return sgn(dot(cross(to - from, a - from), RationalPoint(b - from)));
}

/// True if a segment crosses the plane of a triangle at one point, which is in the triangle. False
/// for a segment in the plane: it meets the triangle if an end or an edge does.
bool crosses(const RationalPoint& from, const RationalPoint& to,
             const Corners<mpq_class>& triangle) {
  const int side_from = side_of(triangle, from);
  const int side_to = side_of(triangle, to);
  if (side_from * side_to > 0 || (side_from == 0 && side_to == 0)) return false;
  bool is_left = false;
  bool is_right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const int turn = turn_around(from, to, triangle[i], triangle[(i + 1) % 3]);
    is_left = is_left || turn > 0;
    is_right = is_right || turn < 0;
  }
  return !(is_left && is_right);
}

bool do_cross(const Corners<mpq_class>& a, const Corners<mpq_class>& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (crosses(a[i], a[(i + 1) % 3], b) || crosses(b[i], b[(i + 1) % 3], a)) return true;
  }
  return false;
}

Corners<mpq_class> exact_corners(const Surface& surface, Index number) {
  Corners<mpq_class> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = world_point(surface.solid->lattice(),
                             surface.solid->vertices()[surface.triangles[number][i]]);
  }
  return corners;
}

/// The square of the distance of two triangles.
mpq_class exact_square(const Corners<mpq_class>& a, const Corners<mpq_class>& b) {
  return do_cross(a, b) ? mpq_class(0) : between_triangles(a, b);
}

/// What the numbers of a pair of triangles are like: the extent of both, and the largest
/// coordinate.
struct Size {
  double extent = 0;
  double largest = 0;
};

Size size_of(const WorldTriangle& a, const WorldTriangle& b) {
  Size size;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = std::min(a.low[axis], b.low[axis]);
    const double high = std::max(a.high[axis], b.high[axis]);
    size.extent = std::max(size.extent, high - low);
    size.largest = std::max({size.largest, std::abs(low), std::abs(high)});
  }
  return size;
}

/// What a distance in doubles can be wrong by: rounded corners, and edges that are nearly parallel.
double error_of(const Size& size) {
  return kShareOfExtent * size.extent + 64 * std::numeric_limits<double>::epsilon() * size.largest;
}

/// True if the corners of a triangle are certainly on one side of the plane of another. The error
/// is that of shared_area.cpp: 128 * 2^-53 * M * L^2.
bool is_on_one_side(const WorldTriangle& plane, const WorldTriangle& other, const Size& size) {
  const double error = 64 * std::numeric_limits<double>::epsilon() *
                       std::max(size.largest, size.extent) * size.extent * size.extent;
  const Vector3 normal =
      cross(plane.corners[1] - plane.corners[0], plane.corners[2] - plane.corners[0]);
  bool is_above = true;
  bool is_below = true;
  for (const Vector3& corner : other.corners) {
    const double height = dot(corner - plane.corners[0], normal);
    is_above = is_above && height > error;
    is_below = is_below && height < -error;
  }
  return is_above || is_below;
}

/// Numbers between which the distance of two triangles is.
struct DistanceRange {
  double least = 0;
  double most = 0;
};

DistanceRange distance_range(const WorldTriangle& a, const WorldTriangle& b) {
  const Size size = size_of(a, b);
  const double error = error_of(size);
  const double rounded = std::sqrt(between_triangles(a.corners, b.corners));
  const bool is_apart = is_on_one_side(a, b, size) || is_on_one_side(b, a, size);
  return {is_apart ? rounded - error : 0, rounded + error};
}

/// The least of many distances: first bounded in doubles, then found among those that may be it.
class LeastDistance {
 public:
  /// An upper bound of the least distance.
  const double& bound() const { return bound_; }
  bool is_zero() const { return square_ && *square_ == 0; }

  void bound_by(double distance) { bound_ = std::min(bound_, distance); }

  void take(const mpq_class& square) {
    if (square_ && *square_ <= square) return;
    square_ = square;
    bound_by(std::sqrt(square.get_d()) * (1 + 4 * std::numeric_limits<double>::epsilon()));
  }

  double rounded() const { return square_ ? std::sqrt(nearest(*square_)) : 0; }

 private:
  std::optional<mpq_class> square_;
  double bound_ = std::numeric_limits<double>::infinity();
};

RationalPoint exact_place(const Surface& surface, const Place& place) {
  const Lattice& lattice = surface.solid->lattice();
  return {world_coordinate(lattice, place[0]), world_coordinate(lattice, place[1]),
          world_coordinate(lattice, place[2])};
}

/// True if a vertex of a solid, all of which are on one side, is in another one. Requires
/// boundaries that do not meet.
bool is_inside(const Surface& inner, const Surface& outer) {
  const Point& vertex = inner.solid->vertices()[inner.triangles[0][0]];
  RationalPoint point = world_point(inner.solid->lattice(), vertex);
  const Lattice& lattice = outer.solid->lattice();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[axis] = (point[axis] - origin_of(lattice, axis)) / step_of(lattice, axis);
  }
  return locate_rational(point, outer.solid->vertices(), outer.triangles) >= 0;
}

}  // namespace

double distance(const Surface& one, const Surface& other, const CancelPoll& is_cancelled) {
  const std::vector<WorldTriangle> triangles = world_triangles(one);
  const std::vector<WorldTriangle> others = world_triangles(other);
  LeastDistance least;
  least.bound_by(distance_range(triangles[0], others[0]).most);
  visit_near_pairs(triangles, others, least.bound(), is_cancelled,
                   [&](const WorldTriangle& a, const WorldTriangle& b) {
                     least.bound_by(distance_range(a, b).most);
                     return true;
                   });
  visit_near_pairs(
      triangles, others, least.bound(), is_cancelled,
      [&](const WorldTriangle& a, const WorldTriangle& b) {
        if (distance_range(a, b).least > least.bound()) return true;
        least.take(exact_square(exact_corners(one, a.number), exact_corners(other, b.number)));
        return !least.is_zero();
      });
  if (!least.is_zero() && (is_inside(one, other) || is_inside(other, one))) return 0;
  return least.rounded();
}

double distance(const Surface& surface, const Place& place) {
  if (locate(*surface.solid, surface.triangles, place) >= 0) return 0;
  const WorldTriangle point{{place, place, place}, place, place, 0};
  const RationalPoint exact = exact_place(surface, place);
  const std::vector<WorldTriangle> triangles = world_triangles(surface);
  LeastDistance least;
  const auto rounded = [&](const WorldTriangle& triangle) {
    return std::sqrt(to_triangle(place, triangle.corners));
  };
  const auto error = [&](const WorldTriangle& triangle) {
    return error_of(size_of(triangle, point));
  };
  for (const WorldTriangle& triangle : triangles) {
    least.bound_by(rounded(triangle) + error(triangle));
  }
  for (const WorldTriangle& triangle : triangles) {
    if (rounded(triangle) - error(triangle) > least.bound()) continue;
    least.take(to_triangle(exact, exact_corners(surface, triangle.number)));
  }
  return least.rounded();
}

bool meets_segment(const Surface& surface, const Place& from, const Place& to) {
  if (locate(*surface.solid, surface.triangles, from) >= 0) return true;
  if (locate(*surface.solid, surface.triangles, to) >= 0) return true;
  const RationalPoint exact_from = exact_place(surface, from);
  const RationalPoint exact_to = exact_place(surface, to);
  WorldTriangle segment{{from, from, to}, from, from, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::tie(segment.low[axis], segment.high[axis]) = std::minmax(from[axis], to[axis]);
  }
  const std::vector<WorldTriangle> triangles = world_triangles(surface);
  return std::ranges::any_of(triangles, [&](const WorldTriangle& triangle) {
    return are_near(triangle, segment, 0) &&
           crosses(exact_from, exact_to, exact_corners(surface, triangle.number));
  });
}

}  // namespace watertight::geometry
