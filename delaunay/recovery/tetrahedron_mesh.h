// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tetrahedra with their neighbours, in which a few tetrahedra can be replaced by others. Private to
// delaunay/.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "delaunay/canonical/sort_by_vertices.h"
#include "geometry/point.h"

namespace watertight::delaunay {

/// True if a triangle or a tetrahedron has a vertex. Compares all of its vertices, without a
/// branch.
template <std::size_t N>
bool has_vertex(const std::array<Index, N>& vertices, Index vertex) {
  bool is_found = false;
  for (const Index other : vertices) is_found |= other == vertex;
  return is_found;
}
/// The face of a positive tetrahedron opposite to a corner, turned so that orient3d(face, corner)
/// is positive.
inline Triangle inward_face(const geometry::Tetrahedron& t, std::size_t corner) {
  constexpr std::array<std::array<std::size_t, 3>, 4> kFaces = {
      {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};
  const auto& [a, b, c] = kFaces[corner];
  return {t[a], t[b], t[c]};
}
/// A triangle with its smallest vertex first, its orientation kept.
inline Triangle rotated(const Triangle& t) {
  if (t[1] < t[0] && t[1] < t[2]) return {t[1], t[2], t[0]};
  if (t[2] < t[0] && t[2] < t[1]) return {t[2], t[0], t[1]};
  return t;
}
inline Triangle reversed(const Triangle& t) { return {t[0], t[2], t[1]}; }

/// Two vertices, the smaller one first.
using VertexPair = std::array<Index, 2>;
inline VertexPair pair_of(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }
/// The edges of a triangle with its vertices in increasing order.
inline std::array<VertexPair, 3> edges_of(const Triangle& sorted) {
  return {{{sorted[0], sorted[1]}, {sorted[0], sorted[2]}, {sorted[1], sorted[2]}}};
}

class TetrahedronMesh {
 public:
  /// Requires positive tetrahedra, at most two at each face, with vertices below `vertex_count`.
  /// Cost: O(n log n).
  TetrahedronMesh(std::vector<geometry::Tetrahedron> tetrahedra, std::size_t vertex_count);

  const geometry::Tetrahedron& tetrahedron(Index t) const { return tetrahedra_[t]; }
  /// The tetrahedron beyond the face opposite to a corner; kNone at the hull.
  Index neighbour(Index t, std::size_t corner) const { return neighbours_[t][corner]; }
  /// A tetrahedron at a vertex; kNone if there is none.
  Index at_vertex(Index vertex) const { return at_vertex_[vertex]; }
  /// The number of places, some of which are empty after replacements.
  std::size_t places() const { return tetrahedra_.size(); }

  /// Replaces tetrahedra by others that fill the same place: the faces around both sets are equal.
  void replace(std::span<const Index> old_ones, std::span<const geometry::Tetrahedron> new_ones);

  /// All tetrahedra. The mesh is empty afterwards.
  std::vector<geometry::Tetrahedron> take();

 private:
  struct Half {
    Triangle vertices{};  // sorted
    Index tetrahedron = kNone;
    Index corner = 0;
  };
  void add_halves(Index t, std::vector<Half>& halves) const;
  void pair(std::span<const Half> sorted_halves);

  std::vector<geometry::Tetrahedron> tetrahedra_;  // [0] == [1] for an empty place
  std::vector<std::array<Index, 4>> neighbours_;
  std::vector<Index> at_vertex_;
  std::vector<Index> empty_;
  std::vector<Half> halves_;  // of one replacement
};

/// The corners of tetrahedra of a mesh, one after the other.
std::vector<Index> corners_of(const TetrahedronMesh& mesh, std::span<const Index> tetrahedra);

}  // namespace watertight::delaunay
