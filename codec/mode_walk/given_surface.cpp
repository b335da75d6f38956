// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_walk/given_surface.h"

#include <algorithm>
#include <utility>

#include "codec/mode_walk/walk.h"

namespace watertight::codec::walk {

bool WalkTruth::take(BoundaryMesh& mesh, Index vertex_count) {
  triangles_ = std::move(mesh.triangles);
  const auto half_edge_count = static_cast<Index>(3 * triangles_.size());
  first_.assign(vertex_count + std::size_t{1}, 0);
  for (const Triangle& t : triangles_) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
    for (const Index v : t) {
      if (v >= vertex_count) return false;
      ++first_[v + 1];
    }
  }
  for (Index v = 0; v < vertex_count; ++v) {
    if (first_[v + 1] == 0) return false;
    first_[v + 1] += first_[v];
  }
  half_edges_.resize(half_edge_count);
  std::vector<Index> end(first_.begin(), first_.end() - 1);
  for (Index h = 0; h < half_edge_count; ++h) half_edges_[end[from(h)]++] = h;
  for (Index v = 0; v < vertex_count; ++v) {
    std::sort(half_edges_.begin() + first_[v], half_edges_.begin() + first_[v + 1],
              [&](Index g, Index h) { return to(g) != to(h) ? to(g) < to(h) : g < h; });
  }

  // Components given are ranges of half-edges, so twins of a component lie in its range.
  twin_.assign(half_edge_count, kNone);
  for (std::size_t c = 0; c + 1 < mesh.component_first.size(); ++c) {
    const Index begin = 3 * mesh.component_first[c];
    const Index stop = 3 * mesh.component_first[c + 1];
    for (Index h = begin; h < stop; ++h) {
      const auto place = std::lower_bound(
          half_edges_.begin() + first_[to(h)], half_edges_.begin() + first_[to(h) + 1], h,
          [&](Index g, Index) { return to(g) != from(h) ? to(g) < from(h) : g < begin; });
      if (place == half_edges_.begin() + first_[to(h) + 1] || to(*place) != from(h) ||
          *place >= stop) {
        return false;
      }
      twin_[h] = *place;
    }
  }
  for (Index h = 0; h < half_edge_count; ++h) {
    if (twin_[h] == kNone || twin_[twin_[h]] != h) return false;  // kNone: in no component
  }
  is_used_.assign(triangles_.size(), false);
  return true;
}

bool WalkTruth::is_manifold() const {
  for (Index v = 0; v + 1 < first_.size(); ++v) {
    const Index start = half_edges_[first_[v]];
    Index h = start;
    Index fan = 0;
    do {
      h = twin_of(turned(h, 2));
      ++fan;
    } while (h != start);
    if (fan != first_[v + 1] - first_[v]) return false;
  }
  return true;
}

Index WalkTruth::find_unused(const Triangle& triangle) const {
  const Index v = triangle[0];
  for (Index i = first_[v]; i < first_[v + 1]; ++i) {
    const Index h = half_edges_[i];
    if (to(h) == triangle[1] && corner(h) == triangle[2] && !is_used_[h / 3]) return h;
  }
  return kNone;
}

Index WalkTruth::any_unused_at(Index vertex) const {
  for (Index i = first_[vertex]; i < first_[vertex + 1]; ++i) {
    if (!is_used_[half_edges_[i] / 3]) return half_edges_[i];
  }
  return kNone;
}

Index WalkTruth::unused_vertex() const {
  Index least = kNone;
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (is_used_[t]) continue;
    for (const Index v : triangles_[t]) least = std::min(least, v);
  }
  return least;
}

}  // namespace watertight::codec::walk
