// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/page/integer_solid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace watertight::codec {
namespace {

__extension__ using Wide = __int128;

constexpr std::int64_t kCoordinateLimit = std::int64_t{1} << 53;
// Mantissas are below 2^63: scaled by at most 2^60, their products and sums stay within 128 bits.
constexpr Wide kScaleLimit = Wide{1} << 60;

/// radix^exponent, or 0 where it would pass kScaleLimit.
Wide power(int radix, std::int32_t exponent) {
  Wide result = 1;
  for (; exponent > 0; --exponent) {
    result *= radix;
    if (result > kScaleLimit) return 0;
  }
  return result;
}

/// The origin and the step of a lattice on one axis, as multiples of one power of the radix.
struct Aligned {
  Wide origin = 0;
  Wide step = 0;  // 0 if the exponents of the two are too far apart
  std::int32_t exponent = 0;
};

Aligned align(const GridNumber& origin, const GridNumber& step, int radix) {
  Aligned aligned;
  aligned.exponent =
      origin.mantissa == 0 ? step.exponent : std::min(origin.exponent, step.exponent);
  const Wide origin_scale =
      origin.mantissa == 0 ? 1 : power(radix, origin.exponent - aligned.exponent);
  const Wide step_scale = power(radix, step.exponent - aligned.exponent);
  if (origin_scale == 0 || step_scale == 0) return aligned;
  aligned.origin = origin.mantissa * origin_scale;
  aligned.step = step.mantissa * step_scale;
  return aligned;
}

/// The number mantissa * radix^exponent with the smallest mantissa; nothing if that mantissa does
/// not fit into 64 bits.
std::optional<GridNumber> normalized(Wide mantissa, std::int32_t exponent, int radix) {
  if (mantissa == 0) return GridNumber{};
  while (mantissa % radix == 0) {
    mantissa /= radix;
    ++exponent;
  }
  if (mantissa > INT64_MAX || mantissa < -INT64_MAX) return std::nullopt;
  return GridNumber{static_cast<std::int64_t>(mantissa), exponent};
}

int radix_of(LatticeKind kind) { return kind == LatticeKind::decimal ? 10 : 2; }

/// Divides a lattice's origin on one axis by its step into whole steps (the origin of `result`) and
/// a rest (the phase of `result`). Returns false if one of the two is out of range.
bool split_origin(const Lattice& lattice, std::size_t axis, GriddedSolid& result) {
  const int radix = radix_of(lattice.kind);
  const Aligned aligned = align(lattice.origin[axis], lattice.step[axis], radix);
  if (aligned.step <= 0) return false;
  Wide steps = aligned.origin / aligned.step;
  Wide rest = aligned.origin % aligned.step;
  if (rest < 0) {
    rest += aligned.step;
    --steps;
  }
  const auto phase = normalized(rest, aligned.exponent, radix);
  if (!phase || steps >= kCoordinateLimit || steps <= -kCoordinateLimit) return false;
  result.grid.phase[axis] = *phase;
  result.origin[axis] = static_cast<std::int64_t>(steps);
  return true;
}

/// Makes a grid point of each point of a lattice by adding the origin of `result`, the grid point
/// of lattice point (0, 0, 0). Returns false if a coordinate is not a whole number, or is 2^53 or
/// more in magnitude.
bool place_vertices(std::span<const Point> points, GriddedSolid& result) {
  result.solid.vertices.clear();
  result.solid.vertices.reserve(points.size());
  for (const Point& point : points) {
    GridPoint grid_point{};
    for (int axis = 0; axis < 3; ++axis) {
      const double value = point[axis];
      if (!(std::abs(value) < static_cast<double>(kCoordinateLimit)) ||
          value != std::trunc(value)) {
        return false;
      }
      const auto a = static_cast<std::size_t>(axis);
      grid_point[a] = static_cast<std::int64_t>(value) + result.origin[a];
      if (grid_point[a] >= kCoordinateLimit || grid_point[a] <= -kCoordinateLimit) return false;
    }
    result.solid.vertices.push_back(grid_point);
  }
  return true;
}

}  // namespace

std::optional<GriddedSolid> grid_solid(const Solid& canonical) {
  const Lattice& lattice = canonical.lattice();
  if (lattice.kind == LatticeKind::float64) return std::nullopt;
  const SolidArrays& arrays = canonical.arrays();
  GriddedSolid result;
  result.grid.kind = lattice.kind;
  result.grid.step = lattice.step;
  bool is_split = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    is_split = is_split && split_origin(lattice, axis, result);
  }
  if (!is_split || !place_vertices(arrays.vertices, result)) {
    // The solid is too many steps away from the grid's phase near 0: the phase becomes the origin
    // of the solid's lattice.
    result.grid.phase = lattice.origin;
    result.origin = {};
    if (!place_vertices(arrays.vertices, result)) return std::nullopt;
  }
  result.solid.ring_vertices = arrays.ring_vertices;
  result.solid.ring_offsets = arrays.ring_offsets;
  result.solid.facet_offsets = arrays.facet_offsets;
  result.solid.shell_offsets = arrays.shell_offsets;
  return result;
}

Result<Lattice> lattice_at(const PageGrid& grid, const GridPoint& origin) {
  Lattice lattice;
  lattice.kind = grid.kind;
  if (grid.kind == LatticeKind::float64) return lattice;
  lattice.step = grid.step;
  const int radix = radix_of(grid.kind);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Aligned aligned = align(grid.phase[axis], grid.step[axis], radix);
    std::optional<GridNumber> number;
    Wide moved = 0;
    if (aligned.step > 0) {
      // A hostile step, scaled, times a hostile origin would leave 128 bits.
      if (!__builtin_mul_overflow(Wide{origin[axis]}, aligned.step, &moved) &&
          !__builtin_add_overflow(moved, aligned.origin, &moved)) {
        number = normalized(moved, aligned.exponent, radix);
      }
    } else if (origin[axis] == 0) {
      number = grid.phase[axis];  // phase and step are so far apart that 128 bits hold no common
                                  // unit
    }
    if (!number) return Error{ErrorCode::malformed, "the origin of the lattice is out of range"};
    lattice.origin[axis] = *number;
  }
  if (!lattice.is_sane()) {
    return Error{ErrorCode::malformed,
                 "the lattice has a step that is not positive or a number out of range"};
  }
  return lattice;
}

Result<Solid> ungrid_solid(const GriddedSolid& gridded, std::uint32_t srid, const Limits& limits) {
  auto lattice = lattice_at(gridded.grid, gridded.origin);
  if (!lattice) return lattice.error();
  SolidArrays arrays;
  arrays.vertices.reserve(gridded.solid.vertices.size());
  for (const GridPoint& grid_point : gridded.solid.vertices) {
    Point point;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const Wide value = Wide{grid_point[a]} - gridded.origin[a];
      if (value >= kCoordinateLimit || value <= -kCoordinateLimit) {
        return Error{ErrorCode::malformed, "a coordinate is out of range"};
      }
      point[axis] = static_cast<double>(static_cast<std::int64_t>(value));
    }
    arrays.vertices.push_back(point);
  }
  arrays.ring_vertices = gridded.solid.ring_vertices;
  arrays.ring_offsets = gridded.solid.ring_offsets;
  arrays.facet_offsets = gridded.solid.facet_offsets;
  arrays.shell_offsets = gridded.solid.shell_offsets;
  return Solid::make(std::move(arrays), *lattice, srid, limits);
}

void PageMemory::add(const IntegerSolid& solid) {
  if (solid.vertices.empty()) return;
  last_position = *std::min_element(solid.vertices.begin(), solid.vertices.end());
  std::vector<std::array<std::int64_t, 2>> added;
  added.reserve(solid.vertices.size());
  for (const GridPoint& vertex : solid.vertices) added.push_back({vertex[0], vertex[1]});
  std::sort(added.begin(), added.end());
  added.erase(std::unique(added.begin(), added.end()), added.end());
  std::erase_if(added, [&](const auto& column) {
    return std::binary_search(columns.begin(), columns.end(), column);
  });
  // Merges from the back: each column moves to its place at once, and those before the first new
  // one stay where they are.
  std::size_t known = columns.size();
  columns.resize(known + added.size());
  for (std::size_t place = columns.size(); !added.empty(); --place) {
    if (known > 0 && columns[known - 1] > added.back()) {
      columns[place - 1] = columns[known - 1];
      --known;
    } else {
      columns[place - 1] = added.back();
      added.pop_back();
    }
  }
}

}  // namespace watertight::codec
