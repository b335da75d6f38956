// SPDX-License-Identifier: GPL-3.0-or-later
//
// The names of elements of an indoor model in findings. Internal to validate/.
#pragma once

#include <string>

#include "geometry/cell_graph.h"

namespace watertight::validate {

/// "'C1' (line 7)", or "on line 7" for an element without gml:id; long ids are cut.
std::string element_name(const geometry::GraphElement& element);

/// A reference in quotes; long ones are cut.
std::string quoted_reference(const geometry::GraphLink& link);

}  // namespace watertight::validate
