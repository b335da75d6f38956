// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/edge_sides.h"

#include <algorithm>

#include "geometry/mesh/half_edges.h"

namespace watertight::geometry {
namespace {

EdgeSide side_of(Index half_edge, Index from, Index to) {
  return {std::min(from, to), std::max(from, to), from > to, half_edge};
}

}  // namespace

std::vector<EdgeSide> sides_of_triangles(std::span<const Triangle> triangles, Index first,
                                         Index last) {
  std::vector<EdgeSide> sides;
  sides.reserve(3 * std::size_t{last - first});
  for (Index h = 3 * first; h < 3 * last; ++h) {
    sides.push_back(side_of(h, start_of(triangles, h), end_of(triangles, h)));
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

std::vector<EdgeSide> sides_of_rings(std::span<const Index> ring_vertices,
                                     std::span<const Index> ring_offsets, Index first, Index last) {
  std::vector<EdgeSide> sides;
  sides.reserve(ring_offsets[last] - ring_offsets[first]);
  for (Index ring = first; ring < last; ++ring) {
    const Index begin = ring_offsets[ring];
    const Index end = ring_offsets[ring + 1];
    for (Index h = begin; h < end; ++h) {
      sides.push_back(side_of(h, ring_vertices[h], ring_vertices[h + 1 == end ? begin : h + 1]));
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

std::size_t upward_count(std::span<const EdgeSide> edge) {
  const auto middle =
      std::find_if(edge.begin(), edge.end(), [](const EdgeSide& side) { return side.is_downward; });
  return static_cast<std::size_t>(middle - edge.begin());
}

std::optional<std::vector<Index>> paired(std::span<const EdgeSide> sides, Index first_half_edge) {
  std::vector<Index> twin(sides.size());
  bool is_closed = true;
  for_each_edge(sides, [&](std::span<const EdgeSide> edge) {
    const std::size_t upward = upward_count(edge);
    is_closed = is_closed && 2 * upward == edge.size();
    for (std::size_t i = 0; is_closed && i < upward; ++i) {
      const Index up = edge[i].half_edge;
      const Index down = edge[upward + i].half_edge;
      twin[up - first_half_edge] = down;
      twin[down - first_half_edge] = up;
    }
  });
  if (!is_closed) return std::nullopt;
  return twin;
}

}  // namespace watertight::geometry
