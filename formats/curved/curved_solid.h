// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids of documents, made of boundary representations. For the readers of curved solids.
#pragma once

#include <cstdint>

#include "formats/document.h"
#include "formats/surface.h"
#include "surfaces/boundary_representation.h"

namespace watertight::formats {

/// Where a solid is.
struct CurvedSource {
  surfaces::Affine placement;  // from the units of the boundary to metres
  std::uint32_t srid = 0;
  SolidSource source;
};

/// Tessellates a solid that was read, and adds it to `feature`: what became of its faces and edges
/// is in SubmittedSolid::tessellation. A solid that could not be read or cannot be tessellated
/// becomes unreadable. `budget` is the number of facets that the document may still have, so that a
/// short text cannot ask for any memory; those of the solid are taken from it. Errors:
/// limit_exceeded for a boundary with more parts than Limits allow; invalid_argument for a chord
/// that is no positive number, and for a lattice that is too coarse for it.
Status add_curved_solid(Result<surfaces::BoundaryRepresentation> boundary, CurvedSource from,
                        const ReadOptions& options, std::uint64_t& budget, Feature& feature);

}  // namespace watertight::formats
