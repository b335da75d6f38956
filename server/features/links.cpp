// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/features/links.h"

#include <algorithm>

#include "base/ascii.h"

namespace watertight::server {
namespace {

bool is_one_of(char c, std::string_view others) {
  const char lower = lower_case(c);
  return (lower >= 'a' && lower <= 'z') || (c >= '0' && c <= '9') ||
         others.find(c) != std::string_view::npos;
}

/// Whether the text can be a host with a port: other text could end the URL that it is put in.
bool is_host(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_one_of(c, ".-_:[]"); });
}

bool is_path(std::string_view text) {
  return text.starts_with('/') && text.find("//") == std::string_view::npos &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_one_of(c, "/.-_~%"); });
}

bool is_scheme(std::string_view text) { return text == "http" || text == "https"; }

std::string_view trimmed(std::string_view text) {
  const std::string_view blanks = " \t\"";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The first entry of a list with commas: the proxy that is nearest to the client.
std::string_view first_of(const std::string* list) {
  if (list == nullptr) return {};
  return trimmed(std::string_view(*list).substr(0, list->find(',')));
}

/// The value of a parameter of a Forwarded field (RFC 7239); "" without it.
std::string_view forwarded(std::string_view entry, std::string_view name) {
  while (!entry.empty()) {
    const std::size_t end = std::min(entry.find(';'), entry.size());
    const std::string_view pair = trimmed(entry.substr(0, end));
    const std::size_t equals = pair.find('=');
    const bool is_wanted =
        equals == name.size() &&
        std::equal(name.begin(), name.end(), pair.begin(),
                   [](char wanted, char found) { return wanted == lower_case(found); });
    if (is_wanted) return trimmed(pair.substr(equals + 1));
    entry.remove_prefix(std::min(end + 1, entry.size()));
  }
  return {};
}

}  // namespace

std::string base_url(const RoutedRequest& request) {
  if (!request.service.options.base_url.empty()) return request.service.options.base_url;
  const Request& message = request.request;
  const std::string_view entry = first_of(message.header("forwarded"));
  std::string_view scheme = forwarded(entry, "proto");
  std::string_view host = forwarded(entry, "host");
  if (!is_scheme(scheme)) scheme = first_of(message.header("x-forwarded-proto"));
  if (!is_host(host)) host = first_of(message.header("x-forwarded-host"));
  if (!is_host(host)) host = first_of(message.header("host"));
  if (!is_host(host)) return {};
  std::string_view prefix = first_of(message.header("x-forwarded-prefix"));
  while (prefix.ends_with('/')) prefix.remove_suffix(1);
  const std::string_view own = request.service.options.is_encrypted ? "https" : "http";
  std::string url(is_scheme(scheme) ? scheme : own);
  url.append("://").append(host);
  if (is_path(prefix)) url.append(prefix);
  return url;
}

Status check_base_url(std::string_view url) {
  const std::size_t colon = url.find("://");
  if (colon != std::string_view::npos && is_scheme(url.substr(0, colon))) {
    const std::string_view rest = url.substr(colon + 3);
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    const std::string_view path = rest.substr(slash);
    if (is_host(rest.substr(0, slash)) && (path.empty() || is_path(path))) return Done{};
  }
  return Error{ErrorCode::invalid_argument,
               std::string(url) +
                   " is no URL to which paths can be added (example: https://example.org/solids)"};
}

}  // namespace watertight::server
