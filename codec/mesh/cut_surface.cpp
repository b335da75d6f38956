// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>

#include "codec/mesh/cut_surface.h"

namespace watertight::codec {
namespace {

Index next_half_edge(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }

/// The representative of the set of triangles that holds triangle `t`; shortens the paths to it.
Index root_of(std::vector<Index>& parent, Index t) {
  while (parent[t] != t) t = parent[t] = parent[parent[t]];
  return t;
}

/// Pairs the half-edges of the triangles from `begin` on. Where more than two meet in one edge, two
/// pair up if their triangles are also connected across other edges. So bodies that touch along an
/// edge are separated.
Status pair_half_edges(CutSurface& surface, Index begin) {
  struct Side {
    Index low, high;
    bool is_downward;
    Index half_edge;
    Index part = 0;
  };
  std::vector<Side> sides;
  const auto end = static_cast<Index>(surface.triangles.size());
  for (Index h = 3 * begin; h < 3 * end; ++h) {
    const Index from = surface.triangles[h / 3][h % 3];
    const Index to = surface.triangles[h / 3][next_half_edge(h) % 3];
    sides.push_back({std::min(from, to), std::max(from, to), from > to, h, 0});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    if (a.is_downward != b.is_downward) return b.is_downward;
    return a.half_edge < b.half_edge;
  });
  const auto has_edge_of = [&](std::size_t a, std::size_t b) {
    return b < sides.size() && sides[a].low == sides[b].low && sides[a].high == sides[b].high;
  };
  std::vector<Index> parent(end);
  std::iota(parent.begin(), parent.end(), Index{0});
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t after = i + 1;
    while (has_edge_of(i, after)) ++after;
    if (after == i + 2) {
      parent[root_of(parent, sides[i].half_edge / 3)] = root_of(parent, sides[i + 1].half_edge / 3);
    }
    i = after;
  }
  for (Side& side : sides) side.part = root_of(parent, side.half_edge / 3);
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t after = i + 1;
    while (has_edge_of(i, after)) ++after;
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(i),
              sides.begin() + static_cast<std::ptrdiff_t>(after), [](const Side& a, const Side& b) {
                if (a.is_downward != b.is_downward) return b.is_downward;
                return a.part != b.part ? a.part < b.part : a.half_edge < b.half_edge;
              });
    i = after;
  }
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t upward = 0;
    std::size_t size = 0;
    for (; has_edge_of(i, i + size); ++size) {
      upward += sides[i + size].is_downward ? 0 : 1;
    }
    if (size != 2 * upward || sides[i].low == sides[i].high) {
      return Error{ErrorCode::not_encodable, "the surface of a shell is not closed"};
    }
    for (std::size_t k = 0; k < upward; ++k) {
      const Index up = sides[i + k].half_edge;
      const Index down = sides[i + upward + k].half_edge;
      surface.twin[up] = down;
      surface.twin[down] = up;
    }
    i += size;
  }
  return Done{};
}

/// Gives each fan of triangles around a vertex a vertex of its own.
void cut_fans(CutSurface& surface, const std::vector<GridPoint>& vertices) {
  const auto half_edges = static_cast<Index>(surface.twin.size());
  std::vector<Index> fan(half_edges, kNone);  // of the vertex where a half-edge begins
  for (Index first = 0; first < half_edges; ++first) {
    if (fan[first] != kNone) continue;
    const auto number = static_cast<Index>(surface.positions.size());
    surface.positions.push_back(vertices[surface.triangles[first / 3][first % 3]]);
    for (Index h = first; fan[h] == kNone; h = next_half_edge(surface.twin[h])) fan[h] = number;
  }
  for (Index h = 0; h < half_edges; ++h) surface.triangles[h / 3][h % 3] = fan[h];
}

void find_components(CutSurface& surface, const std::vector<Index>& shell_of) {
  std::vector<bool> is_seen(surface.triangles.size(), false);
  std::vector<Index> stack;
  for (Index first = 0; first < surface.triangles.size(); ++first) {
    if (is_seen[first]) continue;
    surface.is_new_shell.push_back(surface.component_first.empty() ||
                                   shell_of[first] != shell_of[surface.component_first.back()]);
    surface.component_first.push_back(first);
    stack.push_back(first);
    is_seen[first] = true;
    while (!stack.empty()) {
      const Index t = stack.back();
      stack.pop_back();
      for (Index k = 0; k < 3; ++k) {
        const Index beside = surface.twin[3 * t + k] / 3;
        if (is_seen[beside]) continue;
        is_seen[beside] = true;
        stack.push_back(beside);
      }
    }
  }
}

}  // namespace

Result<CutSurface> cut_surface(const IntegerSolid& solid) {
  CutSurface surface;
  std::vector<Index> shell_of;
  surface.twin.resize(solid.ring_vertices.size());
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const auto begin = static_cast<Index>(surface.triangles.size());
    for (Index facet = solid.shell_offsets[shell]; facet < solid.shell_offsets[shell + 1];
         ++facet) {
      const Index ring = solid.facet_offsets[facet];
      if (solid.facet_offsets[facet + 1] != ring + 1 || solid.ring(ring).size() != 3) {
        return Error{ErrorCode::not_encodable,
                     "mode parallelogram codes triangles only: a facet is not a triangle"};
      }
      const auto corners = solid.ring(ring);
      surface.triangles.push_back({corners[0], corners[1], corners[2]});
      shell_of.push_back(shell);
    }
    if (const Status paired = pair_half_edges(surface, begin); !paired) return paired.error();
  }
  cut_fans(surface, solid.vertices);
  find_components(surface, shell_of);
  return surface;
}

}  // namespace watertight::codec
