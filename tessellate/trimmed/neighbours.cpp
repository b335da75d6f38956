// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/trimmed/neighbours.h"

#include <algorithm>
#include <memory_resource>
#include <numeric>

#include "base/work_memory.h"

namespace watertight::tessellate {

namespace {

/// opposites_of() for edges that a function gives by their number.
template <class EdgeAt>
std::vector<std::uint32_t> pair_edges(std::uint32_t count, std::size_t point_count,
                                      const EdgeAt& edge_at) {
  struct OpenEdge {
    std::uint32_t edge;
    Index from;
    Index to;
  };
  WorkMemory memory;
  // The edges without an opposite one so far, by their smaller end: those of a point begin at
  // first[point] and end before end[point], which grows.
  std::pmr::vector<std::uint32_t> first(point_count + 1, 0, memory.get());
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto [from, to] = edge_at(i);
    ++first[std::min(from, to) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::pmr::vector<std::uint32_t> end(first.begin(), first.end() - 1, memory.get());
  std::pmr::vector<OpenEdge> open(count, memory.get());
  std::vector<std::uint32_t> opposites(count, kNone);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto [from, to] = edge_at(i);
    const Index low = std::min(from, to);
    // The edges of one point are few, but for hubs of fans.
    std::uint32_t at = first[low];
    while (at < end[low] && (open[at].from != to || open[at].to != from)) ++at;
    if (at == end[low]) {
      open[end[low]++] = {i, from, to};
      continue;
    }
    opposites[i] = open[at].edge;
    opposites[open[at].edge] = i;
    open[at] = open[--end[low]];
  }
  return opposites;
}

}  // namespace

std::vector<std::uint32_t> opposites_of(std::span<const PlaneEdge> edges, std::size_t point_count) {
  return pair_edges(static_cast<std::uint32_t>(edges.size()), point_count,
                    [&](std::uint32_t i) { return edges[i]; });
}

std::vector<std::uint32_t> twins_of(std::span<const Triangle> triangles, std::size_t point_count) {
  return pair_edges(static_cast<std::uint32_t>(3 * triangles.size()), point_count,
                    [&](std::uint32_t edge) {
                      const std::uint32_t side = edge % 3;
                      const Triangle& triangle = triangles[edge / 3];
                      return PlaneEdge{triangle[side], triangle[side == 2 ? 0 : side + 1]};
                    });
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
