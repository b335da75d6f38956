// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/json_answers.h"

#include <algorithm>
#include <charconv>

namespace watertight::server {

Response json_response(const Json& json, std::string_view type) {
  return Response{
      200, std::string(type), json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n", {}};
}

Json link(std::string href, std::string_view relation, std::string_view type,
          std::string_view title) {
  return {{"href", std::move(href)}, {"rel", relation}, {"type", type}, {"title", title}};
}

std::optional<Response> json_only(const RoutedRequest& request) {
  const std::string* format = request.target.parameter("f");
  if (format != nullptr) {
    if (*format == "json") return std::nullopt;
    return refuse(406, "not-acceptable", "this resource is available as JSON only (f=json)");
  }
  if (negotiate(request.request.header("accept"), {kJson})) return std::nullopt;
  return refuse(406, "not-acceptable", "this resource is available as application/json only");
}

Json box_json(const store::StoredBox& box) {
  return Json::array({box.min[0], box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]});
}

Result<std::uint64_t> limit_of_request(const Target& target, const RouteOptions& options,
                                       std::uint64_t usual) {
  const std::string* text = target.parameter("limit");
  if (text == nullptr) return usual;
  std::uint64_t limit = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), limit);
  if (error == std::errc::result_out_of_range) return options.largest_page;
  if (error != std::errc{} || end != text->data() + text->size() || limit == 0) {
    return Error{ErrorCode::invalid_argument,
                 "limit is a whole number from 1 to " + std::to_string(options.largest_page)};
  }
  return std::min(limit, options.largest_page);
}

}  // namespace watertight::server
