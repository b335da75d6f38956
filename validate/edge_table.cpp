// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/edge_table.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace watertight::validate {

CornerPlace place_of_corner(const Solid& solid, Index facet, Index corner) {
  const IndexRange rings = solid.rings_of(facet);
  const auto& offsets = solid.arrays().ring_offsets;
  // The last ring that starts at or before the corner; empty rings before that ring are skipped.
  const auto next =
      std::upper_bound(offsets.begin() + rings.begin, offsets.begin() + rings.end + 1, corner);
  const auto ring = static_cast<Index>(next - offsets.begin() - 1);
  CornerPlace place;
  place.ring_in_facet = ring - rings.begin;
  place.position = corner - offsets[ring];
  place.next = corner + 1 == offsets[ring + 1] ? offsets[ring] : corner + 1;
  return place;
}

/// Calls visit(from, to, facet, corner) for each ring edge of the facets, in the order of corners.
template <class Visit>
void EdgeTable::for_each_passage(IndexRange facets, Visit visit) const {
  for (Index facet = facets.begin; facet < facets.end; ++facet) {
    const IndexRange rings = solid_.rings_of(facet);
    for (Index r = rings.begin; r < rings.end; ++r) {
      const std::span<const Index> ring = solid_.ring(r);
      if (ring.size() < 3) continue;  // such a ring bounds nothing
      const Index base = solid_.arrays().ring_offsets[r];
      for (Index i = 0; i < ring.size(); ++i) {
        const Index to = ring[i + 1 == ring.size() ? 0 : i + 1];
        if (ring[i] != to) visit(ring[i], to, facet, base + i);
      }
    }
  }
}

void EdgeTable::examine(Index shell) {
  const IndexRange facets = solid_.facets_of(shell);
  for (const Index vertex : vertices_) number_of_[vertex] = kNone;
  vertices_.clear();
  for_each_passage(facets, [&](Index from, Index to, Index, Index) {
    for (const Index vertex : {from, to}) {
      if (number_of_[vertex] != kNone) continue;
      number_of_[vertex] = 0;
      vertices_.push_back(vertex);
    }
  });
  if (!std::is_sorted(vertices_.begin(), vertices_.end())) {
    std::sort(vertices_.begin(), vertices_.end());
  }
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    number_of_[vertices_[i]] = static_cast<Index>(i);
  }
  // A counting sort by the smaller vertex; the few uses with one smaller vertex are then sorted by
  // comparison.
  std::vector<Index> first(vertices_.size() + 1, 0);
  for_each_passage(facets, [&](Index from, Index to, Index, Index) {
    ++first[number_of_[std::min(from, to)] + 1];
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  uses_.resize(first.back());
  std::vector<Index> next(first.begin(), first.end() - 1);
  for_each_passage(facets, [&](Index from, Index to, Index facet, Index corner) {
    uses_[next[number_of_[std::min(from, to)]]++] = {std::min(from, to), std::max(from, to), facet,
                                                     corner};
  });
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    std::sort(uses_.begin() + first[i], uses_.begin() + first[i + 1],
              [](const EdgeUse& a, const EdgeUse& b) {
                return std::tie(a.high, a.corner) < std::tie(b.high, b.corner);
              });
  }
}

}  // namespace watertight::validate
