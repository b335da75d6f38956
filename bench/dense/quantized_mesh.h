// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangle meshes on integer grids, made from the solids of a document.
#pragma once

#include <optional>

#include "codec/page/integer_solid.h"
#include "geometry/solid.h"

namespace watertight {

/// The solid in triangles on its own grid, or quantized as Draco does: the longest side of the box
/// to 2^bits - 1 steps. Vertices that fall together are one, triangles without area and equal ones
/// are left out. Nothing if its edges are not used alike in both directions or the grid is none.
std::optional<codec::IntegerSolid> quantize(const Solid& solid, std::optional<int> bits);

}  // namespace watertight
