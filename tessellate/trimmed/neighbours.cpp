// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/trimmed/neighbours.h"

#include <algorithm>
#include <memory_resource>
#include <numeric>

#include "tessellate/trimmed/work_memory.h"

namespace watertight::tessellate {

std::vector<std::uint32_t> twins_of(std::span<const Triangle> triangles, std::size_t point_count) {
  struct OpenEdge {
    std::uint32_t edge;
    Index from;
    Index to;
  };
  WorkMemory memory;
  // The edges without a twin so far, by their smaller end: those of vertex i from first[i] on.
  std::pmr::vector<std::uint32_t> first(point_count + 2, 0, memory.get());
  for (const auto& [a, b, c] : triangles) {
    ++first[std::min(a, b) + 2];
    ++first[std::min(b, c) + 2];
    ++first[std::min(c, a) + 2];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  const std::span<std::uint32_t> end(first.begin() + 1, first.end());  // grows to the next first
  std::pmr::vector<OpenEdge> open(3 * triangles.size(), memory.get());
  std::pmr::vector<std::uint32_t> begin(first.begin() + 1, first.end(), memory.get());
  std::vector<std::uint32_t> twins(3 * triangles.size(), kNone);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Index from = triangles[t][k];
      const Index to = triangles[t][k == 2 ? 0 : k + 1];
      const Index low = std::min(from, to);
      // The edges of one vertex are few, but for hubs of fans.
      const auto here = std::span(open).subspan(begin[low], end[low] - begin[low]);
      const auto other = std::find_if(here.begin(), here.end(), [&](const OpenEdge& edge) {
        return edge.from == to && edge.to == from;
      });
      if (other == here.end()) {
        open[end[low]++] = {3 * t + k, from, to};
        continue;
      }
      twins[3 * t + k] = other->edge;
      twins[other->edge] = 3 * t + k;
      *other = open[--end[low]];
    }
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
