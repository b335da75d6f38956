// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids written as points, for tests and benches that build, damage and move them: a shape is
// shells of facets of rings of points. Also different ways to write the same solid.
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
using Facet = std::vector<Ring>;   // the exterior ring is first
using Shell = std::vector<Facet>;  // the facets face outward, those of a cavity inward
using Shape = std::vector<Shell>;  // the exterior shell is first

/// The lattice of most city models, with steps of a millimetre.
Lattice millimetres();

/// The solid of a shape. Equal points become one vertex, in order of first use. Ends the program if
/// the library refuses the shape.
Solid solid_of(const Shape& shape, const Lattice& lattice = {}, std::uint32_t srid = 0);
/// The solid of arrays that are known to be sound. Ends the program if the library refuses the
/// arrays.
Solid solid_of(SolidArrays arrays, const Lattice& lattice, std::uint32_t srid = 0);
Shape shape_of(const Solid& solid);

Ring reversed(Ring ring);
Facet turned_over(Facet facet);
Shell inside_out(Shell shell);
Shell join(Shell shell, const Shell& other);
std::size_t facet_count(const Shape& shape);
std::size_t corner_count(const Shape& shape);

/// A solid written differently, with the origin of each facet and shell.
struct Rewritten {
  Solid solid;
  std::vector<Index> facet_of;  // for each facet of the new solid, the facet of the old one
  std::vector<Index> shell_of;  // for each shell of the new solid, the shell of the old one
};
/// The solid with its vertices, facets, interior rings and interior shells in another order and
/// other ring starts.
Rewritten rewritten(const Solid& solid, Random& random);

/// The map x -> matrix x + shift, in integers.
struct AffineMap {
  std::array<std::array<std::int64_t, 3>, 3> matrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::array<std::int64_t, 3> shift{};
  std::int64_t determinant() const;
};
/// An integer map of positive determinant; `size` bounds the entries of the matrix.
AffineMap unimodular_map(Random& random, std::int64_t size);
AffineMap general_map(Random& random, std::int64_t size);
/// A map that permutes the axes, evenly or oddly.
AffineMap axis_permutation(Random& random, bool is_even);

/// The largest absolute coordinate of the mapped solid.
double largest_coordinate(const Solid& solid, const AffineMap& map);
/// The mapped solid; a map of negative determinant reverses all rings too. Requires integer
/// coordinates below 2^53, before and after.
Solid mapped(const Solid& solid, const AffineMap& map);

/// The codes of the report's findings that have the given severity.
std::set<int> codes_of(const Report& report, Severity severity);

}  // namespace watertight::solids
