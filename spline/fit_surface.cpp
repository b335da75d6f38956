// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/fit_surface.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "spline/dms_surface.h"
#include "spline/energy/piece_energy.h"
#include "spline/energy/positive_system.h"
#include "spline/thin_plate.h"

namespace watertight::spline {

namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

/// Adds what a point demands of the functions that are not 0 there.
void add_point(std::span<const BasisValue> functions, const Eigen::RowVector3d& value,
               Entries& entries, Columns& right) {
  for (const BasisValue& row : functions) {
    right.row(row.function) += row.value * value;
    for (const BasisValue& column : functions) {
      entries.emplace_back(static_cast<int>(row.function), static_cast<int>(column.function),
                           row.value * column.value);
    }
  }
}

void add_energy(const DmsDomain& domain, double stiffness, Entries& entries) {
  for (Index triangle = 0; triangle < domain.arrays().triangles.size(); ++triangle) {
    const std::span<const Index> functions = domain.functions_at(triangle);
    const std::vector<double> products = energy_products(domain, triangle);
    for (std::size_t i = 0; i < functions.size(); ++i) {
      for (std::size_t j = 0; j < functions.size(); ++j) {
        const double product = products[i * functions.size() + j];
        if (product == 0) continue;
        entries.emplace_back(static_cast<int>(functions[i]), static_cast<int>(functions[j]),
                             stiffness * product);
      }
    }
  }
}

double largest_distance(const DmsDomain& domain, std::span<const FitPoint> points,
                        std::span<const Point> coefficients) {
  BasisEvaluator evaluator(domain);
  double largest = 0;
  for (const FitPoint& point : points) {
    const Point found = sum_of(evaluator.in_triangle(point.triangle, point.u), coefficients).value;
    const double x = found.x - point.value.x;
    const double y = found.y - point.value.y;
    const double z = found.z - point.value.z;
    largest = std::max(largest, std::sqrt(x * x + y * y + z * z));
  }
  return largest;
}

}  // namespace

Result<FittedSurface> fit_surface(const DmsDomain& domain, std::span<const FitPoint> points,
                                  double stiffness) {
  if (points.empty()) return Error{ErrorCode::malformed, "there are no points to fit"};
  if (stiffness != 0 && domain.degree() != 2)
    return Error{ErrorCode::unsupported, "the energy is there for degree 2 only"};
  const Point origin = points.front().value;  // small numbers lose less in sums
  const auto unknowns = static_cast<Eigen::Index>(domain.function_count());
  Entries entries;
  Columns right = Columns::Zero(unknowns, 3);
  BasisEvaluator evaluator(domain);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points[p].triangle >= domain.arrays().triangles.size()) {
      return Error{ErrorCode::malformed,
                   "point " + std::to_string(p) + " is in a triangle that is not there"};
    }
    const Point& value = points[p].value;
    add_point(evaluator.in_triangle(points[p].triangle, points[p].u),
              {value.x - origin.x, value.y - origin.y, value.z - origin.z}, entries, right);
  }
  if (stiffness != 0) add_energy(domain, stiffness, entries);
  Matrix matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const PositiveSystem system(matrix);
  if (!system.is_positive() || !(system.condition() <= kMostCondition)) {
    return Error{ErrorCode::malformed,
                 "the points do not determine the surface: some functions have too few of them"};
  }
  const Columns solution = system.solve(right);
  FittedSurface fitted;
  fitted.condition = system.condition();
  for (Eigen::Index row = 0; row < unknowns; ++row) {
    fitted.coefficients.push_back(
        {origin.x + solution(row, 0), origin.y + solution(row, 1), origin.z + solution(row, 2)});
  }
  fitted.largest_distance = largest_distance(domain, points, fitted.coefficients);
  return fitted;
}

}  // namespace watertight::spline
