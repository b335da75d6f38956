// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers in JSON and the parts that lists share. Internal to server/.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "server/handlers.h"

namespace watertight::server {

/// JSON with its members in the order in which they were added.
using Json = nlohmann::ordered_json;

Response json_response(const Json& json, std::string_view type = kJson);

/// A link of OGC API documents.
Json link(std::string href, std::string_view relation, std::string_view type,
          std::string_view title);

/// The refusal of a client that does not accept JSON, for resources that have JSON only.
std::optional<Response> json_only(const RoutedRequest& request);

/// The minima, then the maxima, on x, y and z.
Json box_json(const store::StoredBox& box);

/// The parameter `proven`: only features that are proven, or that are not. Errors:
/// invalid_argument.
Result<std::optional<bool>> proof_of_request(const Target& target);

/// The most entries that the client wants on a page: the parameter `limit`, `usual` without it.
/// Errors: invalid_argument.
Result<std::uint64_t> limit_of_request(const Target& target, const RouteOptions& options,
                                       std::uint64_t usual);

}  // namespace watertight::server
