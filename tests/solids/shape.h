// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids written down as points, for tests and benches that build, damage and move them: a shape is
// shells of facets of rings of points. And the ways to write the same solid differently.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "geometry/solid.h"
#include "tests/random.h"
#include "validate/report.h"

namespace watertight::solids {

using test::Random;

using Ring = std::vector<Point>;
using Facet = std::vector<Ring>;   // the exterior ring first
using Shell = std::vector<Facet>;  // facets outward; those of a cavity turned inside
using Shape = std::vector<Shell>;  // the exterior shell first

/// Millimetres: the lattice of most city models.
Lattice millimetres();

/// Equal points become one vertex, in order of first use. Ends the program if the library refuses.
Solid solid_of(const Shape& shape, const Lattice& lattice = {}, std::uint32_t srid = 0);
/// The solid of arrays that are known to be sound. Ends the program if the library refuses.
Solid solid_of(SolidArrays arrays, const Lattice& lattice, std::uint32_t srid = 0);
Shape shape_of(const Solid& solid);

Ring reversed(Ring ring);
Facet turned_over(Facet facet);
Shell inside_out(Shell shell);
Shell join(Shell shell, const Shell& other);
std::size_t facet_count(const Shape& shape);
std::size_t corner_count(const Shape& shape);

/// The same solid written differently: where everything went.
struct Rewritten {
  Solid solid;
  std::vector<Index> facet_of;  // facet of the new solid -> facet of the old one
  std::vector<Index> shell_of;  // likewise
};
/// Vertices, facets, interior rings and interior shells in another order, ring starts moved.
Rewritten rewritten(const Solid& solid, Random& random);

/// x -> matrix x + shift, on integers.
struct AffineMap {
  std::array<std::array<std::int64_t, 3>, 3> matrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::array<std::int64_t, 3> shift{};
  std::int64_t determinant() const;
};
/// An integer map of positive determinant; `size` bounds the entries of the matrix.
AffineMap unimodular_map(Random& random, std::int64_t size);
AffineMap general_map(Random& random, std::int64_t size);
/// An even permutation of the axes, or an odd one.
AffineMap axis_permutation(Random& random, bool is_even);

/// The largest absolute coordinate that the map gives on the solid.
double largest_coordinate(const Solid& solid, const AffineMap& map);
/// The mapped solid; for a map of negative determinant all rings are reversed too. Requires integer
/// coordinates, before and after, below 2^53.
Solid mapped(const Solid& solid, const AffineMap& map);

/// Codes of a report's findings of one severity.
std::set<int> codes_of(const Report& report, Severity severity);

}  // namespace watertight::solids
