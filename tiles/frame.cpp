// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiles/frame.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "projection/projection.h"

namespace watertight::tiles {

Result<Frame> Frame::at(std::uint32_t srid, const Position& origin) {
  Frame frame;
  frame.origin_ = origin;
  frame.axes_ = {Position{1, 0, 0}, Position{0, 1, 0}, Position{0, 0, 1}};
  if (srid == 0) return frame;
  std::array<Position, 1> place{origin};
  const Status changed = projection::transform(srid, projection::System::longitude_latitude, place);
  if (!changed) return changed.error();
  if (!(std::abs(place[0][0]) <= 360 && std::abs(place[0][1]) <= 90)) {
    return Error{ErrorCode::unsupported, std::string("its positions are not in EPSG:")
                                             .append(std::to_string(srid))
                                             .append(", which it states")};
  }
  place[0][2] = 0;
  const double longitude = place[0][0] * std::numbers::pi / 180;
  const double latitude = place[0][1] * std::numbers::pi / 180;
  projection::to_earth_centred(place);
  frame.is_on_earth_ = true;
  frame.origin_ = place[0];
  const double sin_east = std::sin(longitude);
  const double cos_east = std::cos(longitude);
  const double sin_north = std::sin(latitude);
  const double cos_north = std::cos(latitude);
  frame.axes_ = {Position{-sin_east, cos_east, 0},
                 Position{-sin_north * cos_east, -sin_north * sin_east, cos_north},
                 Position{cos_north * cos_east, cos_north * sin_east, sin_north}};
  return frame;
}

std::array<double, 16> Frame::matrix() const {
  std::array<double, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (!is_on_earth_) return matrix;
  for (std::size_t column = 0; column < 3; ++column) {
    for (std::size_t row = 0; row < 3; ++row) matrix[column * 4 + row] = axes_[column][row];
    matrix[12 + column] = origin_[column];
  }
  return matrix;
}

Result<std::vector<GridPosition>> Frame::place(std::uint32_t srid,
                                               std::span<const Position> positions) const {
  std::vector<Position> moved(positions.begin(), positions.end());
  if (is_on_earth_) {
    if (srid == 0) return Error{ErrorCode::unsupported, "it has no coordinate reference system"};
    const Status changed =
        projection::transform(srid, projection::System::longitude_latitude, moved);
    if (!changed) return changed.error();
    projection::to_earth_centred(moved);
  }
  std::vector<GridPosition> placed;
  placed.reserve(moved.size());
  for (const Position& position : moved) {
    GridPosition& steps = placed.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double way = 0;
      for (std::size_t k = 0; k < 3; ++k) way += axes_[axis][k] * (position[k] - origin_[k]);
      const double rounded = std::round(way * kStepsOfAMetre);
      if (!(std::abs(rounded) < std::numeric_limits<std::int32_t>::max())) {
        return Error{ErrorCode::unsupported, "a position is far from the others, or has no place"};
      }
      steps[axis] = static_cast<std::int32_t>(rounded);
    }
  }
  return placed;
}

}  // namespace watertight::tiles
