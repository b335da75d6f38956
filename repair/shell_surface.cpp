// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/shell_surface.h"

#include <algorithm>

#include "geometry/intersection/triangle_reach.h"
#include "geometry/intersection/triangle_triangle.h"
#include "tessellate/facets.h"

namespace watertight::repair {
namespace {

std::vector<Triangle> triangles_of_shells(const EditedSolid& solid) {
  const Result<Solid> all = solid_of(solid);
  if (!all) return {};
  return tessellate::triangulate_facets(*all).triangles;
}

}  // namespace

ShellSurface::ShellSurface(const EditedSolid& solid)
    : solid_(solid),
      units_(metres_per_unit(solid)),
      triangles_(triangles_of_shells(solid)),
      tree_(validate::boxes_of(solid.vertices, triangles_)) {
  for (const Triangle& triangle : triangles_) {
    for (std::size_t i = 0; i < 3; ++i) {
      Side& side = sides_[{triangle[i], triangle[(i + 1) % 3]}];
      side.third = triangle[(i + 2) % 3];
      ++side.uses;
    }
  }
}

bool ShellSurface::has_room_for(const Triangle& triangle) const {
  const auto uses = [&](Index from, Index to) {
    const auto found = sides_.find({from, to});
    return found == sides_.end() ? 0 : found->second.uses;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Index from = triangle[i];
    const Index to = triangle[(i + 1) % 3];
    if (uses(from, to) + uses(to, from) > 1) return false;
  }
  const Box box = validate::box_of(triangle, solid_.vertices);
  const geometry::TriangleReach reach(solid_.vertices[triangle[0]], solid_.vertices[triangle[1]],
                                      solid_.vertices[triangle[2]]);
  bool is_free = true;
  const auto is_near = [&](const Box& other) {
    return is_free && other.overlaps(box) && !reach.is_apart_from(other);
  };
  tree_.visit(is_near, [&](Index item) {
    const Triangle& other = triangles_[item];
    if (!is_near(validate::box_of(other, solid_.vertices))) return;
    is_free =
        !geometry::is_intersection(geometry::classify_contact(solid_.vertices, triangle, other));
  });
  return is_free;
}

Index ShellSurface::third(Index from, Index to) const {
  const auto found = sides_.find({from, to});
  return found == sides_.end() || found->second.uses > 1 ? kNone : found->second.third;
}

geometry::Vector3 ShellSurface::behind(Index from, Index to) const {
  const auto found = sides_.find({to, from});
  if (found == sides_.end()) return {};
  return geometry::operator-(metres_of(solid_, found->second.third, units_),
                             metres_of(solid_, from, units_));
}

}  // namespace watertight::repair
