// SPDX-License-Identifier: GPL-3.0-or-later
//
// Quotients of integers of any length, rounded once to a double. Private to geometry/.
#pragma once

#include <gmpxx.h>

#include <cstdint>

namespace watertight::geometry {

/// The double nearest to numerator / denominator * 2^exponent (ties to even), infinity beyond the
/// range of doubles. Requires denominator > 0 and |exponent| below 2^40.
double nearest_quotient(mpz_class numerator, const mpz_class& denominator, std::int64_t exponent);

}  // namespace watertight::geometry
