// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids of documents, made of boundary representations. For the readers of curved solids.
#pragma once

#include <string>
#include <vector>

#include "formats/document.h"
#include "formats/surface.h"
#include "surfaces/boundary_representation.h"

namespace watertight::formats {

/// Tessellates a solid after `placement` has moved it into metres. What becomes of its faces and
/// edges is in SubmittedSolid::tessellation. `budget` is the number of facets that the document may
/// still have, so that a short text cannot ask for any memory; those of the solid are taken from
/// it. Errors: limit_exceeded beyond the budget and for more than Limits allow; invalid_argument
/// for a chord that is no positive number.
Result<SubmittedSolid> curved_solid(surfaces::BoundaryRepresentation boundary,
                                    const surfaces::Affine& placement, SolidSource source,
                                    std::uint32_t srid, double chord, std::uint64_t& budget,
                                    const Limits& limits);

}  // namespace watertight::formats
