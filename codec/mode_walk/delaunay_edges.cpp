// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_walk/delaunay_edges.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace watertight::codec::walk {

namespace {

/// Lists of items, one list after the other: list i is [first[i], first[i + 1]) of the items.
struct Lists {
  std::vector<Index> first;
  std::vector<Index> items;
};

/// Lists the faces of each vertex: twice each face of which it is the smallest vertex, once each
/// face of which it is the middle one. So each edge of a face is counted at its smaller vertex.
Lists faces_by_smaller_vertex(const std::vector<Triangle>& faces, Index vertex_count) {
  Lists lists{std::vector<Index>(vertex_count + std::size_t{1}, 0), {}};
  for (const Triangle& face : faces) {
    lists.first[face[0] + 1] += 2;
    lists.first[face[1] + 1] += 1;
  }
  for (Index v = 0; v < vertex_count; ++v) lists.first[v + 1] += lists.first[v];
  lists.items.resize(lists.first[vertex_count]);
  std::vector<Index> end(lists.first.begin(), lists.first.end() - 1);
  for (Index i = 0; i < faces.size(); ++i) {
    lists.items[end[faces[i][0]]++] = i;
    lists.items[end[faces[i][0]]++] = i;
    lists.items[end[faces[i][1]]++] = i;
  }
  return lists;
}

}  // namespace

DelaunayEdges::DelaunayEdges(const delaunay::CanonicalDelaunay& delaunay, Index vertex_count) {
  Lists lists = faces_by_smaller_vertex(delaunay.faces, vertex_count);
  const std::vector<Index>& first = lists.first;
  faces_ = std::move(lists.items);

  // By Euler's formula, vertices and faces are one more than edges and tetrahedra.
  const std::size_t edges = vertex_count + delaunay.faces.size() - delaunay.tetrahedra.size();
  first_edge_.reserve(first.size());
  greater_.reserve(edges);
  first_face_.reserve(edges);
  struct Use {
    Index greater;
    Index face;
  };
  std::vector<Use> uses;  // the edges of one vertex with their faces
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
      }
      faces_[first[v] + i] = uses[i].face;
    }
  }
  first_edge_.push_back(static_cast<Index>(greater_.size()));
  first_face_.push_back(static_cast<Index>(faces_.size()));
  turn_edges(vertex_count);
}

void DelaunayEdges::turn_edges(Index vertex_count) {
  first_smaller_.assign(vertex_count + std::size_t{1}, 0);
  for (const Index w : greater_) ++first_smaller_[w + 1];
  for (Index v = 0; v < vertex_count; ++v) first_smaller_[v + 1] += first_smaller_[v];
  std::vector<Index> end(first_smaller_.begin(), first_smaller_.end() - 1);
  smaller_.resize(greater_.size());
  for (Index v = 0; v < vertex_count; ++v) {
    for (const Index w : greater_neighbours(v)) smaller_[end[w]++] = v;
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
