// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/predicates/exact_quotient.h"

#include <algorithm>
#include <cmath>

namespace watertight::geometry {

double nearest_quotient(mpz_class numerator, const mpz_class& denominator, std::int64_t exponent) {
  if (numerator == 0) return 0.0;
  const bool is_negative = numerator < 0;
  if (is_negative) numerator = -numerator;
  // The numerator or the divisor is shifted so that the quotient has 65 or 66 bits. A double holds
  // the first 53 bits; the other bits and the remainder decide how these are rounded.
  const auto bits = [](const mpz_class& n) {
    return static_cast<std::int64_t>(mpz_sizeinbase(n.get_mpz_t(), 2));
  };
  const std::int64_t shift = 65 + bits(denominator) - bits(numerator);
  mpz_class divisor = denominator;
  if (shift >= 0) {
    numerator <<= static_cast<unsigned long>(shift);
  } else {
    divisor <<= static_cast<unsigned long>(-shift);
  }
  mpz_class quotient;
  mpz_class remainder;
  mpz_tdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), numerator.get_mpz_t(),
              divisor.get_mpz_t());
  const std::int64_t scale = exponent - shift;  // value = quotient * 2^scale
  constexpr std::int64_t kSmallestExponent = -1074;
  const std::int64_t kept = std::max(bits(quotient) - 53, kSmallestExponent - scale);
  bool is_inexact = remainder != 0;
  mpz_class whole = quotient;
  bool is_half = false;
  if (kept > 0) {
    const auto count = static_cast<unsigned long>(kept);
    whole = quotient >> count;
    is_half = mpz_tstbit(quotient.get_mpz_t(), count - 1) != 0;
    is_inexact = is_inexact || mpz_scan1(quotient.get_mpz_t(), 0) < count - 1;
    if (is_half && (is_inexact || mpz_odd_p(whole.get_mpz_t()) != 0)) whole += 1;
  }
  const auto final_exponent =
      std::clamp<std::int64_t>(scale + std::max<std::int64_t>(kept, 0), -10000, 10000);
  const double magnitude = std::ldexp(whole.get_d(), static_cast<int>(final_exponent));
  return is_negative ? -magnitude : magnitude;
}

}  // namespace watertight::geometry
