// SPDX-License-Identifier: GPL-3.0-or-later
//
// The filter and the order of a request for features (OGC API - Features, parts 3 and 8). Internal
// to server/.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "server/handlers.h"

namespace watertight::server {

/// The filter in the parameters `filter`, `filter-lang` (cql2-text, the default, or cql2-json) and
/// `filter-crs`, its boxes in the storage CRS; nothing without one. Errors: those of cql2/cql2.h,
/// without places, since they would be places in the body; invalid_argument; those of
/// choice_of_box().
Result<std::optional<store::Filter>> filter_of_request(const Target& target,
                                                       const store::StoredCollection& collection);

/// The parameters by which some features of a collection are selected for a file or a report.
inline constexpr std::array<std::string_view, 5> kSelectionParameters{
    "filter", "filter-lang", "filter-crs", "bbox", "bbox-crs"};

/// filter_of_request() and box_of_request() together; nothing if all features are selected. Errors:
/// those of both.
Result<std::optional<store::Filter>> selection_of_request(
    const Target& target, const store::StoredCollection& collection);

/// A text that tells the selections of requests apart; "" without one.
std::string selection_name(const Target& target);

/// The order in the parameter `sortby`: the name of an attribute, after + (ascending, as without)
/// or - (descending); nothing without one. Errors: invalid_argument.
Result<std::optional<store::SortKey>> sort_of_request(const Target& target);

}  // namespace watertight::server
