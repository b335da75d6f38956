// SPDX-License-Identifier: GPL-3.0-or-later
//
// Leave for web pages of other origins to read answers (Fetch standard, CORS protocol). Internal to
// server/.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "server/transport/http.h"

namespace watertight::server {

/// Ok for "*" or an origin such as "https://maps.example.org". Errors: invalid_argument.
Status check_origin(std::string_view origin);

/// The answer with the fields that let pages of `allowed` ("*": of any origin) read it. Only
/// reading is allowed: answers to GET, HEAD and OPTIONS. Answers to requests without an Origin stay
/// as they are.
Response with_leave_to_read(const std::string& allowed, const Request& request, Response response);

}  // namespace watertight::server
