// SPDX-License-Identifier: GPL-3.0-or-later
//
// Simplex splines: the piecewise polynomials of which surfaces over triangulations are made. These
// functions are the definition, term by term; DmsDomain computes many at once.
//
// Based on: R. Pfeifle, H.-P. Seidel, Triangular B-Splines for Blending and Filling of Polygonal
// Holes, 1996, section 2.1. Departure: a point belongs to a triangle if the point (e, e^2) away
// from it does for all small e > 0. The paper's rule (a wedge along both axes) leaves points of
// edges with positive slope in no triangle.
#pragma once

#include <array>
#include <span>

#include "geometry/point.h"
#include "geometry/predicates/turn.h"

namespace watertight::spline {

using geometry::Index;
using geometry::Point;
using geometry::Triangle;

/// Points of the parameter plane are points with z = 0. Knots are such points.
inline constexpr int kMostDegree = 3;
inline constexpr int kMostKnots = kMostDegree + 3;

/// Twice the signed area of a, b, c, rounded; positive for a left turn.
inline double twice_area(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// On which side of the line from a to b the point u + (e, e^2) lies for all small e > 0: +1 is
/// left, -1 right, 0 only if a equals b. Exact.
inline int shifted_side(const Point& a, const Point& b, const Point& u) {
  if (const int side = geometry::turn(a, b, u)) return side;
  if (a.y != b.y) return a.y > b.y ? 1 : -1;
  return a.x < b.x ? 1 : a.x > b.x ? -1 : 0;
}

/// Whether u lies in the half-open triangle a, b, c, which turns left. Each point of a
/// triangulation's inside lies in exactly one of its triangles. Exact.
inline bool is_in_triangle(const Point& a, const Point& b, const Point& c, const Point& u) {
  return shifted_side(a, b, u) > 0 && shifted_side(b, c, u) > 0 && shifted_side(c, a, u) > 0;
}

/// The same, but points on an edge belong to it as seen from a point: if moving u towards `from`
/// moves it into the triangle. Where that leaves u on the edge, the half-open rule decides.
bool is_in_triangle_from(const Point& a, const Point& b, const Point& c, const Point& u,
                         const Point& from);

/// M(u | knots), degree knots.size() - 3 from 0 to kMostDegree. 0 if all knots lie on one line.
/// Cost: 3^degree triangles.
double simplex_spline(const Point& u, std::span<const Point> knots);

/// Its derivative at u in a direction (a vector, not scaled to length 1). Degree 1 or more.
double simplex_spline_derivative(const Point& u, std::span<const Point> knots,
                                 const Point& direction);

/// Its second derivative in two directions. Degree 2 or more.
double simplex_spline_second_derivative(const Point& u, std::span<const Point> knots,
                                        const Point& first, const Point& second);

/// Three of the knots, by their places: those of the largest area, the first ones among equals. By
/// them a spline is split into splines of one degree less.
struct BaseTriple {
  std::array<int, 3> places{};
  double doubled_area = 0;  // signed; 0 if all knots lie on one line
};
BaseTriple base_triple(std::span<const Point> knots);

/// How fast the three barycentric coordinates of a triple change in x and y: what multiplies the
/// splines of one degree less in a derivative, but for the factor degree.
std::array<Point, 3> barycentric_gradients(const std::array<Point, 3>& corners,
                                           double doubled_area);

}  // namespace watertight::spline
