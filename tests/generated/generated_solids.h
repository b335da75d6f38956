// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids made by formula, for the codec's tests, its fuzz seeds and the comparison of compilers.
// Integer arithmetic only: the same on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "delaunay/certificate.h"
#include "geometry/valid_solid.h"
#include "tests/random.h"

namespace watertight::generated {

using test::Random;

struct NamedBoundary {
  std::string name;
  OrientedBoundary boundary;
};

/// Appends a facet from rings of vertex indices; the first ring is the exterior one.
void add_facet(SolidArrays& arrays, const std::vector<std::vector<Index>>& rings);

/// Appends the axis-parallel box as a shell. A cavity's facets are turned inside.
enum class Turn : std::uint8_t { outward, inward };
void add_box(SolidArrays& arrays, Point min, Point max, Turn turn = Turn::outward);

OrientedBoundary boundary_of(SolidArrays arrays);
OrientedBoundary boundary_of(SolidArrays arrays, const Lattice& lattice, std::uint32_t srid);

OrientedBoundary box();
/// A square block with square holes through it, `holes` x `holes`: facets with holes, high genus.
OrientedBoundary pierced_block(Index holes);
/// A box with `count` cavities side by side.
OrientedBoundary box_with_cavities(Index count);
/// Two boxes as one shell each, touching along an edge or at a vertex.
OrientedBoundary boxes_touching_at_edge();
OrientedBoundary boxes_touching_at_vertex();
/// A facet whose hole touches the exterior ring at one vertex.
OrientedBoundary block_with_touching_hole();
/// A torus of n x m quadrilaterals split into triangles, on integers.
OrientedBoundary torus(Index n, Index m);
/// n^3 unit cubes glued: the surface of the cube with all n x n squares of each side as facets, so
/// that all vertices are cospherical in many ways and neighbouring facets are coplanar.
OrientedBoundary grid_cube(Index n);
/// Schoenhardt's polyhedron: no tetrahedralization without Steiner vertices, three faces that no
/// Delaunay tetrahedralization of its vertices has.
OrientedBoundary schoenhardt();
/// And a tetrahedralization of it with a Steiner vertex at its centre, as an engine would return.
delaunay::Certificate schoenhardt_certificate();
/// A prism over a random star-shaped polygon with `sides` sides: roofs that need unrecovered faces.
OrientedBoundary random_prism(Random& random, Index sides);
/// A tent of random heights over a grid, closed below: triangles in general position.
OrientedBoundary random_terrain(Random& random, Index size);
/// The same terrain with coordinates that are no integers, on a float64 lattice.
OrientedBoundary random_doubles(Random& random, Index size);

/// A pyramid on its side, in canonical form. Its base, in the plane y = 0, is a saw: a zigzag
/// between the columns (0, 0) and (400, 0), closed by one vertex at the back. The columns have
/// `teeth` + 1 and `teeth` vertices with the back at the left. With the back at the right the first
/// has two less, the rest is the same: the two solids touch along the zigzag. Requires teeth > 1.
enum class Back : std::uint8_t { left, right };
OrientedBoundary saw(Index teeth, Back back);
constexpr Index kSawTeeth = 258;  // more than 256 vertices in each of the two columns

/// The same solid with vertices, shells, facets and rings shuffled and rings rotated.
OrientedBoundary shuffled(const OrientedBoundary& boundary, Random& random);

/// One of each and some random ones, the same for the same seed.
std::vector<NamedBoundary> all(std::uint64_t seed);

}  // namespace watertight::generated
