// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/contact/surface.h"

#include <limits>

namespace watertight::geometry {

std::vector<WorldTriangle> world_triangles(const Surface& surface) {
  const Solid& solid = *surface.solid;
  std::vector<Vector3> vertices;
  vertices.reserve(solid.vertex_count());
  for (const Point& point : solid.vertices()) vertices.push_back(solid.lattice().world(point));
  std::vector<WorldTriangle> triangles;
  triangles.reserve(surface.triangles.size());
  for (Index number = 0; number < surface.triangles.size(); ++number) {
    const auto& [i, j, k] = surface.triangles[number];
    WorldTriangle triangle{{vertices[i], vertices[j], vertices[k]}, {}, {}, number};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] =
          std::minmax({vertices[i][axis], vertices[j][axis], vertices[k][axis]});
      triangle.low[axis] = low;
      triangle.high[axis] = high;
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

std::size_t longest_axis(std::span<const WorldTriangle> one, std::span<const WorldTriangle> other) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector3 low{kInfinity, kInfinity, kInfinity};
  Vector3 high{-kInfinity, -kInfinity, -kInfinity};
  for (const std::span<const WorldTriangle> triangles : {one, other}) {
    for (const WorldTriangle& triangle : triangles) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], triangle.low[axis]);
        high[axis] = std::max(high[axis], triangle.high[axis]);
      }
    }
  }
  const Vector3 length = high - low;
  return static_cast<std::size_t>(std::ranges::max_element(length) - length.begin());
}

}  // namespace watertight::geometry
