// SPDX-License-Identifier: GPL-3.0-or-later
//
// The paper's own accounting of a stored solid (Verbree & Si 2008, section 4.2): 96 bits for each
// raw triangle, against 1 bit for each DT face, 96 for each Steiner point and 96 for each
// unrecovered face. Vertices are left out on both sides, as in the paper.
#pragma once

#include <cstdint>
#include <optional>

#include "delaunay/certificate.h"
#include "geometry/solid.h"

namespace watertight {

// The bits of three 32-bit indices or coordinates.
inline constexpr std::uint64_t kIndexTripleBits = 96;

struct Accounting {
  std::uint64_t solids = 0;
  std::uint64_t steiner = 0;
  std::uint64_t triangles = 0;       // the triangles of the stored boundary
  std::uint64_t delaunay_faces = 0;  // the bits of the bitmap
  std::uint64_t unrecovered = 0;

  std::uint64_t bits() const { return delaunay_faces + kIndexTripleBits * (steiner + unrecovered); }
  Accounting& operator+=(const Accounting& other);
};

/// The accounting without Steiner points; each facet takes the triangulation that follows the DT.
/// Nothing if the vertices span no tetrahedron. Requires merged vertices.
std::optional<Accounting> account_following(const Solid& solid);

/// The accounting with all Steiner points of a CDT, whose constrained faces are the boundary (the
/// paper's setting).
std::optional<Accounting> account_certificate(const delaunay::Certificate& certificate);

/// The accounting of the solid with a share of a CDT's Steiner points as further vertices of its
/// rings: every k-th of those on edges, in lexicographic order; `density` is in [0, 1]. It is
/// account_following() of that solid, plus these points.
std::optional<Accounting> account_refined(const Solid& solid,
                                          const delaunay::Certificate& certificate, double density);

}  // namespace watertight
