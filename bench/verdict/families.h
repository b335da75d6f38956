// SPDX-License-Identifier: GPL-3.0-or-later
//
// Families of small solids near the borders of validity. Each seed gives one sample: a solid, a
// group of solids or a document. The oracle finds the truth about a sample unless the construction
// gives it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/verdict/oracle.h"
#include "tests/solids/builders.h"
#include "validate/groups.h"

namespace watertight::verdict {

using solids::AffineMap;
using solids::Facet;
using solids::Random;
using solids::Ring;
using solids::Shape;
using solids::Shell;

struct Sample {
  std::vector<Solid> members;  // one solid, or the group of solids on one lattice
  std::optional<validate::GroupKind> group;
  std::string document;        // a CityJSON document; a sample with one has no members
  std::optional<Truth> truth;  // the truth by construction; nothing: the oracle finds it
  /// True for sizes beyond 1e-140 to 1e150 m and the like, where engines may give up.
  bool may_be_undecided = false;
};

struct Family {
  const char* name;
  Sample (*make)(Random& random);
};
std::span<const Family> families();
/// The sample of a seed; every machine makes the same one.
Sample sample_of_seed(const Family& family, std::uint64_t seed);

Sample make_diagonals(Random& random);
Sample make_hinge(Random& random);
Sample make_walls(Random& random);
Sample make_prisms(Random& random);
Sample make_touching_rings(Random& random);
Sample make_pits(Random& random);
Sample make_group(Random& random);
Sample make_large_integers(Random& random);
Sample make_scales(Random& random);
Sample make_instance(Random& random);
Sample make_placed_group(Random& random);
/// Solids of tests/solids with random vertices moved, or boxes joined: no special case.
Sample make_general(Random& random);

// Functions that the families share.

/// True in one of `n` cases, at random.
inline bool one_in(Random& random, std::uint64_t n) { return random.below(n) == 0; }
inline Point plus(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point times(const Point& a, double factor) {
  return {a.x * factor, a.y * factor, a.z * factor};
}
/// The shell, turned inside out if its volume is negative.
Shell outward(Shell shell);
/// The shell, turned so that it bounds a cavity.
Shell as_cavity(Shell shell);
/// A tetrahedron whose facets face outward.
Shell outward_tetrahedron(const std::array<Point, 4>& corners);
/// A random rotation times a whole number (1 to 20), and a shift.
AffineMap integer_rotation(Random& random);
/// A random integer map, which may mirror, or the identity.
AffineMap any_map(Random& random);
/// The mapped shape on the lattice of `exponent` (a power of ten of a metre), with its vertices,
/// facets and ring starts in another order.
Solid placed(const Shape& shape, const AffineMap& map, int exponent, Random& random);
Sample sample_of(Solid solid);
/// A tetrahedron (facing outward) for a cavity of the box from (0,0,0) to (size,size,size); it
/// touches the facets of the box in vertices and edges.
Shell touching_tetrahedron(Random& random, std::int64_t size);
/// The boundaries of a solid in CityJSON, with vertices numbered from `first_vertex` on.
std::string boundaries_text(const Solid& solid, Index first_vertex = 0);
/// A box with a pit in its top facet and a cavity near it.
Shape pit_and_cavity(Random& random);

}  // namespace watertight::verdict
