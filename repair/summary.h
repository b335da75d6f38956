// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a repair did to a solid, in numbers.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "repair/repair.h"

namespace watertight::repair {

struct RepairSummary {
  Repaired::Outcome outcome = Repaired::Outcome::not_repaired;
  /// Not repaired, but not known to be impossible either: the submitted solid or a mended one is
  /// undecided, or the repair was stopped.
  bool is_undecided = false;
  std::string undecided_reason;    // of the mended solid, or of the submitted one
  std::set<int> codes_before;      // the errors of the solid as it was submitted
  std::vector<Remedy> remedies;    // those that changed something
  std::size_t facets_added = 0;    // new ones, and parts of facets that were divided
  std::size_t facets_removed = 0;  // those that are gone or divided
  std::size_t facets_turned = 0;
  double area_added = 0;  // of facets that come from no facet of the submitted solid, square metres
  Moves moves;
  std::optional<double> volume;  // of the repaired solid, in world units cubed
  std::vector<HoleFill> holes;
};

inline bool is_repaired(const RepairSummary& summary) {
  return summary.outcome == Repaired::Outcome::repaired;
}

/// Compares a repaired solid with the submitted one. Requires the repair of that solid. Cost: that
/// of triangulating the repaired solid.
RepairSummary summary_of(const Solid& submitted, const Repaired& repaired);

}  // namespace watertight::repair
