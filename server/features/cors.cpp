// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/features/cors.h"

#include <memory>

#include "server/features/links.h"

namespace watertight::server {
namespace {

void add_leave(const std::string& allowed, bool is_preflight, Response& response) {
  response.headers.push_back({"Access-Control-Allow-Origin", allowed});
  response.headers.push_back(
      {"Access-Control-Expose-Headers",
       "Content-Crs, Content-Disposition, ETag, Retry-After, Watertight-Losses"});
  if (allowed != "*") response.headers.push_back({"Vary", "Origin"});
  if (!is_preflight) return;
  response.headers.push_back({"Access-Control-Allow-Methods", "GET, HEAD"});
  response.headers.push_back({"Access-Control-Allow-Headers",
                              "Accept, Authorization, If-Match, If-None-Match, If-Range, Range"});
  response.headers.push_back({"Access-Control-Max-Age", "3600"});
}

}  // namespace

Status check_origin(std::string_view origin) {
  if (origin == "*") return Done{};
  const std::size_t slash = origin.find('/', origin.find("://") + 3);
  if (check_base_url(origin) && slash == std::string_view::npos) return Done{};
  return Error{ErrorCode::invalid_argument,
               std::string(origin) + " is no origin (examples: *, https://maps.example.org)"};
}

Response with_leave_to_read(const std::string& allowed, const Request& request, Response response) {
  const bool is_preflight = request.method == "OPTIONS";
  const bool is_reading = is_preflight || request.method == "GET" || request.method == "HEAD";
  if (allowed.empty() || !is_reading || request.header("origin") == nullptr) return response;
  if (!response.further) {
    add_leave(allowed, is_preflight, response);
    return response;
  }
  const auto work = response.further;
  response.further = std::make_shared<const FurtherWork>(
      FurtherWork{work->lane, work->key, [allowed, request, work](const CancelPoll& is_cancelled) {
                    return with_leave_to_read(allowed, request, work->make(is_cancelled));
                  }});
  return response;
}

}  // namespace watertight::server
