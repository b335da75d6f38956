// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: H. Edelsbrunner and E. P. Muecke, Simulation of Simplicity, ACM Transactions on
// Graphics 9(1), 1990. Departures: only the point is moved (not the vertices), by an infinitely
// small step along x and one infinitely smaller than that along y.
#include "geometry/predicates/point_in_solid.h"

#include <algorithm>
#include <cmath>

#include "geometry/predicates/rational_point.h"
#include "geometry/vector3.h"

namespace watertight::geometry {
namespace {

using Rational = mpq_class;
using Vector = RationalPoint;

Vector vector_of(const Point& p) { return {Rational(p.x), Rational(p.y), Rational(p.z)}; }

Vector vector_of(const TrianglePoint& point) {
  const mpz_class whole = mpz_class(1) << static_cast<unsigned long>(point.exponent);
  Vector sum{0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector corner = vector_of(point.corners[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum[axis] += corner[axis] * static_cast<unsigned long>(point.weights[i]);
    }
  }
  for (Rational& coordinate : sum) coordinate /= whole;
  return sum;
}

/// The sign of the turn a, b, p in the plane of the axes u and v.
int turn(const Vector& a, const Vector& b, const Vector& p, std::size_t u, std::size_t v) {
  return sgn(Rational((b[u] - a[u]) * (p[v] - a[v]) - (b[v] - a[v]) * (p[u] - a[u])));
}

/// The sign of the turn a, b, p in plan (axes x and y) after p is moved along x and, far less,
/// along y: 0 only if ab is vertical.
int moved_turn(const Vector& a, const Vector& b, const Vector& p) {
  if (const int sign = turn(a, b, p, 0, 1)) return sign;
  const int along_x = cmp(a[1], b[1]);
  return along_x != 0 ? along_x : cmp(b[0], a[0]);
}

/// The sign of det(b - a, c - a, p - a).
int height(const Vector& a, const Vector& b, const Vector& c, const Vector& p) {
  return sgn(dot(p - a, cross(b - a, c - a)));
}

/// True if p is in the closed triangle abc. Requires p in the plane of abc.
bool is_in_triangle(const Vector& a, const Vector& b, const Vector& c, const Vector& p) {
  for (std::size_t u = 0; u < 3; ++u) {
    const std::size_t v = (u + 1) % 3;
    const int whole = turn(a, b, c, u, v);
    if (whole == 0) continue;
    return turn(a, b, p, u, v) * whole >= 0 && turn(b, c, p, u, v) * whole >= 0 &&
           turn(c, a, p, u, v) * whole >= 0;
  }
  return false;
}

/// True if the box of the triangle abc alone shows that the ray from p upward misses it.
bool is_missed(const Point& a, const Point& b, const Point& c, const Vector& p) {
  for (const int axis : {0, 1}) {
    const Rational& at = p[static_cast<std::size_t>(axis)];
    if (at < std::min({a[axis], b[axis], c[axis]}) || at > std::max({a[axis], b[axis], c[axis]})) {
      return true;
    }
  }
  return p[2] > std::max({a.z, b.z, c.z});
}

}  // namespace

std::uint64_t triangle_points(int exponent) {
  return (std::uint64_t{1} << static_cast<unsigned>(exponent / 2)) - 1;
}

TrianglePoint triangle_point(const std::array<Point, 3>& corners, int exponent,
                             std::uint64_t number) {
  // The third weight is positive, because number + number^2 <= 2^exponent - 2^(exponent / 2).
  const std::uint64_t whole = std::uint64_t{1} << static_cast<unsigned>(exponent);
  const std::uint64_t square = number * number;
  return {corners, {number, square, whole - number - square}, exponent};
}

std::optional<Point> exact_doubles(const TrianglePoint& point) {
  const double limit = std::ldexp(1.0, 53 - point.exponent);
  Point result;
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double at = point.corners[i][axis];
      if (!(std::abs(at) < limit) || std::floor(at) != at) return std::nullopt;
      sum += at * static_cast<double>(point.weights[i]);
    }
    result[axis] = std::ldexp(sum, -point.exponent) + 0.0;
  }
  return result;
}

int locate_exactly(const TrianglePoint& point, std::span<const Point> vertices,
                   std::span<const Triangle> triangles) {
  return locate_rational(vector_of(point), vertices, triangles);
}

int locate_rational(const RationalPoint& p, std::span<const Point> vertices,
                    std::span<const Triangle> triangles) {
  bool is_inside = false;
  for (const Triangle& t : triangles) {
    const Point& low = vertices[t[0]];
    if (is_missed(low, vertices[t[1]], vertices[t[2]], p)) continue;
    const Vector a = vector_of(low);
    const Vector b = vector_of(vertices[t[1]]);
    const Vector c = vector_of(vertices[t[2]]);
    const int above = height(a, b, c, p);
    if (above == 0 && is_in_triangle(a, b, c, p)) return 0;
    const int side = moved_turn(a, b, p);
    if (side == 0 || moved_turn(b, c, p) != side || moved_turn(c, a, p) != side) continue;
    // The point is above a triangle that turns left in plan (side > 0) if its height is positive,
    // and above one that turns right if its height is negative. Triangles above the point are
    // counted.
    if (above * side < 0) is_inside = !is_inside;
  }
  return is_inside ? 1 : -1;
}

}  // namespace watertight::geometry
