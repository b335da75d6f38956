// SPDX-License-Identifier: GPL-3.0-or-later
//
// The canonical Delaunay tetrahedralization: the Delaunay tetrahedralization of a point set with
// ties broken by lexicographic symbolic perturbation, so that it is unique. Part of the blob
// format: docs/format.md states the rule. For the codec and for rung 0 of the CDT
// ladder. Integers in a box of sides below 2^30 are taken by small_delaunay.h, without a library;
// all other points by CGAL.
// Source: Verbree & Si 2008, section 2.2 and composition steps 2 and 4; the tie rule is Devillers &
// Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D triangulations" (2011), section 3.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "delaunay/tetrahedralization.h"

namespace watertight::delaunay {

struct CanonicalDelaunay {
  /// Positively oriented (orient3d > 0), smallest index first; the list sorted lexicographically.
  std::vector<geometry::Tetrahedron> tetrahedra;
  /// All faces as sorted vertex triples, in lexicographic order: the order of the bitmap.
  std::vector<Triangle> faces;
  /// For each face, the fourth vertices of its tetrahedra: first the one on its positive side
  /// (orient3d(face, apex) > 0), then the one on its negative side; kNone where there is no
  /// tetrahedron.
  std::vector<std::array<Index, 2>> apexes;
};

/// Requires distinct points. Guarantees the same result for every insertion order, compiler and
/// machine; indices refer to `points`. Returns an empty tetrahedralization if the points span no
/// volume (fewer than 4, or all coplanar).
/// Errors: invalid_argument for equal points or one that is not finite; limit_exceeded beyond
/// `max_tetrahedra`; cancelled once `is_cancelled` (asked every few thousand cells) says so.
/// Cost: O(n log n) typical, O(n^2) worst.
Result<CanonicalDelaunay> canonical_delaunay(std::span<const Point> points,
                                             std::uint64_t max_tetrahedra = 64'000'000,
                                             const CancelPoll& is_cancelled = {});

}  // namespace watertight::delaunay
