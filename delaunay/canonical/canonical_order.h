// SPDX-License-Identifier: GPL-3.0-or-later
//
// The canonical listing of a Delaunay tetrahedralization, whatever made it. Private to delaunay/.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "delaunay/canonical_delaunay.h"

namespace watertight::delaunay {

/// A face with its vertices in increasing order, and the apexes as CanonicalDelaunay has them.
struct ListedFace {
  Triangle vertices{};
  std::array<Index, 2> apexes{kNone, kNone};
};

/// The face of a positively oriented tetrahedron that lies opposite to `corner`; `beyond` is the
/// apex on its other side, kNone on the hull.
ListedFace face_opposite(const geometry::Tetrahedron& tetrahedron, std::size_t corner,
                         Index beyond);

/// Lists positively oriented tetrahedra and all their faces, each once, in canonical order: the
/// result does not depend on the order of the lists or on the vertex from which a tetrahedron
/// starts. Vertices are below `vertex_count`. Cost: O(n log n), linear if no vertex is the smallest
/// of very many.
CanonicalDelaunay list_canonically(std::vector<geometry::Tetrahedron> tetrahedra,
                                   std::vector<ListedFace> faces, Index vertex_count);

}  // namespace watertight::delaunay
