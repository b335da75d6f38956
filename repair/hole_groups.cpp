// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/hole_groups.h"

#include <algorithm>
#include <utility>

#include "geometry/predicates/predicates.h"
#include "geometry/vector3.h"
#include "repair/turn.h"
#include "tessellate/facets.h"

namespace watertight::repair {
namespace {

// With more loops in a shell islands are not looked for.
constexpr std::size_t kMostLoops = 200;

/// Whether a point is inside a ring in the projection along an axis, by the number of edges to its
/// left; a point on the ring may be either.
bool is_inside(const EditedSolid& solid, const Ring& ring, const Point& point, int axis) {
  const int up = axis == 0 ? 2 : axis == 1 ? 0 : 1;
  bool is_in = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point* low = &solid.vertices[ring[i]];
    const Point* high = &solid.vertices[ring[(i + 1) % ring.size()]];
    if ((*low)[up] > (*high)[up]) std::swap(low, high);
    if ((*low)[up] > point[up] || (*high)[up] <= point[up]) continue;
    if (geometry::orient2d(*low, *high, point, axis) < 0) is_in = !is_in;
  }
  return is_in;
}

/// Whether a loop is an island in another one: it lies inside and runs the other way.
bool is_island(const EditedSolid& solid, const Ring& outer, const Ring& loop) {
  const EditedFacet facet{{outer}, kNone};
  const int turn = turn_of(solid, facet, outer);
  if (turn == 0 || turn_of(solid, facet, loop) != -turn) return false;
  const Result<FacetAlone> own = alone(solid, facet);
  if (!own) return false;
  const int axis = tessellate::facet_projection(own->solid, 0).axis;
  return std::ranges::all_of(
      loop, [&](Index vertex) { return is_inside(solid, outer, solid.vertices[vertex], axis); });
}

}  // namespace

std::vector<HoleLoops> group_loops(const EditedSolid& solid, std::vector<Ring> loops) {
  const auto units = metres_per_unit(solid);
  std::vector<std::pair<double, Ring>> by_size;
  for (Ring& loop : loops) {
    const double size = geometry::length(area_vector(solid, loop, units));
    by_size.emplace_back(-size, std::move(loop));
  }
  std::sort(by_size.begin(), by_size.end());
  std::vector<HoleLoops> groups;
  std::vector<bool> is_taken(by_size.size());
  for (std::size_t i = 0; i < by_size.size(); ++i) {
    if (is_taken[i]) continue;
    HoleLoops& group = groups.emplace_back();
    group.push_back(by_size[i].second);
    for (std::size_t j = i + 1; j < by_size.size() && by_size.size() <= kMostLoops; ++j) {
      if (is_taken[j] || !is_island(solid, by_size[i].second, by_size[j].second)) continue;
      group.push_back(by_size[j].second);
      is_taken[j] = true;
    }
  }
  return groups;
}

}  // namespace watertight::repair
