// SPDX-License-Identifier: GPL-3.0-or-later
//
// The truth about small solids, by definition and in rational numbers: whether a solid is valid,
// and how two valid solids lie to each other. The oracle shares one thing with the product: the
// surface of a facet that is not planar is, by definition, its canonical triangles
// (tessellate/facets.h).
#pragma once

#include <set>
#include <string>

#include "geometry/solid.h"

namespace watertight::verdict {

/// Stands in Truth::codes for all codes.
inline constexpr int kAnyCode = 0;

struct Truth {
  bool is_known = true;  // false: a facet that is not planar has no canonical triangles
  /// Empty: valid. Else a report is right when it has one of these codes.
  std::set<int> codes;
  std::string reason;  // for people
  /// Ring edges of two shells cross in a point that is not a vertex: engines may have no answer.
  bool has_crossing_edges = false;
  bool is_planar = true;  // all facets are
  bool is_valid() const { return is_known && codes.empty(); }
};

/// Rules, by definition: rings are simple and bound one connected region that the facet fills (104,
/// 201, 202, 205 to 208); a vertex of a facet that lies on an edge of another of its rings splits
/// that edge; two facets of a shell meet in common ring edges and common vertices only (302, 303,
/// 306); the link of each vertex is one cycle (303); facets turn alike (307) and hang together
/// (305); cavities lie in the exterior shell and apart, sharing no area (401, 402, 403); shells
/// turn outward (405); the interior is connected (404). Planarity is not measured. Cost: some
/// milliseconds for a solid of 30 facets; grows with the third power.
Truth truth_of(const Solid& solid);

/// How the point sets of two valid solids on one lattice lie to each other.
struct PairTruth {
  bool overlap = false;     // the interiors have a point in common
  bool are_equal = false;   // the same points
  bool share_area = false;  // of their boundaries
};
PairTruth pair_truth_of(const Solid& first, const Solid& second);

}  // namespace watertight::verdict
