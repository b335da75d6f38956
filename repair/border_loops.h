// SPDX-License-Identifier: GPL-3.0-or-later
//
// The borders of a shell that is not closed.
#pragma once

#include <span>
#include <vector>

#include "repair/edited_solid.h"

namespace watertight::repair {

struct BorderLoops {
  /// Simple loops of vertices, in the sense in which a missing facet runs; each starts at its
  /// smallest vertex, and they are sorted.
  std::vector<Ring> loops;
  /// The number of border edges that belong to no loop, because more than two facets meet in one of
  /// their ends or edges.
  std::size_t left_over = 0;
};

/// The loops of edges that one facet uses in one sense and none in the other. Where more than two
/// such edges meet in a vertex, the loops follow the fans of facets around it. Cost: O(n log n).
BorderLoops border_loops(std::span<const EditedFacet> facets);

/// Cuts a closed walk where it passes a vertex again: loops that pass each vertex once. Cost:
/// O(n log n).
std::vector<Ring> simple_loops_of(const Ring& walk);

}  // namespace watertight::repair
