// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surfaces over a triangulation (DMS splines): a coefficient in space for each function of a
// domain.
//
// Based on: R. Pfeifle, H.-P. Seidel, Triangular B-Splines for Blending and Filling of Polygonal
// Holes, 1996, section 2.2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "spline/dms_domain.h"

namespace watertight::spline {

/// The values of functions of a domain at a point, with derivatives where asked for.
struct BasisValue {
  Index function = 0;
  double value = 0;
  std::array<double, 2> first{};   // x, y
  std::array<double, 3> second{};  // xx, xy, yy
};

/// Computes the functions of a domain at one point after another; keeps its room. The domain must
/// outlive it. One thread uses it at a time.
class BasisEvaluator {
 public:
  explicit BasisEvaluator(const DmsDomain& domain);

  /// The functions that are not 0 at u, with their derivatives up to an order (0 to 2); nothing
  /// outside of the domain. Where a derivative jumps, it is the limit from one side: that of the
  /// half-open rule, and on the border of the domain from within. Valid until the next call.
  std::optional<std::span<const BasisValue>> at(const Point& u, int order = 0);

  /// The same as the limit from within a triangle that has u inside or on its border.
  std::span<const BasisValue> in_triangle(Index triangle, const Point& u, int order = 0);

 private:
  /// `is_in` says whether the point counts as in a triangle of knots.
  template <class IsIn>
  std::span<const BasisValue> compute(Index triangle, const Point& u, int order, const IsIn& is_in);
  template <class IsIn>
  void compute_splines(std::span<const Index> splines, const Point& u, const IsIn& is_in);
  void add_derivatives(Index function, int order, BasisValue& value) const;
  double value_of(Index spline) const {
    return splines_[spline].point == point_ ? splines_[spline].value
                                            : 0;  // else it is beyond its knots
  }

  const DmsDomain& domain_;
  struct Known {
    std::uint64_t point = 0;  // the number of the point for which the value is known
    double value = 0;
  };
  std::vector<Known> splines_;
  std::uint64_t point_ = 0;
  std::vector<BasisValue> found_;
};

/// Value, first and second derivatives of a surface at a point.
struct SurfacePoint {
  Point value;
  std::array<Point, 2> first{};   // by x, y
  std::array<Point, 3> second{};  // by xx, xy, yy
};

/// The Gaussian curvature at a point with its derivatives, one over the square of the unit of
/// values; infinite or no number where the first derivatives are on one line.
double gaussian_curvature(const SurfacePoint& at);

class DmsSurface {
 public:
  /// Error malformed if there is not one finite coefficient for each function. The domain must
  /// outlive the surface.
  static Result<DmsSurface> make(const DmsDomain& domain, std::vector<Point> coefficients);

  const DmsDomain& domain() const { return *domain_; }
  std::span<const Point> coefficients() const { return coefficients_; }

  /// The place in space of u; nothing outside of the domain.
  std::optional<Point> value(const Point& u) const;
  /// The derivative in a direction of the parameter plane.
  std::optional<Point> derivative(const Point& u, const Point& direction) const;
  std::optional<Point> second_derivative(const Point& u, const Point& first,
                                         const Point& second) const;

  /// Many points at once, with derivatives up to an order (0 to 2). Nothing outside of the domain.
  std::vector<std::optional<SurfacePoint>> values(std::span<const Point> us, int order = 0) const;

 private:
  DmsSurface(const DmsDomain& domain, std::vector<Point> coefficients)
      : domain_(&domain), coefficients_(std::move(coefficients)) {}

  const DmsDomain* domain_;
  std::vector<Point> coefficients_;
};

/// The sum of functions times their coefficients.
SurfacePoint sum_of(std::span<const BasisValue> functions, std::span<const Point> coefficients);

}  // namespace watertight::spline
