// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/overlap/wedges.h"

#include <algorithm>
#include <tuple>

namespace watertight::validate {
namespace {

/// A corner with the vertices before and after it in its ring.
struct Passage {
  Index vertex, before, after, corner;
};

/// The passages at all vertices that the facet's rings pass more than once, sorted by vertex.
std::vector<Passage> shared_passages(const Solid& solid, Index facet) {
  std::vector<Passage> list;
  const IndexRange rings = solid.rings_of(facet);
  for (Index r = rings.begin; r < rings.end; ++r) {
    const std::span<const Index> ring = solid.ring(r);
    const Index first = solid.arrays().ring_offsets[r];
    for (std::size_t i = 0; i < ring.size(); ++i) {
      list.push_back({ring[i], ring[(i + ring.size() - 1) % ring.size()],
                      ring[(i + 1) % ring.size()], first + static_cast<Index>(i)});
    }
  }
  std::sort(list.begin(), list.end(), [](const Passage& a, const Passage& b) {
    return std::tie(a.vertex, a.corner) < std::tie(b.vertex, b.corner);
  });
  std::vector<Passage> shared;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const bool is_shared = (i > 0 && list[i - 1].vertex == list[i].vertex) ||
                           (i + 1 < list.size() && list[i + 1].vertex == list[i].vertex);
    if (is_shared) shared.push_back(list[i]);
  }
  return shared;
}

/// A triangle seen from one of its corners: the inside lies counter-clockwise from the edge to
/// `right` to the edge to `left`.
struct Sector {
  Index vertex, right, left;
  friend auto operator<=>(const Sector&, const Sector&) = default;
};

}  // namespace

std::vector<Wedge> shared_wedges(const Solid& solid, const tessellate::FacetTriangles& facets,
                                 Index facet) {
  if (solid.rings_of(facet).size() < 2 ||
      facets.state[facet] != tessellate::FacetState::triangulated)
    return {};
  const std::vector<Passage> passages = shared_passages(solid, facet);
  if (passages.empty()) return {};
  std::vector<Sector> sectors;
  for (Index t = facets.first[facet]; t < facets.first[facet + 1]; ++t) {
    const Triangle& triangle = facets.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      sectors.push_back({triangle[i], triangle[(i + 1) % 3], triangle[(i + 2) % 3]});
    }
  }
  std::sort(sectors.begin(), sectors.end());
  std::vector<std::tuple<Index, Index, Index>>
      arrivals;  // vertex, the vertex before it in its ring, corner
  for (const Passage& passage : passages) {
    arrivals.emplace_back(passage.vertex, passage.before, passage.corner);
  }
  std::sort(arrivals.begin(), arrivals.end());
  std::vector<Wedge> wedges;
  for (const Passage& start : passages) {
    // Goes through the triangles counter-clockwise around the vertex up to the next ring edge.
    Index edge = start.after;
    Index end = kNone;
    for (std::size_t steps = 0; end == kNone && steps <= sectors.size(); ++steps) {
      const auto next =
          std::lower_bound(sectors.begin(), sectors.end(), Sector{start.vertex, edge, Index{0}});
      if (next == sectors.end() || next->vertex != start.vertex || next->right != edge) break;
      edge = next->left;
      const auto arrival = std::lower_bound(arrivals.begin(), arrivals.end(),
                                            std::tuple(start.vertex, edge, Index{0}));
      if (arrival != arrivals.end() && std::get<0>(*arrival) == start.vertex &&
          std::get<1>(*arrival) == edge) {
        end = std::get<2>(*arrival);
      }
    }
    if (end == kNone) return {};
    wedges.push_back({start.corner, end});
  }
  return wedges;
}

}  // namespace watertight::validate
