// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/smooth/finer_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace watertight::repair {
namespace {

using geometry::LatticePoints;
using geometry::Vector3;

constexpr double kMostSteps = 1073741824.0;  // 2^30: coordinates below it have the smallest code

Error no_lattice() {
  return {ErrorCode::limit_exceeded, "no lattice holds the vertices of the patch exactly"};
}

double radix_of(const Lattice& lattice) { return lattice.kind == LatticeKind::decimal ? 10 : 2; }

/// By how many digits the step of an axis becomes finer.
int refinement(const EditedSolid& solid, int axis, double step_units) {
  if (solid.lattice.kind == LatticeKind::float64) return 0;
  const Box box = geometry::box_of(solid.vertices);
  double steps = std::max(box.max[axis], 1.0);
  double step = solid.lattice.scale(axis);
  const double radix = radix_of(solid.lattice);
  int digits = 0;
  while (step > step_units && steps * radix < kMostSteps) {
    step /= radix;
    steps *= radix;
    ++digits;
  }
  return digits;
}

/// The same grid with finer steps.
struct Refined {
  Lattice lattice;
  std::array<double, 3> factors{1, 1, 1};  // from old coordinates to new ones
  double quantum = 1;                      // of coordinates that are doubles
};

Refined refined(const EditedSolid& solid, const Vector3& units, double step_metres) {
  Refined fine{solid.lattice};
  if (solid.lattice.kind == LatticeKind::float64) {
    const double largest = std::max({units[0], units[1], units[2]});
    fine.quantum = std::ldexp(1.0, std::ilogb(step_metres / largest));
    return fine;
  }
  std::array<int, 3> digits{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    digits[at] = refinement(solid, axis, step_metres / units[at]);
  }
  if (solid.lattice.kind == LatticeKind::binary) digits.fill(*std::ranges::max_element(digits));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    fine.lattice.step[axis].exponent -= digits[axis];
    fine.factors[axis] = std::pow(radix_of(solid.lattice), digits[axis]);
  }
  return fine;
}

Status append_decimals(const Lattice& lattice, std::span<const Point> points,
                       std::vector<std::array<GridNumber, 3>>& decimals) {
  for (const Point& p : points) {
    auto& decimal = decimals.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const auto number = geometry::parse_decimal(lattice.world_text(p[axis], axis));
      if (!number) return no_lattice();
      decimal[static_cast<std::size_t>(axis)] = *number;
    }
  }
  return Done{};
}

}  // namespace

Result<LatticePoints> on_one_lattice(const Lattice& first, std::span<const Point> points,
                                     const Lattice& second, std::span<const Point> others) {
  const bool is_decimal = first.kind == LatticeKind::decimal && second.kind == LatticeKind::decimal;
  Result<LatticePoints> joined = no_lattice();
  if (is_decimal) {
    std::vector<std::array<GridNumber, 3>> decimals;
    Status read = append_decimals(first, points, decimals);
    if (read) read = append_decimals(second, others, decimals);
    if (!read) return std::move(read).error();
    joined = geometry::lattice_of_decimals(decimals);
  } else {
    std::vector<std::array<double, 3>> doubles;
    for (const Point& p : points) doubles.push_back(first.world(p));
    for (const Point& p : others) doubles.push_back(second.world(p));
    joined = geometry::lattice_of_doubles(doubles);
  }
  const bool is_exact = joined && joined->rounded.empty() && !joined->is_origin_rounded;
  return is_exact ? std::move(joined) : no_lattice();
}

Status add_vertices(EditedSolid& solid, const Vector3& units, std::span<const Vector3> places,
                    double step_metres) {
  if (places.empty()) return Done{};
  const Refined fine = refined(solid, units, step_metres);
  std::vector<Point> added;
  for (const Vector3& place : places) {
    Point& p = added.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      const double start = solid.vertices.front()[axis] * fine.factors[at];
      const double way = place[at] / (units[at] * fine.lattice.scale(axis));
      p[axis] = std::round((start + way) / fine.quantum) * fine.quantum + 0.0;
      if (!std::isfinite(p[axis])) return no_lattice();
    }
  }
  auto joined = on_one_lattice(solid.lattice, solid.vertices, fine.lattice, added);
  if (!joined) return std::move(joined).error();
  solid.lattice = joined->lattice;
  solid.vertices = std::move(joined->points);
  return Done{};
}

}  // namespace watertight::repair
