// SPDX-License-Identifier: GPL-3.0-or-later
//
// The positions of the vertices of a walked surface in mode `polygon`: columns by vertical edges,
// walls and right angles, heights by planes and levels (docs/format.md). For the mode only.
#pragma once

#include <span>
#include <vector>

#include "codec/polygon_surface.h"

namespace watertight {

/// Codes the position of each vertex of `surface` in turn. `truth` is empty when reading, else the
/// positions. Returns the positions and, for a vertex that is one more fan at the place of an
/// earlier one, which (else itself). Errors: malformed. Cost: linear, times the logarithm of the
/// page's columns.
struct CodedPositions {
  std::vector<GridPoint> points;
  std::vector<Index> same_as;
};
Result<CodedPositions> code_positions(EntropyStream& stream, ModelBank& models,
                                      const PageMemory& memory, const PolygonSurface& surface,
                                      std::span<const GridPoint> truth);

}  // namespace watertight
