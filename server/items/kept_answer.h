// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers about a whole collection that stay right while it is unchanged. Internal to server/.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "server/handlers.h"

namespace watertight::server {

/// The answer for a state of a collection: 304 or 412 by the conditions of the request, else from
/// the cache, else with the body that `make` makes, which the cache then keeps. `name` tells what
/// the answer is about; other hosts and other targets have answers of their own.
Response kept_or_made(const RoutedRequest& request, const store::StoredCollection& collection,
                      std::string_view name, std::string_view type,
                      const std::function<Result<std::string>()>& make);

}  // namespace watertight::server
