// SPDX-License-Identifier: GPL-3.0-or-later
//
// The canonical form (docs/format.md, "Conventions"), on which equality, hash and blob bytes are
// defined: vertices sorted lexicographically; each ring rotated to its smallest vertex; the
// exterior ring first, interior rings sorted; facets sorted within a shell; the exterior shell
// first, inner shells sorted; orientation kept. And the way back to the source order.
#pragma once

#include <vector>

#include "geometry/valid_solid.h"

namespace watertight::geometry {

/// Where each vertex, shell, facet and ring of the canonical solid stood. All are permutations.
struct SourceOrder {
  std::vector<Index> vertex;  // canonical vertex -> source vertex
  std::vector<Index> shell;   // canonical shell -> source shell
  std::vector<Index> facet;   // canonical facet -> source facet
  std::vector<Index> ring;    // canonical ring -> source ring
  /// canonical ring -> the index in it of the vertex at which the source ring starts.
  std::vector<Index> ring_start;
  bool is_identity() const;
  friend bool operator==(const SourceOrder&, const SourceOrder&) = default;
};

struct CanonicalSolid {
  OrientedBoundary boundary;
  SourceOrder order;
};

/// Requires merged vertices (OrientedBoundary guarantees it). Cost: O(n log n).
CanonicalSolid canonical_form(const OrientedBoundary& boundary);

/// The inverse: puts a canonical solid back into source order.
/// Errors: malformed if `order` is not made of permutations that fit the solid.
Result<Solid> restore_order(const Solid& canonical, const SourceOrder& order);

/// 64-bit hash of the canonical form, lattice and SRID. Equal solids have equal hashes.
std::uint64_t solid_hash(const OrientedBoundary& boundary);

}  // namespace watertight::geometry
