// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/delaunay_edges.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace watertight {

DelaunayEdges::DelaunayEdges(const CanonicalDelaunay& delaunay, Index vertex_count) {
  // Each face under the lesser vertex of each of its edges, with the greater one.
  std::vector<Index> first(vertex_count + std::size_t{1}, 0);
  for (const Triangle& face : delaunay.faces) {
    first[face[0] + 1] += 2;
    first[face[1] + 1] += 1;
  }
  for (Index v = 0; v < vertex_count; ++v) first[v + 1] += first[v];
  struct Use {
    Index greater;
    Index face;
  };
  std::vector<Use> uses(first[vertex_count]);
  std::vector<Index> end(first.begin(), first.end() - 1);
  for (Index i = 0; i < delaunay.faces.size(); ++i) {
    const Triangle& face = delaunay.faces[i];
    uses[end[face[0]]++] = {face[1], i};
    uses[end[face[0]]++] = {face[2], i};
    uses[end[face[1]]++] = {face[2], i};
  }

  first_edge_.reserve(first.size());
  faces_.reserve(uses.size());
  std::vector<Index>& smaller_end = end;  // reused: per vertex the count of smaller neighbours
  std::fill(smaller_end.begin(), smaller_end.end(), 0);
  for (Index v = 0; v < vertex_count; ++v) {
    first_edge_.push_back(static_cast<Index>(greater_.size()));
    const auto begin = uses.begin() + first[v];
    const auto stop = uses.begin() + first[v + 1];
    std::sort(begin, stop, [](const Use& x, const Use& y) {
      return x.greater != y.greater ? x.greater < y.greater : x.face < y.face;
    });
    for (auto use = begin; use != stop; ++use) {
      if (use == begin || use->greater != (use - 1)->greater) {
        first_face_.push_back(static_cast<Index>(faces_.size()));
        greater_.push_back(use->greater);
        ++smaller_end[use->greater];
      }
      faces_.push_back(use->face);
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

}  // namespace watertight
