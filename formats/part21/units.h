// SPDX-License-Identifier: GPL-3.0-or-later
//
// Units of lengths and angles in STEP and IFC files. Internal to formats/part21/.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/part21/boundary_reader.h"

namespace watertight::formats {

struct FileUnits {
  double metre = 1;                   // metres of a unit of length
  double radian = 1;                  // radians of a unit of plane angles
  std::optional<double> uncertainty;  // metres: how accurate the file says it is
};

/// The units in a list of units of a file. Units of other quantities are not read. Errors:
/// malformed for units that contradict each other or refer to each other without end.
Result<FileUnits> read_units(const EntityReader& reader, const std::vector<std::uint64_t>& units);

/// The metres of a unit of length: an instance. Errors: malformed, if it is none.
Result<double> metres_of_unit(const EntityReader& reader, std::uint64_t id);

}  // namespace watertight::formats
