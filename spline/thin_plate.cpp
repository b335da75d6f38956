// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/thin_plate.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "spline/energy/piece_energy.h"
#include "spline/energy/positive_system.h"

namespace watertight::spline {
namespace {

/// The quadratic form of the energy: A between unknowns, and what old coefficients add to the
/// right-hand side of A x = -B c.
struct System {
  Matrix a;
  Columns right;
  std::size_t old_functions = 0;
};

/// The rows of unknowns among all functions; geometry::kNone for old ones.
std::vector<Index> rows_of(const DmsDomain& domain, std::span<const Index> hole) {
  std::vector<Index> rows(domain.function_count(), geometry::kNone);
  Index next = 0;
  for (const Index triangle : hole) {
    const std::size_t first = triangle * domain.functions_per_triangle();
    for (std::size_t i = 0; i < domain.functions_per_triangle(); ++i) rows[first + i] = next++;
  }
  return rows;
}

System system_of(const DmsDomain& domain, std::span<const Index> hole, std::span<const Index> rows,
                 std::span<const Point> coefficients) {
  const auto unknowns = static_cast<Eigen::Index>(hole.size() * domain.functions_per_triangle());
  System system;
  system.right = Columns::Zero(unknowns, 3);
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<bool> is_reaching(domain.function_count(), false);
  for (const Index triangle : hole) {
    const std::span<const Index> functions = domain.functions_at(triangle);
    const std::vector<double> products = energy_products(domain, triangle);
    for (std::size_t i = 0; i < functions.size(); ++i) {
      const Index row = rows[functions[i]];
      if (row == geometry::kNone) continue;
      for (std::size_t j = 0; j < functions.size(); ++j) {
        const double product = products[i * functions.size() + j];
        if (product == 0) continue;
        if (const Index column = rows[functions[j]]; column != geometry::kNone) {
          entries.emplace_back(static_cast<int>(row), static_cast<int>(column), product);
          continue;
        }
        const Point& old = coefficients[functions[j]];
        system.right.row(row) -= product * Eigen::RowVector3d(old.x, old.y, old.z);
        is_reaching[functions[j]] = true;
      }
    }
  }
  system.a.resize(unknowns, unknowns);
  system.a.setFromTriplets(entries.begin(), entries.end());
  system.old_functions = static_cast<std::size_t>(std::ranges::count(is_reaching, true));
  return system;
}

/// All coefficients less one of them: the energy is that of any moved surface, and small numbers
/// lose less in its sums.
std::vector<Point> moved_by(std::span<const Point> coefficients, const Point& origin) {
  std::vector<Point> moved;
  moved.reserve(coefficients.size());
  for (const Point& c : coefficients)
    moved.push_back({c.x - origin.x, c.y - origin.y, c.z - origin.z});
  return moved;
}

/// The first coefficient that is not an unknown's.
Point origin_of(std::span<const Index> rows, std::span<const Point> coefficients) {
  const auto old = std::ranges::find(rows, geometry::kNone);
  return old == rows.end() ? Point{} : coefficients[static_cast<std::size_t>(old - rows.begin())];
}

}  // namespace

Result<ThinPlate> least_thin_plate(const DmsDomain& domain, std::span<const Index> hole,
                                   std::vector<Point> coefficients) {
  if (domain.degree() != 2)
    return Error{ErrorCode::unsupported, "the energy is there for degree 2 only"};
  if (hole.empty() || hole.back() >= domain.arrays().triangles.size() ||
      std::ranges::adjacent_find(hole, std::ranges::greater_equal()) != hole.end() ||
      coefficients.size() != domain.function_count()) {
    return Error{ErrorCode::malformed,
                 "the triangles of the hole or the coefficients do not fit the domain"};
  }
  const std::vector<Index> rows = rows_of(domain, hole);
  const Point origin = origin_of(rows, coefficients);
  const System system = system_of(domain, hole, rows, moved_by(coefficients, origin));
  if (system.old_functions == 0)
    return Error{ErrorCode::malformed, "no surface reaches into the hole from its border"};
  const PositiveSystem solved(system.a);
  if (!solved.is_positive() || !(solved.condition() <= kMostCondition)) {
    return Error{ErrorCode::malformed,
                 "the border does not hold the surface: the matrix is singular or its condition is "
                 "above 1e12"};
  }
  ThinPlate plate;
  plate.unknowns = static_cast<std::size_t>(system.a.rows());
  plate.old_functions = system.old_functions;
  plate.condition = solved.condition();
  const Columns solution = solved.solve(system.right);
  for (std::size_t function = 0; function < rows.size(); ++function) {
    if (rows[function] == geometry::kNone) continue;
    const auto row = static_cast<Eigen::Index>(rows[function]);
    coefficients[function] = {origin.x + solution(row, 0), origin.y + solution(row, 1),
                              origin.z + solution(row, 2)};
  }
  plate.energy = thin_plate_energy(domain, hole, coefficients);
  plate.coefficients = std::move(coefficients);
  return plate;
}

double thin_plate_energy(const DmsDomain& domain, std::span<const Index> triangles,
                         std::span<const Point> coefficients) {
  double energy = 0;
  for (const Index triangle : triangles) energy += triangle_energy(domain, triangle, coefficients);
  return energy;
}

}  // namespace watertight::spline
