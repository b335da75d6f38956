// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/face_strips.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/vector3.h"

namespace watertight::surfaces {
namespace {

using geometry::cross;
using geometry::dot;
using geometry::length;
using geometry::Vector3;

Vector3 between_positions(const TriangleShapes::Position& from,
                          const TriangleShapes::Position& to) {
  return {static_cast<double>(to[0] - from[0]), static_cast<double>(to[1] - from[1]),
          static_cast<double>(to[2] - from[2])};
}

/// Degrees.
double least_angle(const Triangle& t, std::span<const TriangleShapes::Position> positions) {
  double least = 180;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& corner = positions[t[k]];
    const Vector3 a = between_positions(corner, positions[t[(k + 1) % 3]]);
    const Vector3 b = between_positions(corner, positions[t[(k + 2) % 3]]);
    const double angle = std::atan2(length(cross(a, b)), dot(a, b));
    least = std::min(least, angle * (180 / std::numbers::pi));
  }
  return least;
}

}  // namespace

std::vector<tessellate::Strip> TriangleShapes::add(std::span<const Triangle> triangles,
                                                   std::span<const Position> positions) {
  number_of_.resize(positions.size(), kNone);
  std::vector<Index> position_of;
  std::vector<Triangle> own(triangles.begin(), triangles.end());
  for (Triangle& t : own) {
    const double least = least_angle(t, positions);
    sum_ += least;
    worst_ = std::min(worst_, least);
    for (Index& vertex : t) {
      Index& number = number_of_[vertex];
      if (number == kNone) {
        number = static_cast<Index>(position_of.size());
        position_of.push_back(vertex);
      }
      vertex = number;
    }
  }
  triangles_ += own.size();
  auto strips = tessellate::strips_of(own, position_of.size());
  strips_ += strips.size();
  for (tessellate::Strip& strip : strips) {
    indices_ += strip.size();
    for (Index& vertex : strip) vertex = position_of[vertex];
  }
  for (const Index position : position_of) number_of_[position] = kNone;
  return strips;
}

double TriangleShapes::mean_least_angle() const {
  return triangles_ == 0 ? 0 : sum_ / static_cast<double>(triangles_);
}
double TriangleShapes::worst_least_angle() const { return triangles_ == 0 ? 0 : worst_; }

}  // namespace watertight::surfaces
