// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "bench/geometry/shapes.h"

namespace watertight::bench {

/// The mesh of an OBJ, OFF, PLY or STL file: polygons as fans over merged vertices, degenerate
/// triangles left out. Nothing if CGAL cannot read the file.
std::optional<Soup> read_soup(const std::string& file);

}  // namespace watertight::bench
