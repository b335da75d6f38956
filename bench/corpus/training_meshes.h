// SPDX-License-Identifier: GPL-3.0-or-later
//
// The dense meshes that mode parallelogram learns from.
#pragma once

#include <string>
#include <vector>

#include "codec/page/integer_solid.h"

namespace watertight {

/// The closed meshes of at most 60,000 facets in every other file under `folder`, in the order of
/// their paths from the first, on grids of 11, 14 and 16 bits and on their own. The other files are
/// not read. None if the name is empty.
std::vector<codec::IntegerSolid> training_meshes(const std::string& folder);

}  // namespace watertight
