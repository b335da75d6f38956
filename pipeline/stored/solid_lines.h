// SPDX-License-Identifier: GPL-3.0-or-later
//
// The lines about solids in front of the skeleton of an EncodedFeature.
#pragma once

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"

namespace watertight::pipeline {

/// Takes a line that starts with `start` off the front of a skeleton. Returns the number of its
/// solid and its text. Errors: malformed when it has no number below `solids`.
Result<std::pair<std::size_t, std::string_view>> take_line(std::string_view& skeleton,
                                                           std::string_view start,
                                                           std::size_t solids);

/// The lines in front of a stored skeleton: for each solid `unproven`, `merged` or none of the two,
/// and `repaired` or not.
struct SolidLines {
  std::string_view unproven;
  std::string_view merged;
  std::string_view repaired;
};

/// Takes the lines of solids off the front of a stored skeleton. Errors: malformed.
Result<std::vector<SolidLines>> take_solid_lines(std::string_view& skeleton, std::size_t solids);

}  // namespace watertight::pipeline
