// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/fit_surface.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "spline/dms_surface.h"
#include "spline/energy/positive_system.h"
#include "spline/thin_plate.h"

namespace watertight::spline {

Result<FittedSurface> fit_surface(const DmsDomain& domain, std::span<const FitPoint> points) {
  if (points.empty()) return Error{ErrorCode::malformed, "there are no points to fit"};
  const Point origin = points.front().value;  // small numbers lose less in sums
  const auto unknowns = static_cast<Eigen::Index>(domain.function_count());
  std::vector<Eigen::Triplet<double>> entries;
  Columns right = Columns::Zero(unknowns, 3);
  BasisEvaluator evaluator(domain);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points[p].triangle >= domain.arrays().triangles.size()) {
      return Error{ErrorCode::malformed,
                   "point " + std::to_string(p) + " is in a triangle that is not there"};
    }
    const auto functions = evaluator.in_triangle(points[p].triangle, points[p].u);
    const Point& value = points[p].value;
    for (const BasisValue& row : functions) {
      right.row(row.function) +=
          row.value *
          Eigen::RowVector3d(value.x - origin.x, value.y - origin.y, value.z - origin.z);
      for (const BasisValue& column : functions) {
        entries.emplace_back(static_cast<int>(row.function), static_cast<int>(column.function),
                             row.value * column.value);
      }
    }
  }
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
  for (const FitPoint& point : points) {
    const Point found =
        sum_of(evaluator.in_triangle(point.triangle, point.u), fitted.coefficients).value;
    const double x = found.x - point.value.x;
    const double y = found.y - point.value.y;
    const double z = found.z - point.value.z;
    fitted.largest_distance = std::max(fitted.largest_distance, std::sqrt(x * x + y * y + z * z));
  }
  return fitted;
}

}  // namespace watertight::spline
