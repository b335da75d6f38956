// SPDX-License-Identifier: GPL-3.0-or-later
//
// Vectors in metres, in doubles, for measurements: they decide nothing but tolerance rules.
// Internal to validate/.
#pragma once

#include <array>

namespace watertight::validate {

using Vector = std::array<double, 3>;

inline double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// The vector's direction, of length 1; zero stays zero. No size of vector underflows or overflows.
Vector direction_of(const Vector& v);

/// The direction of cross(u, v), of length 1, for vectors of any size.
Vector unit_normal(const Vector& u, const Vector& v);

}  // namespace watertight::validate
