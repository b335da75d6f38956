// SPDX-License-Identifier: GPL-3.0-or-later
//
// The paper's own accounting of a stored solid (Verbree & Si 2008, section 4.2): 96 bits per raw
// triangle against 1 bit per DT face, 96 per Steiner point and 96 per unrecovered face. Vertices
// are left out on both sides, as the paper does.
#pragma once

#include <cstdint>
#include <optional>

#include "delaunay/certificate.h"
#include "geometry/solid.h"

namespace watertight {

inline constexpr std::uint64_t kIndexTripleBits = 96;  // three 32-bit indices or coordinates

struct Accounting {
  std::uint64_t solids = 0;
  std::uint64_t steiner = 0;
  std::uint64_t triangles = 0;       // of the boundary as stored
  std::uint64_t delaunay_faces = 0;  // bits of the bitmap
  std::uint64_t unrecovered = 0;

  std::uint64_t bits() const { return delaunay_faces + kIndexTripleBits * (steiner + unrecovered); }
  Accounting& operator+=(const Accounting& other);
};

/// No Steiner points; each facet takes the triangulation that follows the DT.
/// Nothing if the vertices span no tetrahedron. Requires merged vertices.
std::optional<Accounting> account_following(const Solid& solid);

/// All Steiner points of a CDT, its constrained faces as the boundary (the paper's setting).
std::optional<Accounting> account_certificate(const delaunay::Certificate& certificate);

/// The solid with a share of a CDT's Steiner points put into its ring edges, as further ring
/// vertices: every k-th of those on edges, in lexicographic order. `density` in [0, 1]. Then
/// account_following() of it plus these points.
std::optional<Accounting> account_refined(const Solid& solid,
                                          const delaunay::Certificate& certificate, double density);

}  // namespace watertight
