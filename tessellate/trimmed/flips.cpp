// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>

#include "base/work_memory.h"
#include "tessellate/trimmed/neighbours.h"
#include "tessellate/trimmed/plane_predicates.h"
#include "tessellate/trimmed/region.h"

namespace watertight::tessellate {
namespace {

constexpr std::size_t kMostFlips = 256;  // for each triangle

bool is_first(const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

}  // namespace

bool is_delaunay(std::span<const Point> points, const std::array<Index, 4>& quadrangle) {
  const auto [a, b, c, d] = quadrangle;
  const int side = side_of_circle(points[a], points[b], points[c], points[d]);
  if (side != 0) return side < 0;
  // The diagonal ac stays if it has the first of the four points.
  const auto before = [&](Index p, Index q) { return is_first(points[p], points[q]); };
  return before(a, b) ? (before(a, d) || before(c, d)) : (before(c, b) && before(c, d));
}

void restore_delaunay(std::span<const Point> points, std::span<Triangle> triangles,
                      std::span<std::uint32_t> twins, std::span<const std::uint32_t> edges) {
  WorkMemory memory;
  std::pmr::vector<std::uint32_t> waiting(memory.get());
  waiting.reserve(edges.size());
  std::pmr::vector<std::uint8_t> waits(twins.size(), 0, memory.get());
  const auto wait_for = [&](std::uint32_t edge) {
    if (twins[edge] == kNone || waits[edge] != 0 || waits[twins[edge]] != 0) return;
    waiting.push_back(edge);
    waits[edge] = 1;
  };
  for (const std::uint32_t edge : edges) wait_for(edge);
  const std::size_t most = kMostFlips * triangles.size();
  for (std::size_t flips = 0; !waiting.empty() && flips < most;) {
    const std::uint32_t edge = waiting.back();
    waiting.pop_back();
    waits[edge] = 0;
    const std::uint32_t twin = twins[edge];
    if (is_delaunay(points, quadrangle_at(triangles, edge, twin))) continue;
    flip(triangles, twins, edge);
    ++flips;
    for (const std::uint32_t side : {edge, next_edge(edge), twin, next_edge(twin)}) wait_for(side);
  }
}

void flip_to_delaunay(std::span<const Point> points, std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> twins = twins_of(triangles, points.size());
  WorkMemory memory;
  std::pmr::vector<std::uint32_t> waiting(memory.get());
  waiting.reserve(twins.size() / 2);
  for (std::uint32_t edge = 0; edge < twins.size(); ++edge) {
    if (twins[edge] != kNone && twins[edge] > edge) waiting.push_back(edge);
  }
  restore_delaunay(points, triangles, twins, waiting);
}

}  // namespace watertight::tessellate
