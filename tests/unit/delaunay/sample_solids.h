// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids with known properties for the tests of delaunay/, on an integer lattice.
#pragma once

#include <array>
#include <vector>

#include "geometry/solid.h"

namespace watertight::samples {

using Ring = std::vector<Index>;
using Facet = std::vector<Ring>;   // exterior ring first
using Shell = std::vector<Facet>;  // exterior shell first in a solid

struct Shape {
  std::vector<Point> vertices;
  std::vector<Shell> shells;
};

Solid make_solid(const Shape& shape);

/// Axis-parallel box with outward facets; `is_cavity` turns them inward. Adds a shell.
Shape box(const Point& low, const Point& high);
void add_box(Shape& shape, const Point& low, const Point& high, bool is_cavity);
/// Adds the facets of a box to the last shell.
void add_box_facets(Shape& shape, const Point& low, const Point& high, bool is_cavity);

/// Schoenhardt's twisted prism: no tetrahedralization without Steiner points.
Shape schoenhardt();
/// A box with a square hole from top to bottom (a torus): two facets have an interior ring.
Shape tunnelled_box();
/// A box with three pits in its top, facet 1: the rim of the first has the box's corner 4, the
/// second's a vertex of the first's, the third's the box's corner 7.
Shape touching_pits();
/// A box with two pits in its top, facet 1: the rim of the first has a vertex inside the edge to
/// the front wall, facet 2, which has that vertex too; the second's has one inside an edge of the
/// first's, and so has the wall of the pit there.
Shape pits_inside_edges();
/// A box whose roof is a quadrilateral that is not planar (one corner `lift` units higher).
Shape warped_box(double lift);
/// A prism over a polygon in the plane z = 0, counter-clockwise.
Shape prism(const std::vector<std::array<double, 2>>& polygon, double height);
/// n x n rectangular blocks of different heights: an L-shaped, stepped, closed boundary.
Shape stairs(int steps);

/// The same solid with vertices, facets and ring starts renumbered at random.
Shape shuffled(const Shape& shape, unsigned seed);

}  // namespace watertight::samples
