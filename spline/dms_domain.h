// SPDX-License-Identifier: GPL-3.0-or-later
//
// A triangulation of a part of the plane with a cloud of knots at each vertex, and the functions
// that it defines (normalized B-splines over triangles). A surface gives each function a
// coefficient.
//
// Based on: R. Pfeifle, H.-P. Seidel, Triangular B-Splines for Blending and Filling of Polygonal
// Holes, 1996, section 2.2. Departure: functions are normalized by the absolute area, as the
// paper's signed one is negative for triangles that turn right; such triangles are refused here.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "spline/plane/triangle_grid.h"
#include "spline/simplex_spline.h"
#include "spline/spline_table.h"

namespace watertight::spline {

/// A domain as plain arrays.
struct DomainArrays {
  int degree = 2;               // 1 to kMostDegree
  std::vector<Point> vertices;  // z is 0
  /// The further knots of each vertex, `degree` for each; the vertex is its knot 0.
  std::vector<Point> clouds;
  std::vector<Triangle> triangles;  // each turns left
};

/// A part of a function's second derivatives: on a triangle of knots they have these values.
struct ConstantPiece {
  Index leaf = 0;  // of DmsDomain::leaf_corners
  double xx = 0;
  double xy = 0;
  double yy = 0;
};

/// A triangle that has a point inside or on its border.
struct PlaceInDomain {
  Index triangle = 0;
  /// By the half-open rule the point is in no triangle: it is on the border of the domain.
  bool is_on_border = false;
};

/// N_ijk of triangle t is function t * functions_per_triangle() + its place; i + j + k is the
/// degree, and places are in the order of descending i, then descending j.
class DmsDomain {
 public:
  /// Checks everything that the functions need: finite numbers, triangles that turn left and meet
  /// in whole edges or vertices only, clouds with which each triangle still turns left, and no
  /// three knots of one function on a line. Errors: malformed, with the place in the message;
  /// limit_exceeded above kMostTriangles. Cost: linear in the pairs of triangles and functions that
  /// are near each other.
  static Result<DmsDomain> make(DomainArrays arrays);

  static constexpr std::size_t kMostTriangles = 200'000;  // some 1 GB

  int degree() const { return arrays_.degree; }
  const DomainArrays& arrays() const { return arrays_; }
  std::size_t functions_per_triangle() const { return ijk_.size(); }
  std::size_t function_count() const { return ijk_.size() * arrays_.triangles.size(); }
  Index triangle_of(Index function) const { return static_cast<Index>(function / ijk_.size()); }

  /// Knot l of a vertex; knot 0 is the vertex.
  const Point& knot(Index vertex, int l) const;

  /// The knots of a function, degree + 3 of them.
  std::vector<Point> knots_of(Index function) const;
  /// What the simplex spline of a function is multiplied by: twice the area of its last knots.
  double scale_of(Index function) const { return scales_[function]; }
  /// The `degree` points at which the blossom of a polynomial is the coefficient of a function.
  std::vector<Point> blossom_arguments(Index function) const;

  /// The triangle in which u lies; nothing outside of the domain.
  std::optional<PlaceInDomain> place_of(const Point& u) const;

  /// The functions that can differ from 0 in a triangle.
  std::span<const Index> functions_at(Index triangle) const;

  /// The corners of a triangle of knots that is a ConstantPiece's; it turns left.
  std::array<Point, 3> leaf_corners(Index leaf) const { return table_[leaf].corners(); }
  /// The second derivatives of a function as a sum over leaves; degree 2 only.
  std::vector<ConstantPiece> second_derivatives(Index function) const;

 private:
  friend class BasisEvaluator;

  explicit DmsDomain(DomainArrays arrays);
  Status check_functions() const;
  void split_functions();
  void list_functions();
  void plan_parts();
  std::vector<Index> splines_of(std::span<const Index> functions) const;
  std::array<int, 3> ijk_of(Index function) const { return ijk_[function % ijk_.size()]; }

  DomainArrays arrays_;
  std::vector<std::array<int, 3>> ijk_;
  std::vector<double> scales_;  // of functions
  std::vector<Index> tops_;     // of functions: their spline in the table
  SplineTable table_;
  TriangleGrid grid_;
  std::vector<std::size_t> starts_;  // of the functions of each triangle, and an end
  std::vector<Index> functions_;
  /// What has to be computed at a point of a part of a triangle (plane/triangle_parts.h).
  struct Plan {
    std::size_t first_function = 0;
    std::size_t first_spline = 0;
  };
  std::vector<Plan> plans_;  // of the parts of each triangle, and an end
  std::vector<Index> planned_functions_;
  std::vector<Index> planned_splines_;  // parts of splines before them
};

}  // namespace watertight::spline
