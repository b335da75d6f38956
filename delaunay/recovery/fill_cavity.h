// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fills a small polyhedral cavity with tetrahedra that have no other corners than those of the
// cavity. Private to delaunay/.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::delaunay {

/// The most triangles around a cavity that is filled; a cavity with more is left alone.
inline constexpr std::size_t kLargestFront = 96;

/// The polyhedral cavity to fill.
struct Cavity {
  /// The triangles around it, each turned so that the inside is where orient3d is positive. A
  /// triangle inside the cavity that the tetrahedra must keep is there twice, once for each side.
  /// Triangles meet in common vertices and edges only.
  std::vector<Triangle> front;
  std::vector<Index> inner_vertices;  // vertices inside the cavity or on its front
  /// A vertex beyond the hull, or kNone. A tetrahedron that has it has its other corners in the
  /// plane of `base`, so that none is inside and outside of the hull.
  Index outer_vertex = kNone;
  Triangle base{};
};

struct Filling {
  /// Positive tetrahedra that fill the inside once, with each triangle of the front as a face;
  /// none if the search found none.
  std::vector<geometry::Tetrahedron> tetrahedra;
  /// The triangles, turned as in the front and with their smallest vertex first, over which the
  /// search found no room for a tetrahedron. In order, each once.
  std::vector<Triangle> blocked;
};

/// Fills a cavity by a search that takes at most `steps` tests of a tetrahedron against the front;
/// `steps` becomes the number that is left. The result depends on the arguments alone.
/// Source: gift wrapping of cavities as in Si and Gaertner, "3D boundary recovery by constrained
/// Delaunay tetrahedralization" (2011). Departures: a search that goes back over wrong choices; the
/// Delaunay rule, rounded, only orders choices that close as many faces; every decision is exact.
Filling fill_cavity(std::span<const Point> points, Cavity cavity, std::size_t& steps);

}  // namespace watertight::delaunay
