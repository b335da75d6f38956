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
/// edges is in SubmittedSolid::tessellation; a solid that cannot be tessellated is unreadable.
/// Errors: limit_exceeded for more than Limits allow.
Result<SubmittedSolid> curved_solid(surfaces::BoundaryRepresentation boundary,
                                    const surfaces::Affine& placement, SolidSource source,
                                    std::uint32_t srid, double chord, const Limits& limits);

}  // namespace watertight::formats
