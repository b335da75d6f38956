// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids with known properties for the tests of delaunay/, on an integer lattice.
#pragma once

#include <array>
#include <vector>

#include "geometry/solid.h"

namespace watertight::samples {

using Ring = std::vector<Index>;
using Facet = std::vector<Ring>;   // the exterior ring is first
using Shell = std::vector<Facet>;  // facets; the first shell of a solid is the exterior one

struct Shape {
  std::vector<Point> vertices;
  std::vector<Shell> shells;
};

Solid make_solid(const Shape& shape);

/// An axis-parallel box with outward facets; add_box adds it as a shell, turned inward by
/// `is_cavity`.
Shape box(const Point& low, const Point& high);
void add_box(Shape& shape, const Point& low, const Point& high, bool is_cavity);
/// Adds the facets of a box to the last shell.
void add_box_facets(Shape& shape, const Point& low, const Point& high, bool is_cavity);

/// Schoenhardt's twisted prism, which has no tetrahedralization without Steiner points.
Shape schoenhardt();
/// A box with a square hole from top to bottom (a torus): two facets have an interior ring.
Shape tunnelled_box();
/// A box with three pits in its top, facet 1: the rim of the first pit has the box's corner 4, that
/// of the second a vertex of the first rim, that of the third the box's corner 7.
Shape touching_pits();
/// A box with two pits in its top, facet 1. The rim of the first pit has a vertex inside the edge
/// to the front wall, facet 2, and this wall has the vertex too. The rim of the second pit has a
/// vertex inside an edge of the first rim, and the wall of the first pit at that edge has the
/// vertex too.
Shape pits_inside_edges();
/// A box whose roof is a quadrilateral that is not planar (one corner `lift` units higher).
Shape warped_box(double lift);
/// A prism over a polygon in the plane z = 0 that turns counter-clockwise.
Shape prism(const std::vector<std::array<double, 2>>& polygon, double height);
/// n x n rectangular blocks of different heights: an L-shaped, stepped, closed boundary.
Shape stairs(int steps);

/// The shape with vertices, facets and ring starts renumbered at random.
Shape shuffled(const Shape& shape, unsigned seed);

}  // namespace watertight::samples
