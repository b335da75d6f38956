// SPDX-License-Identifier: GPL-3.0-or-later
//
// Entity tags, and the preconditions that requests state with them (RFC 9110, section 13). Internal
// to server/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/handlers.h"

namespace watertight::server {

/// The entity tag of a representation of a feature. Versions are never used twice, so the version
/// and the words that name the representation are enough: "17-wt".
std::string etag_of(std::uint64_t version, std::string_view representation);

/// The entity tag of a representation of a collection as a whole, from StoredCollection::state.
std::string etag_of_state(std::string_view state, std::string_view representation);

/// 412 or 304 for a request for a representation with this tag, when its preconditions say so.
std::optional<Response> unless_needed(const Request& request, const std::string& etag);

/// The condition under which a write may be done. Errors: invalid_argument for one that this
/// service does not know (If-None-Match with anything but *).
Result<store::WriteCondition> write_condition(const Request& request);

/// True if the request states a precondition on what it changes.
bool has_precondition(const Request& request);

/// 412 for a change of a collection in this state, when the request's preconditions do not hold.
/// Any tag of the state counts, whatever the representation that the tag is of.
std::optional<Response> unless_same_state(const Request& request, const std::string& state);

/// 428 for a write without a precondition, if the service wants one.
std::optional<Response> unless_conditional(const RoutedRequest& request);

}  // namespace watertight::server
