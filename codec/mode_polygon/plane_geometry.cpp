// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_polygon/plane_geometry.h"

#include <cmath>

#include "geometry/vector3.h"

namespace watertight::codec::polygon {
namespace {

using geometry::Vector3;

Vector3 between(const GridPoint& from, const GridPoint& to) {
  return {static_cast<double>(to[0] - from[0]), static_cast<double>(to[1] - from[1]),
          static_cast<double>(to[2] - from[2])};
}

// A facet is a wall if the squared z of its normal is below this part of the normal's squared
// length: within 1.1 degrees.
constexpr double kWallSquared = 0.02 * 0.02;

}  // namespace

Turn::Turn(Flat direction) {
  for (; quarters_ < 3; ++quarters_) {
    const double across = direction.y < 0 ? -direction.y : direction.y;
    if (direction.x >= across) break;
    direction = {direction.y, -direction.x};
  }
  if (!(direction.x > 0)) return;
  const double length = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  shear_ = direction.y / (length + direction.x);
  lift_ = -direction.y / length;
}

GridColumn Turn::back(GridColumn turned) const {
  std::int64_t x = turned[0];
  std::int64_t y = turned[1];
  x -= to_whole(shear_ * static_cast<double>(y));
  y -= to_whole(lift_ * static_cast<double>(x));
  x -= to_whole(shear_ * static_cast<double>(y));
  for (int i = 0; i < quarters_; ++i) {
    const std::int64_t old = x;
    x = -y;
    y = old;
  }
  return {x, y};
}

void FacetPlane::add(Index vertex, const std::vector<GridPoint>& points_of) {
  if (count < 2) {
    points[static_cast<std::size_t>(count++)] = vertex;
    return;
  }
  const GridPoint& q = points_of[vertex];
  const auto consider = [&](std::size_t one, std::size_t two, std::size_t replaced) {
    const GridPoint& a = points_of[points[one]];
    const Vector3 candidate = geometry::cross(between(a, points_of[points[two]]), between(a, q));
    const double candidate_area = geometry::dot(candidate, candidate);
    if (!(candidate_area > area)) return false;
    normal = candidate;
    area = candidate_area;
    origin = a;
    points[replaced] = vertex;
    return true;
  };
  if (count == 2) {
    if (consider(0, 1, 2)) count = 3;
  } else if (!consider(0, 1, 2) && !consider(0, 2, 1)) {
    consider(1, 2, 0);
  }
  if (count < 3) return;
  const double up = normal[2] * normal[2];
  kind = normal[0] == 0 && normal[1] == 0 ? Kind::level
         : up < kWallSquared * area       ? Kind::wall
                                          : Kind::steep;
}

std::int64_t FacetPlane::height(GridColumn column) const {
  const double x = static_cast<double>(column[0] - origin[0]);
  const double y = static_cast<double>(column[1] - origin[1]);
  const std::int64_t height = origin[2] - to_whole((x * normal[0] + y * normal[1]) / normal[2]);
  constexpr std::int64_t limit = std::int64_t{1} << 53;
  return height < limit && height > -limit ? height : origin[2];
}

double FacetPlane::reach(GridColumn column) const {
  const double x = static_cast<double>(column[0] - origin[0]);
  const double y = static_cast<double>(column[1] - origin[1]);
  return 16 * (x * x + y * y) / (normal[2] < 0 ? -normal[2] : normal[2]);
}

}  // namespace watertight::codec::polygon
