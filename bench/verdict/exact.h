// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points and vectors with exact rational coordinates (GMP), for the oracle of bench/verdict. They
// use neither the product's predicates nor CGAL.
#pragma once

#include <gmpxx.h>

#include <array>

#include "geometry/point.h"

namespace watertight::verdict {

using Number = mpq_class;
using Vector = std::array<Number, 3>;

inline Vector exact(const Point& p) { return {Number(p.x), Number(p.y), Number(p.z)}; }

inline Vector difference(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Number dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// The point a + (b - a) t.
inline Vector between(const Vector& a, const Vector& b, const Number& t) {
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}
inline bool is_zero(const Vector& v) { return sgn(v[0]) == 0 && sgn(v[1]) == 0 && sgn(v[2]) == 0; }
/// True if p is a point of the closed segment from a to b.
inline bool is_on_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector ap = difference(p, a);
  const Vector bp = difference(p, b);
  return is_zero(cross(ap, bp)) && sgn(dot(ap, bp)) <= 0;
}

}  // namespace watertight::verdict
