// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which border loops bound one hole together. Internal to repair/.
#pragma once

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

}  // namespace watertight::repair
