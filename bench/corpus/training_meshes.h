// SPDX-License-Identifier: GPL-3.0-or-later
//
// The dense meshes on which mode parallelogram is trained.
#pragma once

#include <string>
#include <vector>

#include "codec/page/integer_solid.h"

namespace watertight {

/// The closed meshes of at most 60,000 facets in every other file under `folder` (the first, the
/// third, ... in the order of paths), on grids of 11, 14 and 16 bits and on their own grids. The
/// other files are not read. No meshes if the name is empty.
std::vector<codec::IntegerSolid> training_meshes(const std::string& folder);

}  // namespace watertight
