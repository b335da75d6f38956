// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checks the faces of facets with three or four vertices at sight. Most facets of buildings are of
// this kind. For the certificate.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "delaunay/tetrahedralization.h"

namespace watertight::delaunay {

struct SmallFaces {
  std::array<Triangle, 2> triangles{};  // turned as the ring
  std::size_t count = 0;
};

/// The faces of a facet that has one ring, of three or four vertices, in the order given, if they
/// are its canonical triangles: one triangle, or two that lack opposite vertices of the ring. Such
/// faces have no other vertices, one edge in common or none, and the ring as their boundary, and
/// they are where the canonical triangles are: nothing is left to check. None for other facets.
/// Requires faces with three different vertices.
SmallFaces small_faces(std::span<const Index> ring, std::span<const Triangle> canonical,
                       std::span<const ConstrainedFace> faces);

}  // namespace watertight::delaunay
