// SPDX-License-Identifier: GPL-3.0-or-later
//
// Regions of the (u, v) plane between closed loops, and their triangulation: a sweep that decides
// exactly whether the loops are simple. For surfaces/.
//
// Based on: A. Fournier, D. Y. Montuno, Triangulating simple polygons and equivalent problems,
// 1984 (trapezoids, and the pieces between their diagonals), as used by S. Kumar, D. Manocha and
// others for trimmed surfaces. Departures: docs/decisions/0049-curved-solids.md.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::tessellate {

using PlaneEdge = std::array<Index, 2>;

/// Points (z = 0) and directed edges with the region on their left. Every point without an edge
/// lies inside the region and becomes a vertex of triangles.
struct Region {
  std::vector<Point> points;
  std::vector<PlaneEdge> edges;
};

/// Why the edges of a region do not bound it.
struct RegionConflict {
  enum class Kind : std::uint8_t {
    crossing,    // the two edges cross, touch or overlap
    equal,       // two vertices (`first` of each) have equal coordinates
    side,        // the region is not on the left of both edges
    outside,     // a point without an edge (first[0]) lies outside the region
    not_closed,  // an edge ends at a vertex (first[0]) where as many edges do not begin
  };
  Kind kind = Kind::crossing;
  PlaneEdge first{kNone, kNone};
  PlaneEdge second{kNone, kNone};
};

struct RegionTriangles {
  std::vector<Triangle> triangles;         // left turns; empty if there is a conflict
  std::optional<RegionConflict> conflict;  // the first that the sweep meets
};

/// Triangulates a region: no vertex is added, and every triangle has an area. A conflict is found
/// exactly if there is one. Requires finite coordinates and indices within `points`. Cost:
/// O(n log n).
RegionTriangles sweep_region(const Region& region);

/// The same by a sweep from the left: fewer edges have to be flipped afterwards where a region is
/// longer along u.
RegionTriangles sweep_region_from_left(Region region);

/// Flips edges between triangles until each is Delaunay: the result is the constrained Delaunay
/// triangulation, with triangles of the largest least angles. Of four points on a circle the
/// smallest by (u, v) has the diagonal, so the set of triangles does not depend on where the flips
/// begin. Stops after 256 flips for each triangle, with a valid triangulation. Requires left turns
/// of which at most two share an edge. Cost: linear for triangles that are nearly Delaunay.
void flip_to_delaunay(std::span<const Point> points, std::vector<Triangle>& triangles);

}  // namespace watertight::tessellate
