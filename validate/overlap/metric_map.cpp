// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/overlap/metric_map.h"

#include "geometry/crs/crs.h"

namespace watertight::validate {
namespace {

std::array<double, 3> centre_of(const Solid& solid) {
  std::array<double, 3> centre{};
  if (solid.vertex_count() == 0) return centre;
  const Box box = solid.box();
  const std::array<double, 3> low = solid.lattice().world(box.min);
  const std::array<double, 3> high = solid.lattice().world(box.max);
  for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = low[axis] / 2 + high[axis] / 2;
  return centre;
}

}  // namespace

MetricMap::MetricMap(const Solid& solid, const geometry::Placement* placement) {
  const geometry::AxisUnits units =
      placement == nullptr ? geometry::axis_units(solid.srid(), centre_of(solid))
                           : geometry::axis_units(placement->srid, geometry::shift_of(*placement));
  note_ = units.note;
  const Lattice& lattice = solid.lattice();
  if (placement == nullptr) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      per_step_[a] = lattice.scale(axis) * units.metres_per_unit[a];
    }
    return;
  }
  matrix_ = geometry::linear_part(*placement);
  for (std::size_t row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      (*matrix_)[row][static_cast<std::size_t>(axis)] *=
          units.metres_per_unit[row] * lattice.scale(axis);
    }
  }
}

std::array<double, 3> MetricMap::metres(const Point& from, const Point& to) const {
  std::array<double, 3> result{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double distance = to[axis] - from[axis];
    if (!matrix_) {
      result[a] = distance * per_step_[a];
    } else {
      for (std::size_t row = 0; row < 3; ++row) result[row] += (*matrix_)[row][a] * distance;
    }
  }
  return result;
}

}  // namespace watertight::validate
