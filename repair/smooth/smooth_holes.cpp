// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/smooth/smooth_holes.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "geometry/intersection/box_partition.h"
#include "geometry/predicates/predicates.h"
#include "geometry/vector3.h"
#include "repair/smooth/finer_lattice.h"
#include "repair/smooth/smooth_patch.h"

namespace watertight::repair {
namespace {

using geometry::operator-;
using geometry::Vector3;

// The lattice has at least this many steps in a chord or, where none is asked for, in the shortest
// edge of a border.
constexpr double kStepsInAnEdge = 1000;
constexpr double kStepsInAChord = 10;

void refuse(HoleFill& fill, const Refused& refused) {
  fill.smooth_refusal = to_string(refused.refusal);
  fill.smooth_detail = refused.detail;
}

/// A hole with the patch that it may get.
struct PatchedHole {
  ClosedHole* hole = nullptr;
  SmoothPatch patch;
  Index first_vertex = 0;           // of the patch in the solid
  std::vector<Triangle> triangles;  // of the solid's vertices
};

double shortest_edge(const EditedSolid& solid, const Vector3& units, const HoleLoops& loops) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Ring& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector3 edge =
          metres_of(solid, loop[(i + 1) % loop.size()], units) - metres_of(solid, loop[i], units);
      shortest = std::min(shortest, geometry::length(edge));
    }
  }
  return shortest;
}

/// Puts the vertices of all patches into the solid.
Status place(EditedSolid& solid, const Vector3& units, const SmoothOptions& options,
             std::vector<PatchedHole>& patched) {
  std::vector<Vector3> places;
  double step = std::numeric_limits<double>::infinity();
  auto next = static_cast<Index>(solid.vertices.size());
  for (PatchedHole& one : patched) {
    const auto& added = one.patch.new_vertices;
    places.insert(places.end(), added.begin(), added.end());
    step = std::min(step, shortest_edge(solid, units, one.hole->loops) / kStepsInAnEdge);
    one.first_vertex = next;
    next += static_cast<Index>(added.size());
  }
  if (options.chord_metres > 0) step = options.chord_metres / kStepsInAChord;
  if (options.keeps_lattice && solid.lattice.kind != LatticeKind::float64)
    step = std::numeric_limits<double>::infinity();
  if (Status added = add_vertices(solid, units, places, step); !added) return added;
  for (PatchedHole& one : patched) {
    one.triangles = one.patch.triangles;
    const auto border = static_cast<Index>(one.patch.border.size());
    for (Triangle& t : one.triangles) {
      for (Index& corner : t)
        corner = corner < border ? one.patch.border[corner] : one.first_vertex + corner - border;
    }
  }
  return Done{};
}

/// Triangles of the shells, and of the fillings of holes without a patch.
std::vector<Triangle> other_triangles(const ShellSurface& surface,
                                      std::span<const ClosedHole> holes,
                                      std::span<const PatchedHole> patched) {
  std::vector<Triangle> triangles(surface.triangles().begin(), surface.triangles().end());
  auto next = patched.begin();  // in the order of the holes
  for (const ClosedHole& hole : holes) {
    if (next != patched.end() && next->hole == &hole) {
      ++next;
    } else {
      triangles.insert(triangles.end(), hole.triangles.begin(), hole.triangles.end());
    }
  }
  return triangles;
}

/// Whether each patch has a triangle without area or one that meets another triangle.
std::vector<bool> crossing_patches(const EditedSolid& solid, std::vector<Triangle> triangles,
                                   std::span<const PatchedHole> patched) {
  // Those that are there are not compared with each other.
  std::vector<Index> group_of(triangles.size(), 0);
  std::vector<std::size_t> patch_of(triangles.size(), patched.size());
  std::vector<bool> is_crossing(patched.size(), false);
  for (std::size_t i = 0; i < patched.size(); ++i) {
    for (const Triangle& t : patched[i].triangles) {
      if (geometry::are_collinear(solid.vertices[t[0]], solid.vertices[t[1]],
                                  solid.vertices[t[2]])) {
        is_crossing[i] = true;
      }
      triangles.push_back(t);
      group_of.push_back(static_cast<Index>(triangles.size()));
      patch_of.push_back(i);
    }
  }
  geometry::IntersectionOptions options;
  options.group_of = group_of;
  const auto pairs = geometry::intersecting_pairs(solid.vertices, triangles, options);
  if (!pairs) return is_crossing;
  for (const auto& pair : *pairs) {
    // Of two patches the later one goes.
    std::size_t patch = patch_of[pair.second];
    if (patch == patched.size()) patch = patch_of[pair.first];
    is_crossing[patch] = true;
  }
  return is_crossing;
}

std::vector<PatchedHole> patches_of(const EditedSolid& solid, const ShellSurface& surface,
                                    std::span<ClosedHole> holes, const SmoothOptions& options,
                                    const CancelPoll& is_cancelled) {
  std::vector<PatchedHole> patched;
  for (ClosedHole& hole : holes) {
    if (is_cancelled && is_cancelled()) break;
    if (hole.loops.empty()) {
      refuse(hole.fill, {SmoothRefusal::border_not_manifold, hole.fill.reason});
      continue;
    }
    auto patch = smooth_patch(solid, surface, hole.loops, hole.triangles, options);
    if (const auto* refused = std::get_if<Refused>(&patch)) {
      refuse(hole.fill, *refused);
    } else {
      patched.push_back({&hole, std::get<SmoothPatch>(std::move(patch)), 0, {}});
    }
  }
  return patched;
}

void take(PatchedHole& patched) {
  HoleFill& fill = patched.hole->fill;
  fill.method = "smooth";
  fill.angle = 0;
  fill.area = 0;
  fill.alternatives = 0;
  fill.reason.clear();
  fill.facets = patched.triangles.size();
  fill.smooth = patched.patch.measures;
  fill.spline = std::move(patched.patch.spline);
  patched.hole->facets.clear();
  for (const Triangle& t : patched.triangles)
    patched.hole->facets.push_back({{Ring(t.begin(), t.end())}, kNone});
}

}  // namespace

void smooth_holes(EditedSolid& solid, const ShellSurface& surface, std::span<ClosedHole> holes,
                  const SmoothOptions& options, const CancelPoll& is_cancelled) {
  const EditedSolid before{solid.vertices, {}, solid.lattice, solid.srid};
  const Vector3 units = surface.units();
  std::vector<PatchedHole> patched = patches_of(solid, surface, holes, options, is_cancelled);
  while (!patched.empty()) {
    if (const Status placed = place(solid, units, options, patched); !placed) {
      for (PatchedHole& one : patched)
        refuse(one.hole->fill, {SmoothRefusal::too_large, placed.error().message});
      return;
    }
    const std::vector<bool> is_crossing =
        crossing_patches(solid, other_triangles(surface, holes, patched), patched);
    if (std::ranges::find(is_crossing, true) == is_crossing.end()) break;
    std::vector<PatchedHole> kept;
    for (std::size_t i = 0; i < patched.size(); ++i) {
      if (is_crossing[i]) {
        refuse(patched[i].hole->fill,
               {SmoothRefusal::patch_crosses, "the patch meets other facets or itself"});
      } else {
        kept.push_back(std::move(patched[i]));
      }
    }
    patched = std::move(kept);
    solid.vertices = before.vertices;
    solid.lattice = before.lattice;
  }
  for (PatchedHole& one : patched) take(one);
}

}  // namespace watertight::repair
