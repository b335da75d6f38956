// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_walk/delaunay_edges.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace watertight::codec::walk {

DelaunayEdges::DelaunayEdges(const delaunay::CanonicalDelaunay& delaunay, Index vertex_count) {
  // Each face under the lesser vertex of each of its edges.
  std::vector<Index> first(vertex_count + std::size_t{1}, 0);
  for (const Triangle& face : delaunay.faces) {
    first[face[0] + 1] += 2;
    first[face[1] + 1] += 1;
  }
  for (Index v = 0; v < vertex_count; ++v) first[v + 1] += first[v];
  faces_.resize(first[vertex_count]);
  std::vector<Index> end(first.begin(), first.end() - 1);
  for (Index i = 0; i < delaunay.faces.size(); ++i) {
    const Triangle& face = delaunay.faces[i];
    faces_[end[face[0]]++] = i;
    faces_[end[face[0]]++] = i;
    faces_[end[face[1]]++] = i;
  }

  // Vertices and faces are one more than edges and tetrahedra (Euler).
  const std::size_t edges = vertex_count + delaunay.faces.size() - delaunay.tetrahedra.size();
  first_edge_.reserve(first.size());
  greater_.reserve(edges);
  first_face_.reserve(edges);
  struct Use {
    Index greater;
    Index face;
  };
  std::vector<Use> uses;                  // of one vertex: its edges with their faces
  std::vector<Index>& smaller_end = end;  // reused: per vertex the count of smaller neighbours
  std::fill(smaller_end.begin(), smaller_end.end(), 0);
  for (Index v = 0; v < vertex_count; ++v) {
    first_edge_.push_back(static_cast<Index>(greater_.size()));
    uses.clear();
    for (Index at = first[v]; at < first[v + 1]; ++at) {
      const Triangle& face = delaunay.faces[faces_[at]];
      if (face[0] == v) uses.push_back({face[1], faces_[at++]});
      uses.push_back({face[2], faces_[at]});
    }
    std::sort(uses.begin(), uses.end(), [](const Use& x, const Use& y) {
      return x.greater != y.greater ? x.greater < y.greater : x.face < y.face;
    });
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (i == 0 || uses[i].greater != uses[i - 1].greater) {
        first_face_.push_back(first[v] + static_cast<Index>(i));
        greater_.push_back(uses[i].greater);
        ++smaller_end[uses[i].greater];
      }
      faces_[first[v] + i] = uses[i].face;
    }
  }
  first_edge_.push_back(static_cast<Index>(greater_.size()));
  first_face_.push_back(static_cast<Index>(faces_.size()));

  first_smaller_.assign(vertex_count + std::size_t{1}, 0);
  for (Index v = 0; v < vertex_count; ++v) {
    first_smaller_[v + 1] = first_smaller_[v] + smaller_end[v];
    smaller_end[v] = first_smaller_[v];
  }
  smaller_.resize(greater_.size());
  for (Index v = 0; v < vertex_count; ++v) {
    for (const Index w : greater_neighbours(v)) smaller_[smaller_end[w]++] = v;
  }
}

std::span<const Index> DelaunayEdges::faces_at(Index a, Index b) const {
  if (a > b) std::swap(a, b);
  const auto greater = greater_neighbours(a);
  const auto found = std::lower_bound(greater.begin(), greater.end(), b);
  if (found == greater.end() || *found != b) return {};
  const std::size_t edge = first_edge_[a] + static_cast<std::size_t>(found - greater.begin());
  return std::span(faces_).subspan(first_face_[edge], first_face_[edge + 1] - first_face_[edge]);
}

}  // namespace watertight::codec::walk
