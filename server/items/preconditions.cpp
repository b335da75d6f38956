// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/items/preconditions.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include "server/features/answer_coding.h"

namespace watertight::server {
namespace {

/// The tags of a list, with their quotes. A tag has no comma, as this service makes them.
std::vector<std::string_view> tags_of(std::string_view list) {
  std::vector<std::string_view> tags;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    std::string_view tag = list.substr(0, comma);
    while (tag.starts_with(' ') || tag.starts_with('\t')) tag.remove_prefix(1);
    while (tag.ends_with(' ') || tag.ends_with('\t')) tag.remove_suffix(1);
    if (!tag.empty()) tags.push_back(tag);
    list = comma == std::string_view::npos ? std::string_view{} : list.substr(comma + 1);
  }
  return tags;
}

/// Whether a tag, or that of its representation when it is compressed, is in a list.
bool is_listed(std::string_view list, std::string_view etag, bool is_weak) {
  std::string compressed(etag);
  if (!compressed.empty()) compressed.insert(compressed.size() - 1, kGzipTag);
  for (std::string_view tag : tags_of(list)) {
    if (tag == "*") return true;
    if (is_weak && tag.starts_with("W/")) tag.remove_prefix(2);
    if (tag == etag || tag == compressed) return true;
  }
  return false;
}

/// The version in a tag of etag_of(); nothing for a tag that this service did not make.
std::optional<std::uint64_t> version_of(std::string_view tag) {
  if (!tag.starts_with('"') || !tag.ends_with('"')) return std::nullopt;
  std::uint64_t version = 0;
  const char* const end = tag.data() + tag.size();
  const auto [rest, error] = std::from_chars(tag.data() + 1, end, version);
  if (error != std::errc{} || rest == end || *rest != '-') return std::nullopt;
  return version;
}

}  // namespace

std::string etag_of(std::uint64_t version, std::string_view representation) {
  std::string etag = "\"";
  etag += std::to_string(version);
  etag += '-';
  etag += representation;
  return etag += '"';
}

std::string etag_of_state(std::string_view state, std::string_view representation) {
  std::string etag = "\"";
  etag.append(state).append("-").append(representation);
  return etag += '"';
}

std::optional<Response> unless_needed(const Request& request, const std::string& etag) {
  const std::string* wanted = request.header("if-match");
  if (wanted != nullptr && !is_listed(*wanted, etag, false)) {
    return refuse(412, "precondition-failed", "the representation has the tag " + etag);
  }
  const std::string* known = request.header("if-none-match");
  if (known != nullptr && is_listed(*known, etag, true)) {
    return Response{304, "", "", {{"ETag", etag}, {"Vary", "Accept"}}};
  }
  return std::nullopt;
}

Result<store::WriteCondition> write_condition(const Request& request) {
  using Kind = store::WriteCondition::Kind;
  const std::string* match = request.header("if-match");
  const std::string* none_match = request.header("if-none-match");
  if (none_match != nullptr) {
    if (match != nullptr || *none_match != "*") {
      return Error{ErrorCode::invalid_argument,
                   "a write takes If-Match, or If-None-Match: *, but not both"};
    }
    return store::WriteCondition{Kind::absent, {}};
  }
  if (match == nullptr) return store::WriteCondition{};
  if (*match == "*") return store::WriteCondition{Kind::present, {}};
  store::WriteCondition condition{Kind::versions, {}};
  for (const std::string_view tag : tags_of(*match)) {
    if (const auto version = version_of(tag)) condition.versions.push_back(*version);
  }
  return condition;
}

bool has_precondition(const Request& request) {
  return request.header("if-match") != nullptr || request.header("if-none-match") != nullptr;
}

std::optional<Response> unless_same_state(const Request& request, const std::string& state) {
  const std::string start = etag_of_state(state, "");
  const auto is_of_state = [&](std::string_view list) {
    const auto tags = tags_of(list);
    return std::any_of(tags.begin(), tags.end(), [&](std::string_view tag) {
      return tag == "*" || tag.starts_with(std::string_view(start).substr(0, start.size() - 1));
    });
  };
  const std::string* match = request.header("if-match");
  const std::string* none_match = request.header("if-none-match");
  const bool holds = (match == nullptr || is_of_state(*match)) &&
                     (none_match == nullptr || !is_of_state(*none_match));
  if (holds) return std::nullopt;
  return refuse(412, "precondition-failed",
                "the collection has the tag " + etag_of_state(state, "json"));
}

std::optional<Response> unless_conditional(const RoutedRequest& request) {
  if (!request.service.options.requires_preconditions || has_precondition(request.request)) {
    return std::nullopt;
  }
  return refuse(428, "precondition-required",
                "a write needs If-Match with the ETag of what it changes, or If-None-Match: *");
}

}  // namespace watertight::server
