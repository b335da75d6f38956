// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/blocks/block_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace watertight::pipeline {
namespace {

constexpr int kDoubleBits = 53;
constexpr double kEnd = 9007199254740992.0;  // 2^53

/// The exponent of the largest power of two of which a double is a multiple. Requires a finite
/// value that is not 0.
int exponent_of(double value) {
  int exponent = 0;
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), kDoubleBits));
  exponent -= kDoubleBits;
  for (; mantissa % 2 == 0; mantissa /= 2) ++exponent;
  return exponent;
}

/// A double as a number of a binary lattice.
GridNumber binary_number(double value) {
  if (value == 0) return {};
  const int exponent = exponent_of(value);
  return {static_cast<std::int64_t>(std::ldexp(value, -exponent)), exponent};
}

/// The grid of the nearest doubles.
std::optional<Lattice> grid_of_doubles(std::span<const Solid* const> solids) {
  Lattice grid;
  grid.kind = LatticeKind::binary;
  for (int axis = 0; axis < 3; ++axis) {
    int exponent = std::numeric_limits<int>::max();
    double least = std::numeric_limits<double>::infinity();
    for (const Solid* solid : solids) {
      for (const Point& point : solid->vertices()) {
        const double value = solid->lattice().world(point[axis], axis);
        if (!std::isfinite(value)) return std::nullopt;
        least = std::min(least, value);
        if (value != 0) exponent = std::min(exponent, exponent_of(value));
      }
    }
    if (!std::isfinite(least)) return std::nullopt;
    const auto a = static_cast<std::size_t>(axis);
    grid.step[a] = {1, exponent == std::numeric_limits<int>::max() ? 0 : exponent};
    grid.origin[a] = binary_number(least);
  }
  return grid.is_sane() ? std::optional(grid) : std::nullopt;
}

/// The logarithms of the steps, which say how many bits a place takes.
double coarseness(const Lattice& lattice) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += std::log2(lattice.scale(axis));
  return sum;
}

std::optional<GridNumber> decimal_of(const Lattice& lattice, double coordinate, int axis) {
  if (lattice.kind == LatticeKind::decimal) {
    const auto exact = geometry::parse_decimal(lattice.world_text(coordinate, axis));
    return exact ? std::optional(*exact) : std::nullopt;
  }
  const double value = lattice.world(coordinate, axis);
  return std::isfinite(value) ? std::optional(geometry::shortest_decimal(value)) : std::nullopt;
}

std::optional<Solid> with_vertices(const Solid& solid, std::vector<Point> vertices,
                                   const Lattice& lattice) {
  SolidArrays arrays = solid.arrays();
  arrays.vertices = std::move(vertices);
  auto made = Solid::make(std::move(arrays), lattice, solid.srid());
  return made ? std::optional(*std::move(made)) : std::nullopt;
}

}  // namespace

std::optional<BlockGrid> BlockGrid::of(std::span<const Solid* const> solids) {
  std::vector<Lattice> lattices;
  for (const Solid* solid : solids) lattices.push_back(solid->lattice());
  BlockGrid grid;
  grid.common_ = geometry::CommonLattice::of(lattices);
  const auto doubles = grid_of_doubles(solids);
  if (!grid.common_ && !doubles) return std::nullopt;
  if (doubles && (!grid.common_ || coarseness(*doubles) > coarseness(grid.common_->lattice()))) {
    grid.common_.reset();
    grid.lattice_ = *doubles;
  }
  return grid;
}

std::optional<Solid> BlockGrid::moved(const Solid& solid) const {
  std::vector<Point> vertices;
  vertices.reserve(solid.vertex_count());
  for (const Point& point : solid.vertices()) {
    if (common_) {
      const auto moved = common_->moved(point, solid.lattice());
      if (!moved) return std::nullopt;
      vertices.push_back(*moved);
      continue;
    }
    Point moved;
    for (int axis = 0; axis < 3; ++axis) {
      const double offset = solid.lattice().world(point[axis], axis) - lattice_.world(0, axis);
      moved[axis] = std::ldexp(offset, -lattice_.step[static_cast<std::size_t>(axis)].exponent);
      if (!(std::abs(moved[axis]) < kEnd)) return std::nullopt;
    }
    vertices.push_back(moved);
  }
  return with_vertices(solid, std::move(vertices), common_ ? common_->lattice() : lattice_);
}

std::optional<std::vector<Solid>> on_lattice_of_decimals(std::span<const Solid* const> solids) {
  std::vector<std::array<GridNumber, 3>> places;
  for (const Solid* solid : solids) {
    for (const Point& point : solid->vertices()) {
      std::array<GridNumber, 3>& place = places.emplace_back();
      for (int axis = 0; axis < 3; ++axis) {
        const auto decimal = decimal_of(solid->lattice(), point[axis], axis);
        if (!decimal) return std::nullopt;
        place[static_cast<std::size_t>(axis)] = *decimal;
      }
    }
  }
  const auto points = geometry::lattice_of_decimals(places);
  if (!points || !points->rounded.empty() || points->is_origin_rounded) return std::nullopt;
  std::vector<Solid> placed;
  auto next = points->points.begin();
  for (const Solid* solid : solids) {
    const auto end = next + static_cast<std::ptrdiff_t>(solid->vertex_count());
    auto made = with_vertices(*solid, std::vector<Point>(next, end), points->lattice);
    if (!made) return std::nullopt;
    placed.push_back(*std::move(made));
    next = end;
  }
  return placed;
}

}  // namespace watertight::pipeline
