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

/// The largest magnitude of a grid number's exponent. Finite doubles, their products with lattice
/// coordinates and the sums of such products have far smaller exponents, decimal or binary; only
/// hostile input has larger ones.
inline constexpr std::int32_t kLargestExponent = 1200;

/// The number mantissa * radix^exponent; the functions that take it also take the radix, or state
/// it.
struct WideNumber {
  Wide mantissa = 0;
  std::int32_t exponent = 0;
};

/// 10^exponent for 0 <= exponent <= 38.
UnsignedWide power_of_ten(int exponent);

/// value * radix^count, or nothing if the product does not fit 128 bits.
std::optional<Wide> scaled_up(Wide value, std::int32_t radix, std::int64_t count);

/// a + b in radix 2 or 10, exactly, or nothing if the common form does not fit 128 bits.
std::optional<WideNumber> wide_sum(WideNumber a, WideNumber b, std::int32_t radix);

/// The normalized grid number, or nothing if its mantissa does not fit 64 bits.
std::optional<GridNumber> normalized(WideNumber number, std::int32_t radix);

/// A finite value as mantissa * 2^exponent with an odd mantissa; zero is {0, 0}.
GridNumber binary_number(double value);

/// The world coordinate at which a grid starts on one axis.
struct GridOrigin {
  GridNumber number;
  bool is_rounded = false;  // true if `number` is rounded to 18 digits
};

/// The decimal scale * integer + translate, or the decimal of 18 digits nearest to it if a grid
/// number does not hold all its digits. Nothing if the rounded decimal is half a scale or more from
/// the exact one, so that it could stand for another integer. Requires a positive scale and
/// exponents within kLargestExponent.
std::optional<GridOrigin> grid_origin(const GridNumber& scale, std::int64_t integer,
                                      const GridNumber& translate);

/// mantissa * 10^exponent as the nearest double (ties to even), +-infinity beyond the range.
double nearest_double(const WideNumber& decimal);

/// digits * 10^exponent without exponent, e.g. ("-84616468", -3) gives "-84616.468".
std::string plain_decimal(std::string digits, std::int64_t exponent);

/// The decimal digits of a 128-bit integer, with a minus sign if it is negative.
std::string digits_of(Wide value);

}  // namespace watertight::geometry
