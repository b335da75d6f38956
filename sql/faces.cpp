// SPDX-License-Identifier: GPL-3.0-or-later
#include "sql/faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/fitted_plane.h"
#include "geometry/mass/area.h"
#include "geometry/vector3.h"
#include "tessellate/facets.h"

namespace watertight::sql {
namespace {

using geometry::Vector3;

constexpr double kDegrees = 180 / std::numbers::pi;

/// A corner in world units from another one.
Vector3 way(const Solid& solid, Index from, Index to) {
  Vector3 way{};
  for (int axis = 0; axis < 3; ++axis) {
    way[static_cast<std::size_t>(axis)] =
        (solid.vertices()[to][axis] - solid.vertices()[from][axis]) * solid.lattice().scale(axis);
  }
  return way;
}

/// The sums over the triangles of a facet.
struct FacetSums {
  double area = 0;
  Vector3 normal{};  // twice the vector area
  Vector3 centre{};  // from the facet's first vertex, times the area
};

FacetSums sums_of(const Solid& solid, std::span<const Triangle> triangles, Index first) {
  FacetSums sums;
  for (const Triangle& triangle : triangles) {
    const Vector3 normal =
        geometry::cross(way(solid, triangle[0], triangle[1]), way(solid, triangle[0], triangle[2]));
    const double area = std::hypot(normal[0], normal[1], normal[2]) / 2;
    sums.area += area;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double corners = 0;
      for (const Index corner : triangle) corners += way(solid, first, corner)[axis];
      sums.normal[axis] += normal[axis];
      sums.centre[axis] += area * corners / 3;
    }
  }
  return sums;
}

/// Sets the unit normal and the angles that follow from it.
void set_direction(const Vector3& normal, wt_face& face) {
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  const double across = std::hypot(normal[0], normal[1]);
  for (std::size_t axis = 0; axis < 3; ++axis) face.normal[axis] = normal[axis] / length;
  face.tilt = std::atan2(across, normal[2]) * kDegrees;
  face.azimuth = std::numeric_limits<double>::quiet_NaN();
  if (across == 0) return;
  const double angle = std::atan2(normal[0], normal[1]) * kDegrees;
  face.azimuth = angle < 0 ? angle + 360 : angle + 0.0;
}

/// The largest distance of a corner of a facet from its fitted plane, in world units.
double planarity_of(const Solid& solid, Index facet, Index first) {
  std::vector<std::array<double, 3>> points;
  const geometry::IndexRange rings = solid.rings_of(facet);
  for (Index ring = rings.begin; ring < rings.end; ++ring) {
    for (const Index corner : solid.ring(ring)) points.push_back(way(solid, first, corner));
  }
  return geometry::distance_to_fitted_plane(points, 0).distance;
}

}  // namespace

std::vector<wt_face> faces_of(const Solid& solid) {
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  const std::span<const Triangle> triangles = facets.triangles;
  std::vector<wt_face> faces;
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const geometry::IndexRange range = solid.facets_of(shell);
    for (Index facet = range.begin; facet < range.end; ++facet) {
      const Index first = solid.ring(solid.rings_of(facet).begin).front();
      const auto parts =
          triangles.subspan(facets.first[facet], facets.first[facet + 1] - facets.first[facet]);
      const FacetSums sums = sums_of(facets.divided_solid(solid), parts, first);
      wt_face& face = faces.emplace_back();
      face.shell = shell;
      face.facet = facet;
      face.rings = solid.rings_of(facet).size();
      face.area = geometry::area_of(facets.divided_solid(solid), parts);
      set_direction(sums.normal, face);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        face.centroid[axis] = solid.world(first)[axis] + sums.centre[axis] / sums.area;
      }
      face.planarity = planarity_of(solid, facet, first);
    }
  }
  return faces;
}

}  // namespace watertight::sql
