// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether the facets of a surface close: the test by which a surface is offered as a solid.
#pragma once

#include <cstddef>

#include "geometry/solid.h"

namespace watertight::geometry {

/// How the facets of a surface meet at their edges.
struct Closure {
  std::size_t open_edges = 0;  // edges that not exactly two rings pass
  std::size_t parts = 0;       // sets of facets that edges connect
  /// True if every edge is passed exactly twice, and there is an edge.
  bool is_closed = false;
  /// True if the facets are one closed shell.
  bool is_one_shell() const { return is_closed && parts == 1; }
};

/// The closure of all facets of a solid, whatever their shells. Equal vertices are one vertex;
/// edges without length do not count. Exact. Cost: O(n log n).
Closure closure_of(const Solid& solid);

}  // namespace watertight::geometry
