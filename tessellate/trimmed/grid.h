// SPDX-License-Identifier: GPL-3.0-or-later
//
// The points of a grid inside trimmed regions. Cells that lie wholly inside become two triangles
// each; the rest is a region between the trim loops and the outlines of these cells.
//
// Based on: the sections "Tracing" and "Quads" of the paper on incremental triangulation of trimmed
// Bezier surfaces (region.h). Departure: cells that a loop may meet are marked in doubles with a
// margin, and exact predicates decide the others; nothing is paired.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tessellate/trimmed/region.h"

namespace watertight::tessellate {

/// A grid of lines u = us[j] and v = vs[k], both ascending.
struct PlaneGrid {
  std::vector<double> us;
  std::vector<double> vs;
};

struct GridRegion {
  Region region;                // the points of the loops come first, as they were
  std::vector<Triangle> cells;  // the triangles of the cells wholly inside; left turns
};

/// How far grid points stay away from loops, roughly. By default none does.
struct Clearance {
  double of_cell = 0;            // from all loops: a share of the sides of the cells around a point
  std::vector<double> of_edges;  // from each edge; empty: none
};

/// Puts the grid points that lie strictly inside the loops, and clear of them, into their region.
/// Requires loops that bound a region; other loops give a region that sweep_region() refuses as
/// well. Cost: linear in points and in the cells that loops meet, with the cells of the grid.
GridRegion region_with_grid(Region loops, const PlaneGrid& grid, const Clearance& clearance = {});

/// The constrained Delaunay triangulation of loops with the grid points strictly inside: vertices
/// are the points of the loops, then these grid points.
struct TrimmedTriangles {
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  std::optional<RegionConflict> conflict;
};
TrimmedTriangles triangulate_trimmed(Region loops, const PlaneGrid& grid,
                                     const Clearance& clearance = {});

}  // namespace watertight::tessellate
