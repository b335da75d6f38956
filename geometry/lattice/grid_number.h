// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exact arithmetic on grid numbers for the files of this folder: 128-bit integers where they
// suffice, integers of any length where they do not. Not for other folders: see lattice.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "geometry/lattice/lattice.h"

namespace watertight::geometry {

__extension__ typedef __int128 Wide;
__extension__ typedef unsigned __int128 UnsignedWide;

/// Decimal and binary exponents of finite doubles, their products with lattice coordinates and
/// sums lie well within; beyond, a grid number is hostile.
inline constexpr std::int32_t kLargestExponent = 1200;

/// An integer times a power of the radix.
struct WideNumber {
  Wide mantissa = 0;
  std::int32_t exponent = 0;
};

/// 10^exponent for 0 <= exponent <= 38.
UnsignedWide power_of_ten(int exponent);

/// value * radix^count, or nothing if it does not fit.
std::optional<Wide> scaled_up(Wide value, std::int32_t radix, std::int64_t count);

/// a + b in radix 2 or 10, exactly, or nothing if the common form does not fit 128 bits.
std::optional<WideNumber> wide_sum(WideNumber a, WideNumber b, std::int32_t radix);

/// The normalized grid number, or nothing if its mantissa does not fit 64 bits.
std::optional<GridNumber> normalized(WideNumber number, std::int32_t radix);

/// Where a grid starts in the world.
struct GridOrigin {
  GridNumber number;
  bool is_rounded = false;  // rounded to 18 digits: the exact number has more
};

/// scale * integer + translate, of decimals; with more digits than a grid number has, the nearest
/// decimal of 18 digits. Nothing where that lies half a scale away or more, so that it could be
/// taken for another integer. Requires a positive scale and exponents within kLargestExponent.
std::optional<GridOrigin> grid_origin(const GridNumber& scale, std::int64_t integer,
                                      const GridNumber& translate);

/// mantissa * 10^exponent as the nearest double (ties to even), +-infinity beyond the range.
double nearest_double(const WideNumber& decimal);

/// digits * 10^exponent without exponent, e.g. ("-84616468", -3) gives "-84616.468".
std::string plain_decimal(std::string digits, std::int64_t exponent);

/// The digits of a 128-bit integer.
std::string digits_of(Wide value);

}  // namespace watertight::geometry
