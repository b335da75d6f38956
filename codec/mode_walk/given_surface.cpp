// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_walk/given_surface.h"

#include <algorithm>
#include <utility>

#include "codec/mode_walk/walk.h"
#include "geometry/mesh/edge_sides.h"
#include "geometry/mesh/fans.h"
#include "geometry/mesh/half_edges.h"

namespace watertight::codec::walk {

bool GivenSurface::take(BoundaryMesh& mesh, Index vertex_count) {
  triangles_ = std::move(mesh.triangles);
  twin_.clear();
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

  for (std::size_t c = 0; c + 1 < mesh.component_first.size(); ++c) {
    const Index first = mesh.component_first[c];
    const auto sides = geometry::sides_of_triangles(triangles_, first, mesh.component_first[c + 1]);
    const auto is_again = [](const geometry::EdgeSide& a, const geometry::EdgeSide& b) {
      return a.has_edge_of(b) && a.is_downward == b.is_downward;
    };
    if (std::adjacent_find(sides.begin(), sides.end(), is_again) != sides.end()) return false;
    const auto twins = geometry::paired(sides, 3 * first);
    if (!twins) return false;
    twin_.insert(twin_.end(), twins->begin(), twins->end());
  }
  if (twin_.size() != half_edge_count) return false;  // a triangle is in no component
  is_used_.assign(triangles_.size(), false);
  return true;
}

bool GivenSurface::is_manifold() const {
  return geometry::number_fans(twin_, geometry::previous_half_edge).first.size() + 1 ==
         first_.size();
}

Index GivenSurface::find_unused(const Triangle& triangle) const {
  const Index v = triangle[0];
  for (Index i = first_[v]; i < first_[v + 1]; ++i) {
    const Index h = half_edges_[i];
    if (to(h) == triangle[1] && corner(h) == triangle[2] && !is_used_[h / 3]) return h;
  }
  return kNone;
}

Index GivenSurface::any_unused_at(Index vertex) const {
  for (Index i = first_[vertex]; i < first_[vertex + 1]; ++i) {
    if (!is_used_[half_edges_[i] / 3]) return half_edges_[i];
  }
  return kNone;
}

Index GivenSurface::unused_vertex() const {
  Index least = kNone;
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (is_used_[t]) continue;
    for (const Index v : triangles_[t]) least = std::min(least, v);
  }
  return least;
}

}  // namespace watertight::codec::walk
