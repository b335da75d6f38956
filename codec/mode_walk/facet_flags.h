// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the facets of a triangulated boundary: one decision per edge says whether it lies inside a
// facet. The rings follow from that; a few more decisions say which ring of a facet and which shell
// is the exterior one. For mode walk (docs/format-walk.md, "Facets of triangles").
#pragma once

#include <span>
#include <vector>

#include "base/result.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/mode_walk/walk.h"
#include "codec/page/integer_solid.h"
#include "geometry/point.h"

namespace watertight::codec::walk {

/// Codes the facets of the surface that `mesh` triangulates. `points` are the vertices of `mesh`.
/// When writing, `facet_of[t]` is the facet in `solid` of triangle t of `mesh`. When reading, fills
/// all arrays of `solid` but its vertices. Errors: not_encodable where flags do not determine the
/// facets (rings that touch themselves, shells that are not connected); when reading: malformed.
/// Cost: O(n log n).
Status code_facets(EntropyStream& stream, ModelBank& models, std::span<const Point> points,
                   const BoundaryMesh& mesh, std::span<const Index> facet_of, IntegerSolid& solid);

}  // namespace watertight::codec::walk
