// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/axis_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/crs/crs.h"

namespace watertight::delaunay {
namespace {

/// The exponent of the nearest power of two; above the middle of two by their product, the upper.
int nearest_exponent(double x) {
  int exponent = 0;
  return std::frexp(x, &exponent) < std::numbers::sqrt2 / 2 ? exponent - 1 : exponent;
}

}  // namespace

AxisScale equal_units(const Solid& solid) {
  const Lattice& lattice = solid.lattice();
  const geometry::Box box = solid.box();
  const auto low = lattice.world(box.min);
  const auto high = lattice.world(box.max);
  std::array<double, 3> centre{};
  for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = (low[axis] + high[axis]) / 2;
  const auto metres = geometry::axis_units(solid.srid(), centre).metres_per_unit;
  std::array<int, 3> exponents{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double unit = lattice.scale(static_cast<int>(axis)) * metres[axis];
    if (!(unit > 0) || !std::isfinite(unit)) return {1, 1, 1};
    exponents[axis] = nearest_exponent(unit);
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
