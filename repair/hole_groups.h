// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which border loops bound one hole together. Internal to repair/.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "repair/edited_solid.h"

namespace watertight::repair {

/// The loops around one hole: the outer one and its islands.
using HoleLoops = std::vector<Ring>;

/// Puts each loop that lies inside a larger one in projection, and runs the other way, into the
/// group of that loop; large loops choose first. Exact but for the order by size. Cost: O(n log n)
/// for n vertices, and for each two loops whose boxes meet in projection the product of their
/// vertices.
std::vector<HoleLoops> group_loops(const EditedSolid& solid, std::vector<Ring> loops);

/// The cost of filling a hole with these loops; nothing where it cannot be filled.
using HoleCost = std::function<std::optional<double>(const HoleLoops&)>;

/// Joins holes in pairs where they border parts of a shell that no vertex connects, so that each
/// pair is filled by a tube between the parts: the pair of the least cost first, until the parts
/// are connected or no pair has a cost. Holes of one part, and more than 8, stay as they are. Cost:
/// O(n log n), and `cost` for each pair.
std::vector<HoleLoops> join_parts(std::span<const EditedFacet> facets, std::size_t vertex_count,
                                  std::vector<HoleLoops> holes, const HoleCost& cost);

}  // namespace watertight::repair
