// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/lattice/common_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>

namespace watertight::geometry {
namespace {

constexpr double kEnd = 9007199254740992.0;  // 2^53

__extension__ typedef __int128 Wide;  // NOLINT(modernize-use-using)

/// The mantissa of a number whose exponent is lowered to `exponent`; nothing if 64 bits overflow.
std::optional<std::int64_t> mantissa_at(const GridNumber& number, std::int32_t exponent,
                                        std::int64_t radix) {
  std::int64_t mantissa = number.mantissa;
  if (mantissa == 0) return 0;
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
  for (std::int64_t i = number.exponent; i > exponent; --i) {
    if (std::abs(mantissa) > kLargest / radix) return std::nullopt;
    mantissa *= radix;
  }
  return mantissa;
}

GridNumber normal_form(std::int64_t mantissa, std::int32_t exponent, std::int64_t radix) {
  if (mantissa == 0) return {};
  while (mantissa % radix == 0) {
    mantissa /= radix;
    ++exponent;
  }
  return {mantissa, exponent};
}

struct CommonAxis {
  GridNumber step;
  GridNumber origin;
};

std::int32_t lowest_exponent(std::span<const Lattice> lattices, std::size_t axis) {
  std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
  for (const Lattice& lattice : lattices) {
    for (const GridNumber& number : {lattice.step[axis], lattice.origin[axis]}) {
      if (number.mantissa != 0) lowest = std::min(lowest, number.exponent);
    }
  }
  return lowest;
}

std::optional<CommonAxis> common_axis(std::span<const Lattice> lattices, std::size_t axis,
                                      std::int64_t radix) {
  const std::int32_t exponent = lowest_exponent(lattices, axis);
  std::int64_t step = 0;
  std::optional<std::int64_t> origin;
  for (const Lattice& lattice : lattices) {
    const auto at = mantissa_at(lattice.origin[axis], exponent, radix);
    if (!at) return std::nullopt;
    origin = std::min(origin.value_or(*at), *at);
  }
  for (const Lattice& lattice : lattices) {
    const auto own = mantissa_at(lattice.step[axis], exponent, radix);
    const auto at = mantissa_at(lattice.origin[axis], exponent, radix);
    if (!own || !at) return std::nullopt;
    const Wide distance = Wide{*at} - *origin;
    if (distance > std::numeric_limits<std::int64_t>::max()) return std::nullopt;
    step = std::gcd(std::gcd(step, *own), static_cast<std::int64_t>(distance));
  }
  return CommonAxis{normal_form(step, exponent, radix), normal_form(*origin, exponent, radix)};
}

}  // namespace

std::optional<CommonLattice> CommonLattice::of(std::span<const Lattice> lattices) {
  if (lattices.empty()) return std::nullopt;
  CommonLattice common;
  common.lattice_ = lattices.front();
  bool are_equal = true;
  for (const Lattice& lattice : lattices) {
    if (lattice.kind != lattices.front().kind) return std::nullopt;
    are_equal = are_equal && lattice == lattices.front();
  }
  if (are_equal) return common;
  const std::int64_t radix = common.lattice_.kind == LatticeKind::decimal ? 10 : 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto grid = common_axis(lattices, axis, radix);
    if (!grid) return std::nullopt;
    common.lattice_.step[axis] = grid->step;
    common.lattice_.origin[axis] = grid->origin;
  }
  if (!common.lattice_.is_sane()) return std::nullopt;
  return common;
}

std::optional<Point> CommonLattice::moved(const Point& p, const Lattice& from) const {
  if (from == lattice_) return p;
  const std::int64_t radix = lattice_.kind == LatticeKind::decimal ? 10 : 2;
  Point result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::array<Lattice, 2> both{from, lattice_};
    const std::int32_t exponent = lowest_exponent(both, axis);
    const auto own_step = mantissa_at(from.step[axis], exponent, radix);
    const auto own_origin = mantissa_at(from.origin[axis], exponent, radix);
    const auto step = mantissa_at(lattice_.step[axis], exponent, radix);
    const auto origin = mantissa_at(lattice_.origin[axis], exponent, radix);
    const double coordinate = p[static_cast<int>(axis)];
    if (!own_step || !own_origin || !step || !origin || !(std::abs(coordinate) < kEnd) ||
        std::floor(coordinate) != coordinate) {
      return std::nullopt;
    }
    const Wide distance =
        Wide{static_cast<std::int64_t>(coordinate)} * *own_step + *own_origin - *origin;
    const Wide moved = distance / *step;
    if (distance % *step != 0 || moved <= -Wide{1} << 53 || moved >= Wide{1} << 53) {
      return std::nullopt;
    }
    result[static_cast<int>(axis)] = static_cast<double>(static_cast<std::int64_t>(moved));
  }
  return result;
}

}  // namespace watertight::geometry
