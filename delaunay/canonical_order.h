// SPDX-License-Identifier: GPL-3.0-or-later
//
// The canonical listing of a Delaunay tetrahedralization, whatever made it. Private to delaunay/.
#pragma once

#include <vector>

#include "delaunay/canonical_delaunay.h"

namespace watertight {

/// More tetrahedra cannot be listed: four faces of each are numbered by an Index.
inline constexpr std::uint64_t kMostTetrahedra = kNone / 4;

/// Brings positively oriented tetrahedra, in any order and from any of their vertices on, into the
/// canonical order, and lists their faces. Requires at most kMostTetrahedra of them, vertices
/// below `vertex_count`, and of each face at most two tetrahedra, on different sides.
/// Cost: linear in both.
CanonicalDelaunay list_canonically(std::vector<Tetrahedron> tetrahedra, Index vertex_count);

}  // namespace watertight
