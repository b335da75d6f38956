// SPDX-License-Identifier: GPL-3.0-or-later
//
// How much a repair changed a solid, in numbers.
#pragma once

#include "repair/repair.h"

namespace watertight::repair {

struct Changes {
  std::size_t facets_added = 0;    // new ones, and parts of facets that were divided
  std::size_t facets_removed = 0;  // those that are gone or divided
  std::size_t facets_turned = 0;
  double area_added = 0;  // of facets that come from no facet of the submitted solid, square metres
};

/// Compares the facets of a repaired solid with those that were submitted; without a repair nothing
/// has changed. Requires the repair of that solid. Cost: that of triangulating the repaired solid.
Changes changes_of(const Solid& submitted, const Repaired& repaired);

}  // namespace watertight::repair
