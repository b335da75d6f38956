// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decimals of any length, for the files of this folder. Steps and origins of lattices and doubles
// are decimals of finite length: 2^-k = 5^k / 10^k.
#pragma once

#include <gmpxx.h>

#include <cstdint>

#include "geometry/lattice/lattice.h"

namespace watertight::geometry {

using BigInteger = mpz_class;

/// The decimal mantissa * 10^exponent; the mantissa is an integer of any length.
struct BigDecimal {
  BigInteger mantissa = 0;
  std::int64_t exponent = 0;
};

/// The value as an integer of any length. Requires a `long` of 64 bits, as every platform of this
/// program has it.
inline BigInteger big(std::int64_t value) { return BigInteger(static_cast<long>(value)); }

/// base^exponent. Requires an exponent that is not negative.
BigInteger big_power(unsigned base, std::int64_t exponent);

/// mantissa * 2^exponent.
BigDecimal from_binary(std::int64_t mantissa, std::int64_t exponent);

/// A step or origin of a lattice of the given kind, as a decimal.
BigDecimal from_grid(const GridNumber& number, LatticeKind kind);

/// The exact decimal of a double. Requires a finite value.
BigDecimal from_double(double value);

BigDecimal big_product(const BigDecimal& a, const BigDecimal& b);
BigDecimal big_sum(const BigDecimal& a, const BigDecimal& b);

/// The decimal's mantissa at a lower exponent. Requires exponent <= decimal.exponent.
BigInteger big_mantissa_at(const BigDecimal& decimal, std::int64_t exponent);

}  // namespace watertight::geometry
