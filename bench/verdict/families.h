// SPDX-License-Identifier: GPL-3.0-or-later
//
// Families of small solids near the borders of validity. Each seed gives one sample: a solid, a
// group of solids or a document. The oracle finds its truth unless the construction gives it.
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
  std::vector<Solid> members;  // one solid, or a group on one lattice
  std::optional<validate::GroupKind> group;
  std::string document;        // CityJSON; then there are no members
  std::optional<Truth> truth;  // by construction; nothing: the oracle finds it
  /// Sizes beyond 1e-140 to 1e150 m, where engines may give up.
  bool may_be_undecided = false;
};

struct Family {
  const char* name;
  Sample (*make)(Random& random);
};
std::span<const Family> families();
/// The sample of a seed, the same on every machine.
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
/// Solids of tests/solids, with random vertices moved and boxes joined: no special case in mind.
Sample make_general(Random& random);

// Helpers that the families share.

/// True once in `n` times.
inline bool one_in(Random& random, std::uint64_t n) { return random.below(n) == 0; }
inline Point plus(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point times(const Point& a, double factor) {
  return {a.x * factor, a.y * factor, a.z * factor};
}
/// The shell, or the shell inside out, so that its volume is positive.
Shell outward(Shell shell);
/// The same as a cavity.
Shell as_cavity(Shell shell);
/// A tetrahedron, outward.
Shell outward_tetrahedron(const std::array<Point, 4>& corners);
/// A random rotation times a whole number (1 to 20), and a shift.
AffineMap integer_rotation(Random& random);
/// A random integer map, mirror images among them, or the identity.
AffineMap any_map(Random& random);
/// The shape on the lattice of `exponent` (a power of ten of a metre), mapped, and its vertices,
/// facets and ring starts in another order.
Solid placed(const Shape& shape, const AffineMap& map, int exponent, Random& random);
Sample sample_of(Solid solid);
/// A cavity (outward) in the box from (0,0,0) to (size,size,size): a tetrahedron that touches its
/// facets in vertices and edges.
Shell touching_tetrahedron(Random& random, std::int64_t size);
/// The boundaries of a solid as CityJSON writes them, its vertices numbered from `first_vertex` on.
std::string boundaries_text(const Solid& solid, Index first_vertex = 0);
/// A box with a pit in its top facet and a cavity near it.
Shape pit_and_cavity(Random& random);

}  // namespace watertight::verdict
