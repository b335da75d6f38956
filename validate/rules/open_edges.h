// SPDX-License-Identifier: GPL-3.0-or-later
//
// Examines the edges that only one facet meets: finds the T-junctions and the borders that these
// edges form. For validate/ and repair/.
#pragma once

#include <vector>

#include "base/cancel.h"
#include "validate/edge_table.h"

namespace watertight::validate {

/// A vertex inside an edge of another facet.
struct TJunction {
  EdgeUse edge;
  EdgeUse across;  // an open edge that ends in the vertex
  Index vertex = 0;
};

/// A connected group of open edges.
struct Border {
  std::vector<EdgeUse> edges;
};

struct OpenEdges {
  std::vector<TJunction> junctions;  // ordered by edge, then along the edge
  std::vector<Border> borders;       // the borders of edges that T-junctions do not explain
  bool is_complete = true;           // false: the search for T-junctions did not finish
};

/// Finds the T-junctions and borders of open edges. Requires edges that are each used once, sorted
/// by vertices. Exact. If `is_cancelled` returns true, the search for T-junctions ends. Cost:
/// O(n log n + vertices close to each edge), bounded.
OpenEdges examine_open_edges(const Solid& solid, std::span<const EdgeUse> open,
                             const CancelPoll& is_cancelled);

}  // namespace watertight::validate
