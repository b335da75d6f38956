// SPDX-License-Identifier: GPL-3.0-or-later
//
// The positions of the vertices of a walked surface in mode `polygon`: columns by vertical edges,
// walls and right angles, heights by planes and levels (docs/format.md). For the mode only.
#pragma once

#include <span>
#include <vector>

#include "codec/mode_polygon/surface.h"

namespace watertight::codec::polygon {

/// `same_as[v]` is the first vertex at the same position, or v itself. (A vertex of the solid where
/// several fans meet is one vertex of the surface for each fan.)
struct CodedPositions {
  std::vector<GridPoint> points;
  std::vector<Index> same_as;
};

/// Codes the position of each vertex of `surface` in turn. `truth` is empty when reading, else the
/// positions. Errors: malformed, or not_encodable when writing, if a coordinate is 2^53 or more.
/// Cost: linear; per vertex at most 128 columns of the page, for the first one 4096.
Result<CodedPositions> code_positions(EntropyStream& stream, ModelBank& models,
                                      const PageMemory& memory, const PolygonSurface& surface,
                                      std::span<const GridPoint> truth);

}  // namespace watertight::codec::polygon
