// SPDX-License-Identifier: GPL-3.0-or-later
//
// The surface that mode parallelogram writes: the triangles of a solid as a manifold. Vertices and
// edges where several sheets of the surface meet are cut apart.
#pragma once

#include <vector>

#include "base/result.h"
#include "codec/page/integer_solid.h"
#include "geometry/point.h"

namespace watertight::codec::parallelogram {

/// Half-edge 3 t + k runs from corner k of triangle t to the next corner.
struct CutSurface {
  std::vector<Triangle> triangles;     // in the order of the facets; the corners are fans
  std::vector<Index> twin;             // half-edge -> its twin
  std::vector<GridPoint> positions;    // fan of triangles around a vertex -> its position
  std::vector<Index> component_first;  // component -> one of its triangles; components by shells
  std::vector<bool> is_new_shell;      // component -> whether it begins a shell
};

/// Cuts the surface of a solid. Errors: not_encodable unless all facets are triangles and each
/// shell is closed.
Result<CutSurface> cut_surface(const IntegerSolid& solid);

}  // namespace watertight::codec::parallelogram
