// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include "fill/triangulate_loops.h"
#include "geometry/fitted_plane.h"
#include "repair/border_loops.h"
#include "repair/hole_groups.h"
#include "repair/remedies.h"
#include "repair/shell_surface.h"
#include "repair/smooth/smooth_holes.h"
#include "tessellate/facets.h"

namespace watertight::repair {
namespace {

using tessellate::FacetState;

/// The canonical triangles of a facet with these rings; none if the rings bound no region.
std::vector<Triangle> triangles_in_plan(const EditedSolid& solid, const EditedFacet& facet) {
  std::vector<Triangle> result;
  const Result<FacetAlone> own = alone(solid, facet);
  if (!own) return result;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(own->solid);
  if (facets.state[0] != FacetState::triangulated) return result;
  for (const Triangle& triangle : facets.triangles) {
    const auto& [a, b, c] = triangle;
    result.push_back({own->vertices[a], own->vertices[b], own->vertices[c]});
  }
  return result;
}

bool is_planar(const EditedSolid& solid, const ShellSurface& surface, const HoleLoops& group,
               const Tolerances& tolerances) {
  std::vector<std::array<double, 3>> places;
  for (const Ring& loop : group) {
    for (const Index vertex : loop) places.push_back(metres_of(solid, vertex, surface.units()));
  }
  const double limit = tolerances.planarity_metres;
  return geometry::distance_to_fitted_plane(places, limit).distance <= limit;
}

/// The most vertices of 1, 2 and 3 loops for which the optimum is looked for among all triangles.
constexpr std::array<std::size_t, 3> kMostVerticesForAll{128, 24, 24};

/// The most work for the optimum of a hole: some seconds.
constexpr std::size_t kMostDomains = 2'000'000;
constexpr std::size_t kMostBytes = std::size_t{200} << 20U;

bool is_small(const HoleFill& fill) {
  return fill.loops <= kMostVerticesForAll.size() &&
         fill.vertices <= kMostVerticesForAll[fill.loops - 1];
}

fill::FillOptions optimum_options(const EditedSolid& solid, const ShellSurface& surface,
                                  const HoleLoops& loops, const CancelPoll& poll) {
  fill::FillOptions options;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    options.metres_per_unit[at] = surface.units()[at] * solid.lattice.scale(axis);
  }
  for (const Ring& loop : loops) {
    auto& behind = options.behind.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      behind.push_back(surface.behind(loop[i], loop[(i + 1) % loop.size()]));
    }
  }
  options.is_cancelled = poll;
  options.max_domains = kMostDomains;
  options.max_bytes = kMostBytes;
  options.is_allowed = [&](const Triangle& triangle) { return surface.has_room_for(triangle); };
  return options;
}

/// The best triangles: among Delaunay triangles, else among all for a small hole. Says which in
/// `fill`.
Result<std::vector<Triangle>> best_triangles(const EditedSolid& solid, const ShellSurface& surface,
                                             const HoleLoops& loops, const CancelPoll& poll,
                                             HoleFill& fill) {
  fill::FillOptions options = optimum_options(solid, surface, loops, poll);
  auto best = fill::triangulate_loops(solid.vertices, loops, options);
  fill.method = "delaunay";
  if (!best && is_small(fill)) {
    options.space = fill::CandidateSpace::all;
    best = fill::triangulate_loops(solid.vertices, loops, options);
    fill.method = "all";
  }
  if (!best) return std::move(best).error();
  fill.angle = best->angle;
  fill.area = best->area;
  fill.alternatives = best->candidates;
  return std::move(best->triangles);
}

/// Closes a hole by triangles.
void close_by(std::span<const Triangle> triangles, ClosedHole& closed) {
  closed.triangles.assign(triangles.begin(), triangles.end());
  closed.fill.facets = triangles.size();
  for (const Triangle& triangle : triangles)
    closed.facets.push_back({{Ring(triangle.begin(), triangle.end())}, kNone});
}

/// Finds the facets that close a hole.
ClosedHole close_hole(const EditedSolid& solid, const ShellSurface& surface, HoleLoops loops,
                      const FillHolesOptions& options) {
  ClosedHole closed;
  HoleFill& fill = closed.fill;
  fill.loops = loops.size();
  for (const Ring& loop : loops) fill.vertices += loop.size();
  closed.loops = std::move(loops);
  EditedFacet facet{closed.loops, kNone};
  std::vector<Triangle> in_plan = triangles_in_plan(solid, facet);
  if (!in_plan.empty() && is_planar(solid, surface, facet.rings, options.tolerances)) {
    fill.method = "facet";
    fill.facets = 1;
    closed.triangles = std::move(in_plan);
    closed.facets.push_back(std::move(facet));
    return closed;
  }
  if (!options.prefers_plan || in_plan.empty()) {
    const bool is_bounded = fill.loops <= options.most_islands + 1;
    const auto best = is_bounded
                          ? best_triangles(solid, surface, facet.rings, options.is_cancelled, fill)
                          : Error{ErrorCode::limit_exceeded, "the hole has too many islands"};
    if (best) {
      close_by(*best, closed);
      return closed;
    }
    fill.reason = best.error().message;
  }
  if (in_plan.empty()) {
    fill.method = "unfilled";
    return closed;
  }
  fill.method = "plan";
  fill.reason.clear();
  close_by(in_plan, closed);
  return closed;
}

/// The sum of angles for each inner edge of a filling (n + 3k - 6 for k loops of n vertices).
std::optional<double> cost_of(const EditedSolid& solid, const ShellSurface& surface,
                              const HoleLoops& loops, const FillHolesOptions& options) {
  HoleFill fill;
  fill.loops = loops.size();
  if (fill.loops > options.most_islands + 1) return std::nullopt;
  for (const Ring& loop : loops) fill.vertices += loop.size();
  if (!best_triangles(solid, surface, loops, options.is_cancelled, fill)) return std::nullopt;
  return fill.angle / static_cast<double>(fill.vertices + 3 * fill.loops - 6);
}

/// The holes of a shell.
struct ShellHoles {
  std::vector<HoleLoops> holes;
  std::size_t left_over = 0;  // edges of the border that belong to no loop
  bool has_joined = false;    // a hole joins two parts
};

ShellHoles holes_of(const EditedSolid& solid, const ShellSurface& surface, std::size_t shell,
                    const FillHolesOptions& options) {
  BorderLoops borders = border_loops(solid.shells[shell]);
  ShellHoles result{group_loops(solid, std::move(borders.loops)), borders.left_over, false};
  if (!options.joins_parts) return result;
  const std::size_t before = result.holes.size();
  result.holes =
      join_parts(solid.shells[shell], solid.vertices.size(), std::move(result.holes),
                 [&](const HoleLoops& loops) { return cost_of(solid, surface, loops, options); });
  result.has_joined = result.holes.size() < before;
  return result;
}

}  // namespace

std::vector<HoleFill> fill_holes(EditedSolid& solid, const FillHolesOptions& options) {
  std::vector<HoleFill> fills;
  const ShellSurface surface(solid);
  std::vector<ShellHoles> shells;
  for (std::size_t shell = 0; shell < solid.shells.size(); ++shell) {
    shells.push_back(holes_of(solid, surface, shell, options));
  }
  if (options.joins_parts && std::ranges::none_of(shells, &ShellHoles::has_joined)) return fills;
  std::vector<ClosedHole> closed;
  for (std::size_t shell = 0; shell < shells.size(); ++shell) {
    for (HoleLoops& loops : shells[shell].holes) {
      if (options.is_cancelled && options.is_cancelled()) break;
      closed.push_back(close_hole(solid, surface, std::move(loops), options));
      closed.back().fill.shell = static_cast<Index>(shell);
    }
    if (shells[shell].left_over == 0) continue;
    HoleFill& fill = closed.emplace_back().fill;
    fill.shell = static_cast<Index>(shell);
    fill.vertices = shells[shell].left_over;
    fill.method = "unfilled";
    fill.reason = "more than two facets meet along the border";
  }
  if (options.smooth) smooth_holes(solid, surface, closed, *options.smooth, options.is_cancelled);
  for (ClosedHole& hole : closed) {
    auto& facets = solid.shells[hole.fill.shell];
    std::ranges::move(hole.facets, std::back_inserter(facets));
    fills.push_back(std::move(hole.fill));
  }
  return fills;
}

}  // namespace watertight::repair
