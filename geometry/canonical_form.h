// SPDX-License-Identifier: GPL-3.0-or-later
//
// The canonical form (docs/format.md, "Conventions"), on which equality, hash and blob bytes are
// defined: vertices sorted lexicographically; each ring rotated to its smallest vertex; the
// exterior ring first, interior rings sorted; facets sorted within a shell; the exterior shell
// first, interior shells sorted; orientation kept. restore_order() leads back to the source order.
#pragma once

#include <vector>

#include "geometry/valid_solid.h"

namespace watertight::geometry {

/// The source indices of the vertices, shells, facets and rings of a canonical solid. The first
/// four arrays are permutations.
struct SourceOrder {
  std::vector<Index> vertex;  // canonical vertex -> source vertex
  std::vector<Index> shell;   // canonical shell -> source shell
  std::vector<Index> facet;   // canonical facet -> source facet
  std::vector<Index> ring;    // canonical ring -> source ring
  /// canonical ring -> the index, in the canonical ring, of the vertex at which the source ring
  /// starts.
  std::vector<Index> ring_start;
  bool is_identity() const;
  friend bool operator==(const SourceOrder&, const SourceOrder&) = default;
};

struct CanonicalSolid {
  OrientedBoundary boundary;
  SourceOrder order;
};

/// The canonical form of a boundary. Requires merged vertices, as OrientedBoundary guarantees.
/// Cost: O(n log n).
CanonicalSolid canonical_form(const OrientedBoundary& boundary);

/// Puts a canonical solid back into source order: the inverse of canonical_form().
/// Errors: malformed if `order` is not made of permutations that fit the solid.
Result<Solid> restore_order(const Solid& canonical, const SourceOrder& order);

/// A 64-bit hash of the canonical form, the lattice and the SRID. Equal solids have equal hashes.
std::uint64_t solid_hash(const OrientedBoundary& boundary);

}  // namespace watertight::geometry
