// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "geometry/fitted_plane.h"
#include "geometry/vector3.h"
#include "repair/border_loops.h"
#include "repair/remedies.h"
#include "repair/turn.h"
#include "tessellate/facets.h"

namespace watertight::repair {
namespace {

using tessellate::FacetState;

// With more loops in a shell islands are not looked for: each pair of loops is triangulated.
constexpr std::size_t kMostLoops = 200;

/// The canonical triangles of a facet with these rings; none if the rings bound no region.
std::vector<Ring> triangles_of(const EditedSolid& solid, const EditedFacet& facet) {
  std::vector<Ring> result;
  const Result<FacetAlone> own = alone(solid, facet);
  if (!own) return result;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(own->solid);
  if (facets.state[0] != FacetState::triangulated) return result;
  for (const Triangle& triangle : facets.triangles) {
    Ring& ring = result.emplace_back();
    for (const Index vertex : triangle) ring.push_back(own->vertices[vertex]);
  }
  return result;
}

/// Twice the area of a loop, as it is seen from where it is largest; in square metres.
double size_of(const EditedSolid& solid, const Ring& loop, const std::array<double, 3>& units) {
  using namespace geometry;
  Vector3 area{};
  const Vector3 first = metres_of(solid, loop[0], units);
  for (std::size_t i = 2; i < loop.size(); ++i) {
    const Vector3 part = cross(metres_of(solid, loop[i - 1], units) - first,
                               metres_of(solid, loop[i], units) - first);
    for (std::size_t axis = 0; axis < 3; ++axis) area[axis] += part[axis];
  }
  return length(area);
}

/// Whether a loop is an island in another one: it lies inside and runs the other way.
bool is_island(const EditedSolid& solid, const Ring& outer, const Ring& loop) {
  const EditedFacet facet{{outer, loop}, kNone};
  const int turn = turn_of(solid, facet, outer);
  return turn != 0 && turn_of(solid, facet, loop) == -turn && !triangles_of(solid, facet).empty();
}

/// The loops in groups, each an outer loop and its islands. Large loops choose first.
std::vector<std::vector<Ring>> groups_of(const EditedSolid& solid, std::vector<Ring> loops) {
  const auto units = metres_per_unit(solid);
  std::vector<std::pair<double, Ring>> by_size;
  for (Ring& loop : loops) by_size.emplace_back(-size_of(solid, loop, units), std::move(loop));
  std::sort(by_size.begin(), by_size.end());
  std::vector<std::vector<Ring>> groups;
  std::vector<bool> is_taken(by_size.size());
  for (std::size_t i = 0; i < by_size.size(); ++i) {
    if (is_taken[i]) continue;
    std::vector<Ring>& group = groups.emplace_back();
    group.push_back(by_size[i].second);
    for (std::size_t j = i + 1; j < by_size.size() && by_size.size() <= kMostLoops; ++j) {
      if (is_taken[j] || !is_island(solid, by_size[i].second, by_size[j].second)) continue;
      group.push_back(by_size[j].second);
      is_taken[j] = true;
    }
  }
  return groups;
}

bool is_planar(const EditedSolid& solid, const std::vector<Ring>& group,
               const Tolerances& tolerances) {
  const auto units = metres_per_unit(solid);
  std::vector<std::array<double, 3>> places;
  for (const Ring& loop : group) {
    for (const Index vertex : loop) places.push_back(metres_of(solid, vertex, units));
  }
  const double limit = tolerances.planarity_metres;
  return geometry::distance_to_fitted_plane(places, limit).distance <= limit;
}

/// Adds the facets that close a hole.
HoleFill fill_hole(const EditedSolid& solid, std::vector<Ring> group, const Tolerances& tolerances,
                   std::vector<EditedFacet>& facets) {
  HoleFill fill;
  fill.loops = group.size();
  for (const Ring& loop : group) fill.vertices += loop.size();
  EditedFacet facet{std::move(group), kNone};
  std::vector<Ring> triangles = triangles_of(solid, facet);
  if (triangles.empty()) {
    fill.method = "unfilled";
    fill.reason = "the loops cross in projection";
    return fill;
  }
  if (is_planar(solid, facet.rings, tolerances)) {
    fill.method = "facet";
    fill.facets = 1;
    facets.push_back(std::move(facet));
    return fill;
  }
  fill.method = "plan";
  fill.facets = triangles.size();
  for (Ring& triangle : triangles) facets.push_back({{std::move(triangle)}, kNone});
  return fill;
}

}  // namespace

std::vector<HoleFill> fill_holes(EditedSolid& solid, const Tolerances& tolerances) {
  std::vector<HoleFill> fills;
  for (std::size_t shell = 0; shell < solid.shells.size(); ++shell) {
    BorderLoops borders = border_loops(solid.shells[shell]);
    std::vector<EditedFacet> added;
    for (std::vector<Ring>& group : groups_of(solid, std::move(borders.loops))) {
      HoleFill fill = fill_hole(solid, std::move(group), tolerances, added);
      fill.shell = static_cast<Index>(shell);
      fills.push_back(std::move(fill));
    }
    if (borders.left_over > 0) {
      fills.push_back({static_cast<Index>(shell), 0, borders.left_over, 0, "unfilled",
                       "more than two facets meet along the border"});
    }
    for (EditedFacet& facet : added) solid.shells[shell].push_back(std::move(facet));
  }
  return fills;
}

}  // namespace watertight::repair
