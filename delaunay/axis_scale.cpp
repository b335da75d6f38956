// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/axis_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/crs/crs.h"

namespace watertight::delaunay {
namespace {

/// A degree counts as 2^17 metres, as for the projection of facets (tessellate/facets.h).
constexpr int kDegreeExponent = 17;

/// The exponent of the nearest power of two; above the middle of two by their product, the upper.
int nearest_exponent(double x) {
  int exponent = 0;
  return std::frexp(x, &exponent) < std::numbers::sqrt2 / 2 ? exponent - 1 : exponent;
}

/// True if the horizontal axes of a solid are angles.
bool is_in_angles(const Solid& solid) {
  const double largest = geometry::largest_angle(solid.srid());
  if (largest == 0) return false;
  const geometry::Box box = solid.box();
  for (const Point& corner : {box.min, box.max}) {
    const auto place = solid.lattice().world(corner);
    if (std::abs(place[0]) > largest || std::abs(place[1]) > largest) return false;
  }
  return true;
}

}  // namespace

AxisScale equal_units(const Solid& solid) {
  const bool has_angles = is_in_angles(solid);
  std::array<int, 3> exponents{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = solid.lattice().scale(static_cast<int>(axis));
    if (!(step > 0) || !std::isfinite(step)) return {1, 1, 1};
    exponents[axis] = nearest_exponent(step) + (has_angles && axis < 2 ? kDegreeExponent : 0);
  }
  AxisScale scale{1, 1, 1};
  const int least = *std::min_element(exponents.begin(), exponents.end());
  for (std::size_t axis = 0; axis < 3; ++axis)
    scale[axis] = std::ldexp(1.0, exponents[axis] - least);
  return scale;
}

AxisScale equal_extents(const geometry::Box& box) {
  AxisScale scale{1, 1, 1};
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max(largest, box.max[axis] - box.min[axis]);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = box.max[axis] - box.min[axis];
    if (extent > 0 && std::isfinite(largest)) {
      scale[static_cast<std::size_t>(axis)] =
          std::ldexp(1.0, std::ilogb(largest) - std::ilogb(extent));
    }
  }
  return scale;
}

std::optional<std::vector<Point>> scaled(std::span<const Point> points, const AxisScale& scale) {
  std::vector<Point> result;
  result.reserve(points.size());
  for (const Point& p : points) {
    const Point q{p.x * scale[0], p.y * scale[1], p.z * scale[2]};
    if (q.x / scale[0] != p.x || q.y / scale[1] != p.y || q.z / scale[2] != p.z) {
      return std::nullopt;
    }
    result.push_back(q);
  }
  return result;
}

void unscale(std::vector<Point>& points, const AxisScale& scale) {
  for (Point& p : points) p = {p.x / scale[0], p.y / scale[1], p.z / scale[2]};
}

}  // namespace watertight::delaunay
