// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/planarity.h"

#include <algorithm>
#include <cmath>

namespace watertight::validate {
namespace {

/// The vector times a power of two that brings the largest component near 1, so that no product of
/// components overflows or loses digits that matter. Zero stays zero.
Vector near_one(const Vector& v) {
  const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  if (!(largest > 0) || !std::isfinite(largest)) return v;
  const int exponent = -std::ilogb(largest);
  return {std::ldexp(v[0], exponent), std::ldexp(v[1], exponent), std::ldexp(v[2], exponent)};
}

}  // namespace

Vector direction_of(const Vector& v) {
  const Vector near = near_one(v);
  const double length = std::sqrt(dot(near, near));
  if (!(length > 0)) return {};
  return {near[0] / length, near[1] / length, near[2] / length};
}

Vector unit_normal(const Vector& u, const Vector& v) {
  return direction_of(cross(near_one(u), near_one(v)));
}

}  // namespace watertight::validate
