// SPDX-License-Identifier: GPL-3.0-or-later
//
// The combinatorial complex behind a list of tetrahedra: its faces with the tetrahedra on both
// sides, and the exact checks that it is embedded and convex. For the certificate.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "delaunay/tetrahedralization.h"

namespace watertight::delaunay {

/// A face with its vertices sorted. `above` is the tetrahedron on the side to which the normal
/// (b-a) x (c-a) of the sorted triple (a, b, c) points, `below` the one on the other side; kNone
/// outside the hull.
struct ComplexFace {
  Triangle vertices{};
  Index above = kNone;
  Index below = kNone;
  bool is_hull() const { return above == kNone || below == kNone; }
};

/// The faces in lexicographic order of their sorted vertices.
struct Complex {
  std::vector<ComplexFace> faces;
  std::vector<Index> first;  // vertex -> the first face whose smallest vertex is not below it
  /// Index of the face with these vertices (in any order), or kNone.
  /// Cost: logarithmic in the faces with its smallest vertex.
  Index find(Triangle vertices) const;
};

/// The reason why a list of tetrahedra is no embedded complex.
struct ComplexFault {
  enum class Kind : std::uint8_t { not_a_complex, not_convex } kind = Kind::not_a_complex;
  std::string detail;
};

/// Builds the complex. Requires indices in range. Returns a fault unless every tetrahedron is
/// positively oriented (exactly) and every face has at most one tetrahedron on each side.
std::optional<ComplexFault> build_complex(const Tetrahedralization& tetrahedralization,
                                          Complex& complex);

/// Exact proof that positively oriented, properly paired tetrahedra fill a convex body once:
/// the hull faces form a cycle; all of them face away from one point o; a ray from o meets exactly
/// one of them, so their radial projections tile the sphere (the degree of a cycle's projection is
/// constant) and the number of tetrahedra at each point, which is the winding number of the hull,
/// is 1 inside and 0 outside; and the hull is locally convex at each of its edges.
/// Source: after Mehlhorn et al., "Checking geometric programs or verification of geometric
/// structures" (1999), section 2. Departures: the star-shaped argument replaces theirs, so that
/// coplanar hull faces need no special case. Cost: O(h log h) in hull faces.
std::optional<ComplexFault> check_convex(const Tetrahedralization& tetrahedralization,
                                         const Complex& complex);

}  // namespace watertight::delaunay
