// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/closure.h"

#include <span>
#include <vector>

#include "geometry/disjoint_sets.h"
#include "geometry/mesh/edge_sides.h"

namespace watertight::geometry {

Closure closure_of(const Solid& solid) {
  const Solid merged = merge_equal_vertices(solid).solid;
  const SolidArrays& arrays = merged.arrays();
  std::vector<Index> facet_of;  // by half-edge
  facet_of.reserve(arrays.ring_vertices.size());
  for (Index facet = 0; facet < merged.facet_count(); ++facet) {
    const IndexRange rings = merged.rings_of(facet);
    facet_of.resize(arrays.ring_offsets[rings.end], facet);
  }
  const std::vector<EdgeSide> sides =
      sides_of_rings(arrays.ring_vertices, arrays.ring_offsets, 0, merged.ring_count());
  Closure closure;
  std::size_t edges = 0;
  DisjointSets connected(merged.facet_count());
  for_each_edge(std::span<const EdgeSide>(sides), [&](std::span<const EdgeSide> edge) {
    if (edge.front().low == edge.front().high) return;
    ++edges;
    if (edge.size() != 2) ++closure.open_edges;
    for (const EdgeSide& side : edge.subspan(1)) {
      connected.join(facet_of[edge.front().half_edge], facet_of[side.half_edge]);
    }
  });
  closure.parts = connected.numbered().first.size();
  closure.is_closed = edges > 0 && closure.open_edges == 0;
  return closure;
}

}  // namespace watertight::geometry
