// SPDX-License-Identifier: GPL-3.0-or-later
//
// The address under which clients reach the service, for links. Internal to server/.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "server/handlers.h"

namespace watertight::server {

/// The start of all links of an answer, without a slash at its end: the option base_url; else what
/// a proxy says of the request that it forwards (Forwarded, or X-Forwarded-Proto, -Host and
/// -Prefix); else http and the request's Host. "" if there is none of them, so that links are
/// paths. Clients that resolve no relative links, as QGIS, need absolute ones.
std::string base_url(const RoutedRequest& request);

/// Ok for an http or https URL without query, of which paths can be parts. Errors:
/// invalid_argument.
Status check_base_url(std::string_view url);

}  // namespace watertight::server
