// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids of documents, made of boundary representations. For the readers of curved solids.
#pragma once

#include <cstdint>
#include <optional>

#include "formats/document.h"
#include "formats/part21/part21.h"
#include "formats/surface.h"
#include "surfaces/boundary_representation.h"

namespace watertight::formats {

/// A solid of a file, and where it is.
struct CurvedSource {
  std::uint64_t id = 0;             // the instance
  double radian = 1;                // radians of a unit of angles
  std::optional<double> tolerance;  // metres: what the file says; BoundaryRepresentation's without
  surfaces::Affine placement;       // from the units of the file to metres
  std::uint32_t srid = 0;
  SolidSource source;
};

/// Reads a solid, tessellates it, and adds it to `feature`, which may be one of `document`: what
/// became of its faces and edges is in SubmittedSolid::tessellation, readings of doubtful input are
/// notes of the document. A solid that cannot be read or tessellated becomes unreadable. `budget`
/// is the number of facets that the document may still have, so that a short text cannot ask for
/// any memory; those of the solid are taken from it. Errors: limit_exceeded for a file with more
/// parts than Limits allow; invalid_argument for a chord that is no positive number.
Status add_curved_solid(const Part21& file, CurvedSource from, const ReadOptions& options,
                        std::uint64_t& budget, Document& document, Feature& feature);

}  // namespace watertight::formats
