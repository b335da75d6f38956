// SPDX-License-Identifier: GPL-3.0-or-later
//
// The filter of a request for features (OGC API - Features, part 3). Internal to server/.
#pragma once

#include <optional>

#include "server/handlers.h"

namespace watertight::server {

/// The filter in the parameters `filter`, `filter-lang` (cql2-text, the default, or cql2-json) and
/// `filter-crs`, its boxes in the storage CRS; nothing without one. Errors: those of cql2/cql2.h,
/// without places, since they would be places in the body; invalid_argument; those of
/// choice_of_box().
Result<std::optional<store::Filter>> filter_of_request(const Target& target,
                                                       const store::StoredCollection& collection);

}  // namespace watertight::server
