// SPDX-License-Identifier: GPL-3.0-or-later
//
// The truth about small solids, by definition and in rational numbers: whether a solid is valid,
// and the relation of two valid solids. The oracle shares one thing with the product: the surface
// of a facet that is not planar is, by definition, the canonical triangles (tessellate/facets.h).
#pragma once

#include <set>
#include <string>

#include "geometry/solid.h"

namespace watertight::verdict {

/// The value that stands for all codes in Truth::codes.
inline constexpr int kAnyCode = 0;

struct Truth {
  bool is_known = true;  // false: a facet that is not planar has no canonical triangles
  /// Empty if the solid is valid. Else a report is right if it has one of these codes.
  std::set<int> codes;
  std::string reason;  // an explanation for readers
  /// True if ring edges of two shells cross in a point that is no vertex: engines may find no
  /// answer.
  bool has_crossing_edges = false;
  bool is_planar = true;  // all facets are planar
  bool is_valid() const { return is_known && codes.empty(); }
};

/// The truth about a solid. The rules, by definition: rings are simple and bound one connected
/// region that the facet fills (104, 201, 202, 205 to 208); a vertex of a facet that lies on an
/// edge of another of its rings splits that edge; two facets of a shell meet in common ring edges
/// and common vertices only (302, 303, 306); the link of each vertex is one cycle (303); the facets
/// of a shell turn alike (307) and are connected (305); cavities lie in the exterior shell and
/// apart, and share no area (401, 402, 403); shells turn outward (405); the interior is connected
/// (404). Planarity is not measured. Cost: some milliseconds for a solid of 30 facets; grows with
/// the third power.
Truth truth_of(const Solid& solid);

/// The relation of the point sets of two valid solids on one lattice.
struct PairTruth {
  bool overlap = false;     // the interiors have a point in common
  bool are_equal = false;   // the solids have the same points
  bool share_area = false;  // the boundaries have an area in common
};
PairTruth pair_truth_of(const Solid& first, const Solid& second);

}  // namespace watertight::verdict
