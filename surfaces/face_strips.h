// SPDX-License-Identifier: GPL-3.0-or-later
//
// The triangles of curved faces as strips, and the shape of these triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/point.h"
#include "tessellate/strips.h"

namespace watertight::surfaces {

struct FaceStrips {
  std::string face;  // BoundaryFace::name
  std::vector<tessellate::Strip> strips;
};

/// Counts the triangles, strips and angles of many faces.
class TriangleShapes {
 public:
  using Position = std::array<std::int64_t, 3>;

  /// Makes the strips of the triangles of one face, between places on a lattice, and counts them.
  /// Cost: linear in the triangles.
  std::vector<tessellate::Strip> add(std::span<const Triangle> triangles,
                                     std::span<const Position> positions);

  std::uint64_t strips() const { return strips_; }
  std::uint64_t indices() const { return indices_; }  // of all strips
  /// The least angles of all triangles in degrees: their mean, and the smallest; 0 without any.
  double mean_least_angle() const;
  double worst_least_angle() const;

 private:
  std::uint64_t strips_ = 0;
  std::uint64_t indices_ = 0;
  std::uint64_t triangles_ = 0;
  double sum_ = 0;
  double worst_ = 180;
  std::vector<Index> number_of_;  // position -> its number within a face, kNone between calls
};

}  // namespace watertight::surfaces
