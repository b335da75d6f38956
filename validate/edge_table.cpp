// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/edge_table.h"

namespace watertight {

std::vector<EdgeUse> edge_uses(const Solid& solid, Index shell) {
  std::vector<EdgeUse> uses;
  const IndexRange facets = solid.facets_of(shell);
  for (Index facet = facets.begin; facet < facets.end; ++facet) {
    const IndexRange rings = solid.rings_of(facet);
    for (Index r = rings.begin; r < rings.end; ++r) {
      const std::span<const Index> ring = solid.ring(r);
      if (ring.size() < 3) continue;  // bounds nothing
      const Index base = solid.arrays().ring_offsets[r];
      for (Index i = 0; i < ring.size(); ++i) {
        const auto next = static_cast<Index>((i + 1) % ring.size());
        const Index from = ring[i];
        const Index to = ring[next];
        if (from == to) continue;
        uses.push_back({std::min(from, to), std::max(from, to), from < to, facet, r - rings.begin,
                        i, base + i, base + next});
      }
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
  });
  return uses;
}

}  // namespace watertight
