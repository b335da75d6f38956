// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids made by formula, for the codec's tests, its fuzz seeds and the comparison of compilers.
// Only integer arithmetic is used, so every machine makes the same solids.
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

/// Appends an axis-parallel box as a shell. The facets of a cavity are turned inward.
enum class Turn : std::uint8_t { outward, inward };
void add_box(SolidArrays& arrays, Point min, Point max, Turn turn = Turn::outward);

OrientedBoundary boundary_of(SolidArrays arrays);
OrientedBoundary boundary_of(SolidArrays arrays, const Lattice& lattice, std::uint32_t srid);

OrientedBoundary box();
/// A square block with `holes` x `holes` square holes through it: facets with holes, high genus.
OrientedBoundary pierced_block(Index holes);
/// A box with `count` cavities side by side.
OrientedBoundary box_with_cavities(Index count);
/// Two boxes, each of them a shell, which touch along an edge or at a vertex.
OrientedBoundary boxes_touching_at_edge();
OrientedBoundary boxes_touching_at_vertex();
/// A block with a facet whose hole touches the exterior ring at one vertex.
OrientedBoundary block_with_touching_hole();
/// A torus of n x m quadrilaterals split into triangles, with integer coordinates.
OrientedBoundary torus(Index n, Index m);
/// The surface of a cube of n^3 unit cubes; the n x n squares of each side are facets, so that many
/// sets of vertices are cospherical and neighbouring facets are coplanar.
OrientedBoundary grid_cube(Index n);
/// Schoenhardt's polyhedron: it has no tetrahedralization without Steiner vertices, and three of
/// its faces are in no Delaunay tetrahedralization of its vertices.
OrientedBoundary schoenhardt();
/// A tetrahedralization of Schoenhardt's polyhedron with a Steiner vertex at its centre, as an
/// engine would return it.
delaunay::Certificate schoenhardt_certificate();
/// A prism over a random zigzag polygon with 2 * `sides` vertices: its roof needs unrecovered
/// faces.
OrientedBoundary random_prism(Random& random, Index sides);
/// A surface of random heights over a grid, closed below: triangles in general position.
OrientedBoundary random_terrain(Random& random, Index size);
/// A random terrain whose coordinates are no integers, on a float64 lattice.
OrientedBoundary random_doubles(Random& random, Index size);

/// A pyramid on its side, in canonical form. Its base, in the plane y = 0, is a saw: a zigzag
/// between the columns (0, 0) and (400, 0), closed by one vertex at the back. With the back at the
/// left the columns have `teeth` + 1 and `teeth` vertices; with the back at the right the first
/// column has two less. The two solids touch along the zigzag. Requires teeth > 1.
enum class Back : std::uint8_t { left, right };
OrientedBoundary saw(Index teeth, Back back);
constexpr Index kSawTeeth = 258;  // gives more than 256 vertices in each of the two columns

/// A solid with its vertices, shells, facets and rings shuffled and its rings rotated.
OrientedBoundary shuffled(const OrientedBoundary& boundary, Random& random);

/// Some solids of each kind, and random ones; equal seeds give equal solids.
std::vector<NamedBoundary> all(std::uint64_t seed);

}  // namespace watertight::generated
