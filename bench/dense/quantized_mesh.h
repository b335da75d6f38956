// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangle meshes on integer grids, made from the solids of a document.
#pragma once

#include <optional>

#include "codec/page/integer_solid.h"
#include "geometry/solid.h"

namespace watertight {

/// The solid in triangles on its own grid, or quantized as Draco does: the longest side of the box
/// gets 2^bits - 1 steps. Vertices at one position are merged; triangles without area and duplicate
/// ones are left out. Nothing if some edge is not used equally often in both directions, or if the
/// solid has no grid.
std::optional<codec::IntegerSolid> quantize(const Solid& solid, std::optional<int> bits);

}  // namespace watertight
