// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/lattice/moved_lattice.h"

#include <cmath>
#include <cstdlib>

#include "geometry/lattice/grid_number.h"

namespace watertight::geometry {
namespace {

constexpr std::int64_t kMostMantissa = 1'000'000'000'000'000'000;  // 18 digits

}  // namespace

Result<Lattice> moved_lattice(const Lattice& lattice, const std::array<double, 3>& way) {
  if (lattice.kind == LatticeKind::float64) {
    return Error{ErrorCode::unsupported,
                 "the coordinates have no common grid, so that they would be rounded"};
  }
  const Error too_long{ErrorCode::limit_exceeded, "the coordinates would need more than 18 digits"};
  const std::int32_t radix = lattice.kind == LatticeKind::binary ? 2 : 10;
  Lattice moved = lattice;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(way[axis])) return too_long;
    const GridNumber step = radix == 2 ? binary_number(way[axis]) : shortest_decimal(way[axis]);
    const GridNumber& origin = lattice.origin[axis];
    const auto sum =
        wide_sum({origin.mantissa, origin.exponent}, {step.mantissa, step.exponent}, radix);
    const auto number = sum ? normalized(*sum, radix) : std::nullopt;
    if (!number || std::abs(number->mantissa) >= kMostMantissa) return too_long;
    moved.origin[axis] = *number;
  }
  if (!moved.is_sane()) return too_long;
  return moved;
}

}  // namespace watertight::geometry
