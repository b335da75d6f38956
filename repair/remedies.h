// SPDX-License-Identifier: GPL-3.0-or-later
//
// The remedies for invalid solids, each a function that changes facets and answers with the number
// of places that it changed. None of them judges its result: repair.h does, by the validator.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/cancel.h"
#include "geometry/valid_solid.h"
#include "repair/edited_solid.h"
#include "repair/smooth/smooth_options.h"

namespace watertight::repair {

/// Drops repeated points, spikes (a b a) and facets whose area vector is zero; of equal facets one
/// stays, and of two that face each other none. Divides a ring that passes a vertex twice into
/// facets where all parts turn alike. Exact. Cost: O(n log n), and a triangulation for each facet
/// that is divided.
std::size_t mend_rings(EditedSolid& solid);

/// Turns facets so that neighbours agree, the smaller part of each connected set; interior rings
/// against exterior ones; then shells, so that the exterior one looks outwards and the others
/// inwards. Exact. Cost: O(n log n) and a triangulation.
std::size_t orient(EditedSolid& solid);

/// Inserts into edges that only one facet uses the vertices that lie exactly in them and end such
/// edges. Exact. Cost: O(n log n + vertices close to each edge), bounded.
std::size_t insert_junctions(EditedSolid& solid);

/// Vertices that took the places of others.
struct Moves {
  std::size_t vertices = 0;
  double largest_metres = 0;
};

/// Makes vertices at most `metres` apart one (validate/snap.h), and inserts vertices of open edges
/// into open edges at most `metres` away. Answers with the number of vertices that moved or were
/// inserted; sets `moves`. Cost: O(n log n + vertices close to each open edge).
std::size_t weld(EditedSolid& solid, double metres, Moves& moves);

/// Replaces facets by their canonical triangles (tessellate/facets.h). Numbers count through all
/// shells. Facets without triangulation stay. Cost: that of the triangulation.
std::size_t triangulate(EditedSolid& solid, std::span<const Index> facets);

/// The way in which a hole was filled.
struct HoleFill {
  Index shell = 0;
  std::size_t loops = 0;
  std::size_t vertices = 0;
  std::size_t facets = 0;  // new ones
  std::string method;  // "facet", "delaunay", "all", "plan", "smooth", "unfilled"; see fill_holes()
  std::string reason;  // why it is unfilled
  double angle = 0;    // "delaunay", "all": the sum of angles between triangles, in radians
  double area = 0;     // "delaunay", "all": square metres
  std::size_t alternatives = 0;  // "delaunay", "all": the number of triangles to choose from
  std::optional<SmoothMeasures> smooth;  // of a smooth patch
  std::string spline;          // its surface, where SmoothOptions::keeps_surface (docs/formats.md)
  std::string smooth_refusal;  // why there is none, where one was asked for: a SmoothRefusal
  std::string smooth_detail;   // the same in a sentence
};

struct FillHolesOptions {
  Tolerances tolerances;
  std::size_t most_islands = 4;         // holes with more are not filled by an optimum
  bool prefers_plan = false;            // method "plan" before the optimum
  bool joins_parts = false;             // only where tubes join parts of a shell (hole_groups.h)
  CancelPoll is_cancelled;              // then holes stay open
  std::optional<SmoothOptions> smooth;  // a smooth patch in the place of each filling
};

/// Closes the borders of shells. Loops that lie inside another one and run the other way are its
/// islands. The first of these methods that succeeds is taken:
///   facet     all loops are within the tolerances of one plane: one facet with rings
///   delaunay  the triangles with the least sum of angles, to each other and to the facets around
///             the hole, among the Delaunay triangles of its vertices that meet no other facet
///   all       the same among all triangles, for small holes
///   plan      the canonical triangles of a facet with these rings
/// With `smooth`, a filling gives place to a patch that goes on as the surface around it does
/// ("smooth"); where that cannot be, the filling stays, and HoleFill says why.
/// Nothing is filled with `joins_parts` where no two parts can be joined. Cost: O(n log n) and that
/// of fill/triangulate_loops.h for each hole.
std::vector<HoleFill> fill_holes(EditedSolid& solid, const FillHolesOptions& options);

}  // namespace watertight::repair
