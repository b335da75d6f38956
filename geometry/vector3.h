// SPDX-License-Identifier: GPL-3.0-or-later
//
// Vectors of three numbers, doubles or exact ones. Doubles are rounded after each operation in the
// order written here, so that every machine computes the same.
#pragma once

#include <array>
#include <cmath>

#include "geometry/point.h"

namespace watertight::geometry {

using Vector3 = std::array<double, 3>;

/// p - q.
inline Vector3 difference(const Point& p, const Point& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}

template <class Number>
std::array<Number, 3> operator+(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {Number(a[0] + b[0]), Number(a[1] + b[1]), Number(a[2] + b[2])};
}

template <class Number>
std::array<Number, 3> operator-(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {Number(a[0] - b[0]), Number(a[1] - b[1]), Number(a[2] - b[2])};
}

inline Vector3 operator*(const Vector3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }

template <class Number>
Number dot(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Number>
std::array<Number, 3> cross(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {Number(a[1] * b[2] - a[2] * b[1]), Number(a[2] * b[0] - a[0] * b[2]),
          Number(a[0] * b[1] - a[1] * b[0])};
}

inline double length(const Vector3& a) { return std::sqrt(dot(a, a)); }

}  // namespace watertight::geometry
