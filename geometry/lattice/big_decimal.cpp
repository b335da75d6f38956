// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/lattice/big_decimal.h"

#include <algorithm>
#include <cmath>

namespace watertight::geometry {

BigInteger big_power(unsigned base, std::int64_t exponent) {
  BigInteger power;
  mpz_ui_pow_ui(power.get_mpz_t(), base, static_cast<unsigned long>(exponent));
  return power;
}

BigDecimal from_binary(std::int64_t mantissa, std::int64_t exponent) {
  if (exponent >= 0) return {big(mantissa) << static_cast<unsigned long>(exponent), 0};
  return {big(mantissa) * big_power(5, -exponent), exponent};
}

BigDecimal from_grid(const GridNumber& number, LatticeKind kind) {
  if (kind == LatticeKind::binary) return from_binary(number.mantissa, number.exponent);
  return {big(number.mantissa), number.exponent};
}

BigDecimal from_double(double value) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return from_binary(static_cast<std::int64_t>(std::ldexp(fraction, 53)), exponent - 53);
}

BigDecimal big_product(const BigDecimal& a, const BigDecimal& b) {
  return {a.mantissa * b.mantissa, a.exponent + b.exponent};
}

BigDecimal big_sum(const BigDecimal& a, const BigDecimal& b) {
  if (a.mantissa == 0) return b;
  if (b.mantissa == 0) return a;
  const std::int64_t exponent = std::min(a.exponent, b.exponent);
  return {big_mantissa_at(a, exponent) + big_mantissa_at(b, exponent), exponent};
}

BigInteger big_mantissa_at(const BigDecimal& decimal, std::int64_t exponent) {
  return decimal.mantissa * big_power(10, decimal.exponent - exponent);
}

}  // namespace watertight::geometry
