// SPDX-License-Identifier: GPL-3.0-or-later
//
// The dense meshes that mode parallelogram learns from.
#pragma once

#include <string>
#include <vector>

#include "codec/page/integer_solid.h"

namespace watertight {

/// Of the files under `folder` in the order of their paths every other one, from the first: its
/// closed meshes of at most 60,000 facets, on grids of 11, 14 and 16 bits and on their own. The
/// other files are not seen. None if the name is empty.
std::vector<codec::IntegerSolid> training_meshes(const std::string& folder);

}  // namespace watertight
