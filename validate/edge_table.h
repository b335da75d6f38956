// SPDX-License-Identifier: GPL-3.0-or-later
//
// The ring edges of one shell, grouped by their two vertices. Internal to validate/.
#pragma once

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

#include "geometry/solid.h"

namespace watertight {

/// One passage of a ring along an edge.
struct EdgeUse {
  Index low = 0;            // the smaller vertex
  Index high = 0;           // the larger vertex
  bool is_forward = false;  // from low to high
  Index facet = 0;
  Index ring_in_facet = 0;
  Index position = 0;  // of the edge's first vertex in the ring
  Index corner = 0;    // index of that vertex in ring_vertices
  Index next_corner = 0;

  Index corner_at_low() const { return is_forward ? corner : next_corner; }
  Index corner_at_high() const { return is_forward ? next_corner : corner; }
};

/// Union-find with path halving; the smallest member is the root.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    if (a > b) std::swap(a, b);
    parent_[b] = a;
  }

 private:
  std::vector<Index> parent_;
};

/// Sorted by vertices, then by place. Edges of no length are left out. Cost: O(n log n).
std::vector<EdgeUse> edge_uses(const Solid& solid, Index shell);

/// Calls visit(span of the uses of one edge) for each edge in order.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, Visit visit) {
  std::size_t begin = 0;
  while (begin < uses.size()) {
    std::size_t end = begin + 1;
    while (end < uses.size() && uses[end].low == uses[begin].low &&
           uses[end].high == uses[begin].high) {
      ++end;
    }
    visit(uses.subspan(begin, end - begin));
    begin = end;
  }
}

}  // namespace watertight
