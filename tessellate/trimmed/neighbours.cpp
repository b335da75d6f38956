// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/trimmed/neighbours.h"

#include <algorithm>
#include <numeric>

namespace watertight::tessellate {

std::vector<std::uint32_t> twins_of(std::span<const Triangle> triangles, std::size_t point_count) {
  const auto edge_count = static_cast<std::uint32_t>(3 * triangles.size());
  const auto smaller_end = [&](std::uint32_t edge) {
    return std::min(start_of(triangles, edge), start_of(triangles, next_edge(edge)));
  };
  std::vector<std::uint32_t> first(point_count + 1, 0);
  for (std::uint32_t edge = 0; edge < edge_count; ++edge) ++first[smaller_end(edge) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> at(first.begin(), first.end() - 1);
  std::vector<std::uint32_t> edges(edge_count);
  std::vector<std::uint32_t> twins(edge_count, kNone);
  for (std::uint32_t edge = 0; edge < edge_count; ++edge) {
    const Index end = smaller_end(edge);
    // The edges of one vertex are few, but for hubs of fans.
    for (std::uint32_t i = first[end]; i < at[end]; ++i) {
      const std::uint32_t other = edges[i];
      if (start_of(triangles, other) != start_of(triangles, next_edge(edge)) ||
          start_of(triangles, next_edge(other)) != start_of(triangles, edge)) {
        continue;
      }
      twins[edge] = other;
      twins[other] = edge;
      edges[i] = edges[--at[end]];
      break;
    }
    if (twins[edge] == kNone) edges[at[end]++] = edge;
  }
  return twins;
}

std::array<Index, 4> quadrangle_at(std::span<const Triangle> triangles, std::uint32_t edge,
                                   std::uint32_t twin) {
  return {start_of(triangles, edge), start_of(triangles, previous_edge(twin)),
          start_of(triangles, twin), start_of(triangles, previous_edge(edge))};
}

void flip(std::span<Triangle> triangles, std::span<std::uint32_t> twins, std::uint32_t edge) {
  const std::uint32_t twin = twins[edge];
  const std::uint32_t before = previous_edge(edge);
  const std::uint32_t twin_before = previous_edge(twin);
  // (a, b, c) becomes (d, b, c), and (b, a, d) becomes (c, a, d).
  start_of(triangles, edge) = start_of(triangles, twin_before);
  start_of(triangles, twin) = start_of(triangles, before);
  const auto join = [&](std::uint32_t one, std::uint32_t other) {
    twins[one] = other;
    if (other != kNone) twins[other] = one;
  };
  join(edge, twins[twin_before]);
  join(twin, twins[before]);
  join(before, twin_before);
}

}  // namespace watertight::tessellate
