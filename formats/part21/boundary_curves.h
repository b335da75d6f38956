// SPDX-License-Identifier: GPL-3.0-or-later
//
// Curves and surfaces of STEP and IFC. Internal to formats/part21/.
#pragma once

#include <cstdint>
#include <optional>

#include "formats/part21/boundary_reader.h"

namespace watertight::formats {

/// A curve of any kind that files have. Errors: malformed; unsupported for another kind of entity,
/// limit_exceeded for curves within curves without end.
Result<surfaces::Curve> read_curve(const EntityReader& reader, std::uint64_t id,
                                   std::uint32_t depth = 0);

/// A surface; nothing for a plane. Errors: as read_curve().
Result<std::optional<surfaces::Surface>> read_surface(const EntityReader& reader, std::uint64_t id,
                                                      double radians);

}  // namespace watertight::formats
