// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mass/mass.h"

#include <algorithm>
#include <vector>

#include "geometry/lattice/rational_lattice.h"
#include "geometry/predicates/rational_point.h"

namespace watertight::geometry {
namespace {

/// The vertices of a solid in lattice coordinates, exactly.
std::vector<RationalPoint> rational_vertices(const Solid& solid) {
  std::vector<RationalPoint> vertices;
  vertices.reserve(solid.vertex_count());
  for (const Point& p : solid.vertices()) {
    vertices.push_back({mpq_class(p.x), mpq_class(p.y), mpq_class(p.z)});
  }
  return vertices;
}

/// Twice the area of a triangle in the plane of x and y, positive if it faces up.
mpq_class area_from_above(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// The share of a triangle that a height cuts off at the corner `tip`, where it meets the edges to
/// `one` and `other`.
mpq_class share_at(const mpq_class& tip, const mpq_class& one, const mpq_class& other,
                   const mpq_class& height) {
  return (height - tip) * (height - tip) / ((one - tip) * (other - tip));
}

/// Three times the mean over a triangle of the smaller of its height and a limit.
mpq_class limited_heights(const mpq_class& a, const mpq_class& b, const mpq_class& c,
                          const mpq_class& limit) {
  std::array<const mpq_class*, 3> corners{&a, &b, &c};
  std::ranges::sort(corners, [](const auto* left, const auto* right) { return *left < *right; });
  const auto& [low, middle, high] = corners;
  if (*high <= limit) return a + b + c;
  if (*low >= limit) return 3 * limit;
  if (*middle >= limit) {
    return 3 * limit + share_at(*low, *middle, *high, limit) * (*low - limit);
  }
  return a + b + c - share_at(*high, *low, *middle, limit) * (*high - limit);
}

}  // namespace

std::array<double, 3> centroid(const Solid& solid, std::span<const Triangle> triangles) {
  const std::vector<RationalPoint> vertices = rational_vertices(solid);
  mpq_class volume = 0;  // six times
  RationalPoint moment{};
  for (const auto& [i, j, k] : triangles) {
    const RationalPoint& a = vertices[i];
    const RationalPoint& b = vertices[j];
    const RationalPoint& c = vertices[k];
    const mpq_class part = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                           a[2] * (b[0] * c[1] - b[1] * c[0]);
    volume += part;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moment[axis] += part * (a[axis] + b[axis] + c[axis]);
    }
  }
  std::array<double, 3> centre{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const mpq_class coordinate = moment[axis] / (4 * volume);
    centre[axis] =
        nearest(origin_of(solid.lattice(), axis) + step_of(solid.lattice(), axis) * coordinate);
  }
  return centre;
}

int locate(const Solid& solid, std::span<const Triangle> triangles,
           const std::array<double, 3>& place) {
  RationalPoint point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[axis] = lattice_coordinate(solid.lattice(), axis, place[axis]);
  }
  return locate_rational(point, solid.vertices(), triangles);
}

// By the divergence theorem for (0, 0, min(z, height)), whose divergence is 1 below the height and
// 0 above it, so that no cut has to be closed.
double volume_below(const Solid& solid, std::span<const Triangle> triangles, double height) {
  const Lattice& lattice = solid.lattice();
  const mpq_class limit = lattice_coordinate(lattice, 2, height);
  const std::vector<RationalPoint> vertices = rational_vertices(solid);
  mpq_class sum = 0;  // six times the volume in lattice units
  for (const auto& [i, j, k] : triangles) {
    const RationalPoint& a = vertices[i];
    const RationalPoint& b = vertices[j];
    const RationalPoint& c = vertices[k];
    sum += area_from_above(a, b, c) * limited_heights(a[2], b[2], c[2], limit);
  }
  mpq_class volume = sum / 6;
  for (std::size_t axis = 0; axis < 3; ++axis) volume *= step_of(lattice, axis);
  return nearest(volume);
}

}  // namespace watertight::geometry
