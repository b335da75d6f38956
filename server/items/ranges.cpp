// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/items/ranges.h"

#include <algorithm>
#include <charconv>

#include "base/ascii.h"
#include "server/handlers.h"

namespace watertight::server {
namespace {

/// A number of bytes. Nothing for other text; the largest number for one that is larger.
std::optional<std::uint64_t> byte_position(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return UINT64_MAX;
  if (error != std::errc{}) return std::nullopt;
  return value;
}

WantedRange unsatisfiable() { return {WantedRange::Kind::unsatisfiable, {}}; }

WantedRange part(std::uint64_t first, std::uint64_t last) {
  return {WantedRange::Kind::part, {first, last}};
}

/// "2-5", "2-" or "-5" of a body of `size` bytes.
WantedRange range_of(std::string_view text, std::uint64_t size) {
  const std::size_t dash = text.find('-');
  if (dash == std::string_view::npos) return {};
  const auto first = byte_position(text.substr(0, dash));
  const auto last = byte_position(text.substr(dash + 1));
  if (dash == 0) {  // the last bytes
    if (!last) return {};
    if (*last == 0 || size == 0) return unsatisfiable();
    return part(size - std::min(*last, size), size - 1);
  }
  const bool is_open = dash + 1 == text.size();
  if (!first || (!last && !is_open) || (last && *last < *first)) return {};
  if (*first >= size) return unsatisfiable();
  return part(*first, is_open ? size - 1 : std::min(*last, size - 1));
}

const std::string* field_of(const Response& response, std::string_view name) {
  for (const HeaderField& field : response.headers) {
    if (field.name == name) return &field.value;
  }
  return nullptr;
}

}  // namespace

WantedRange wanted_range(const Request& request, std::string_view etag, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  const std::string* range = request.header("range");
  if (range == nullptr || request.method != "GET") return {};
  const std::string* known = request.header("if-range");
  if (known != nullptr && *known != etag) return {};
  const std::string text = lower_case(*range);
  const bool is_one = text.starts_with(kUnit) && text.find(',') == std::string::npos;
  return is_one ? range_of(std::string_view(text).substr(kUnit.size()), size) : WantedRange{};
}

HeaderField content_range(const ByteRange& part, std::uint64_t size) {
  std::string place = "bytes ";
  place.append(std::to_string(part.first)).append("-").append(std::to_string(part.last));
  place.append("/").append(std::to_string(size));
  return {"Content-Range", place};
}

Response beyond(std::uint64_t size) {
  Problem problem{416, "range-not-satisfiable", "", {}, {}, {}, {}};
  problem.detail.append("the body has ").append(std::to_string(size)).append(" bytes");
  problem.headers.push_back({"Content-Range", "bytes */" + std::to_string(size)});
  return to_response(problem);
}

Response in_range(const Request& request, Response whole) {
  const std::string* etag = field_of(whole, "ETag");
  if (whole.status != 200 || etag == nullptr || whole.rest || whole.further) return whole;
  const std::uint64_t size = whole.body.size();
  const WantedRange wanted = wanted_range(request, *etag, size);
  if (wanted.kind == WantedRange::Kind::unsatisfiable) return beyond(size);
  whole.headers.push_back({"Accept-Ranges", "bytes"});
  if (wanted.kind == WantedRange::Kind::whole) return whole;
  const auto [first, last] = wanted.part;
  whole.status = 206;
  whole.headers.push_back(content_range(wanted.part, size));
  whole.body = whole.body.substr(first, last - first + 1);
  return whole;
}

}  // namespace watertight::server
