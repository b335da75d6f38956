// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids of STEP and IFC files, added to features. Internal to formats/part21/.
#pragma once

#include <cstdint>
#include <optional>

#include "formats/curved/curved_solid.h"
#include "formats/part21/part21.h"

namespace watertight::formats {

/// An instance that is a solid, and what its file says of all solids.
struct SolidInstance {
  std::uint64_t id = 0;
  double radian = 1;                // radians of a unit of angles
  std::optional<double> tolerance;  // metres; BoundaryRepresentation's without
};

/// Reads a solid and adds it to `feature`, which may be one of `document`; readings of doubtful
/// input are notes of the document. All else as add_curved_solid().
Status add_solid_instance(const Part21& file, const SolidInstance& instance, CurvedSource from,
                          const ReadOptions& options, std::uint64_t& budget, Document& document,
                          Feature& feature);

}  // namespace watertight::formats
