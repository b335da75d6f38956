// SPDX-License-Identifier: GPL-3.0-or-later
//
// Products of second derivatives integrated over a triangle of the domain. Internal to spline/.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "spline/dms_domain.h"

namespace watertight::spline {

/// A convex polygon that turns left: a triangle cut at up to two others.
class ConvexPolygon {
 public:
  ConvexPolygon() = default;
  explicit ConvexPolygon(const std::array<Point, 3>& corners) {
    for (const Point& corner : corners) push_back(corner);
  }

  /// A cut adds one corner at most, but for rounding; corners beyond the room are left out.
  void push_back(const Point& corner) {
    if (size_ < corners_.size()) corners_[size_++] = corner;
  }
  void clear() { size_ = 0; }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const Point& operator[](std::size_t i) const { return corners_[i]; }
  std::span<const Point> corners() const { return std::span(corners_).first(size_); }

 private:
  std::array<Point, 16> corners_;
  std::size_t size_ = 0;
};

/// The part of a polygon in a triangle that turns left; empty or of area 0 where they do not
/// overlap.
ConvexPolygon part_in_triangle(const ConvexPolygon& polygon, const std::array<Point, 3>& corners);

double area_of(std::span<const Point> polygon);

/// The symmetric matrix of integrals of a_xx b_xx + 2 a_xy b_xy + a_yy b_yy over a triangle of the
/// domain, for all functions a and b of domain.functions_at(triangle), row by row.
std::vector<double> energy_products(const DmsDomain& domain, Index triangle);

/// The integral for the surface with coefficients of all functions, over a triangle of the domain.
double triangle_energy(const DmsDomain& domain, Index triangle,
                       std::span<const Point> coefficients);

}  // namespace watertight::spline
