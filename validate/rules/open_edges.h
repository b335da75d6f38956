// SPDX-License-Identifier: GPL-3.0-or-later
//
// Edges that only one facet meets: T-junctions among them, and the borders they form. Internal to
// validate/.
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
  std::vector<TJunction> junctions;  // in edge order, along each edge
  std::vector<Border> borders;       // of the edges that T-junctions do not explain
  bool is_complete = true;           // false: not all T-junctions were looked for
};

/// Requires edges that are each used once, sorted by vertices. Exact. `is_cancelled` ends the
/// search for T-junctions. Cost: O(n log n + vertices close to each edge), bounded.
OpenEdges examine_open_edges(const Solid& solid, std::span<const EdgeUse> open,
                             const CancelPoll& is_cancelled);

}  // namespace watertight::validate
