// SPDX-License-Identifier: GPL-3.0-or-later
//
// The local frame in which triangles are: metres east, north and up of a place on the ellipsoid of
// WGS 84, on a grid. For display: positions are rounded.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"

namespace watertight::tiles {

/// A position in a frame, in steps.
using GridPosition = std::array<std::int32_t, 3>;

/// Steps of a metre: with a power of two, a float holds every position to 16 km exactly.
inline constexpr double kStepsOfAMetre = 1024;

class Frame {
 public:
  using Position = std::array<double, 3>;

  /// The frame with its origin at the first position of EPSG system `srid`, easting or longitude
  /// first; with code 0 the axes are those of the document. Errors: unsupported for a position that
  /// is not in the system; those of projection::transform().
  static Result<Frame> at(std::uint32_t srid, const Position& origin);

  /// Whether the frame has a place on the Earth.
  bool is_on_earth() const { return is_on_earth_; }
  /// The matrix from the frame to EPSG:4978, column by column; the identity without a place.
  std::array<double, 16> matrix() const;

  /// Brings positions of a document into the frame. Heights count as metres above the ellipsoid.
  /// Errors: unsupported for a position that has no place, or is more than 2,000 km away. Cost:
  /// linear.
  Result<std::vector<GridPosition>> place(std::uint32_t srid,
                                          std::span<const Position> positions) const;

 private:
  bool is_on_earth_ = false;
  Position origin_{};               // earth-centred, or of the document
  std::array<Position, 3> axes_{};  // east, north and up
};

}  // namespace watertight::tiles
