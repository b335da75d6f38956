// SPDX-License-Identifier: GPL-3.0-or-later
//
// The findings of a stored feature, from the reports of its solids and of its groups of solids.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::report {

/// A defect of a stored feature.
struct StoredFinding {
  std::string object;  // the city object that has the solid
  std::string lod;
  int code = 0;
  std::string name;
  std::string severity;
  std::optional<std::array<double, 3>> witness;  // a place, in the storage CRS
  /// The other members by name, JSON texts: measured, limit, unit, hint, detail, pointer; "null"
  /// for one that the finding has not.
  std::vector<std::pair<std::string, std::string>> members;
};

/// The findings of the solids that are not proven, in their order, then those of the groups. The
/// feature has its reports (pipeline::unpack() with Reports::of_unproven). Cost: linear.
std::vector<StoredFinding> findings_of(const pipeline::EncodedFeature& feature);

/// Its object, level of detail, code, name and severity, then its members: names, JSON texts.
std::vector<std::pair<std::string, std::string>> properties_of(const StoredFinding& finding);

}  // namespace watertight::report
