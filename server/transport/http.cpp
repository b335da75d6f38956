// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/http.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "base/ascii.h"

namespace watertight::server {
namespace {

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  c = lower_case(c);
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Cuts the part before `separator` off the front of `text`.
std::string_view cut(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  return part;
}

Error malformed_target(std::string message) {
  return Error{ErrorCode::malformed, std::move(message), {}, {}};
}

/// Length of the UTF-8 sequence at the front of `text`, 0 if there is none (RFC 3629, section 4).
std::size_t utf8_sequence(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  std::size_t length = 0;
  unsigned char low = 0x80;
  unsigned char high = 0xBF;
  if (first >= 0xC2 && first <= 0xDF) length = 2;
  if (first >= 0xE0 && first <= 0xEF) length = 3;
  if (first >= 0xF0 && first <= 0xF4) length = 4;
  if (length == 0 || text.size() < length) return 0;
  if (first == 0xE0) low = 0xA0;
  if (first == 0xED) high = 0x9F;
  if (first == 0xF0) low = 0x90;
  if (first == 0xF4) high = 0x8F;
  if (byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if (byte(i) < 0x80 || byte(i) > 0xBF) return 0;
  }
  return length;
}

struct MediaRange {
  std::string type;  // "application/json", "application/*" or "*/*"
  double quality = 1;
};

double parse_quality(std::string_view text) {
  double value = 1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0)) return 0;
  return std::min(value, 1.0);
}

std::vector<MediaRange> parse_accept(std::string_view accept) {
  std::vector<MediaRange> ranges;
  while (!accept.empty()) {
    std::string_view item = cut(accept, ',');
    MediaRange range{media_type(cut(item, ';')), 1};
    while (!item.empty()) {
      const std::string_view parameter = trim(cut(item, ';'));
      if (parameter.starts_with("q=") || parameter.starts_with("Q=")) {
        range.quality = parse_quality(parameter.substr(2));
      }
    }
    if (!range.type.empty()) ranges.push_back(std::move(range));
  }
  return ranges;
}

/// How closely a range names an offer: 3 exactly, 2 by "type/*", 1 by "*/*", 0 not at all.
int specificity(const MediaRange& range, std::string_view offer) {
  if (range.type == offer) return 3;
  if (range.type == "*/*") return 1;
  const std::size_t slash = range.type.find('/');
  const bool is_subtype_range =
      slash != std::string::npos && std::string_view(range.type).substr(slash) == "/*";
  return is_subtype_range && offer.starts_with(std::string_view(range.type).substr(0, slash + 1))
             ? 2
             : 0;
}

}  // namespace

const std::string* Request::header(std::string_view name) const {
  for (const HeaderField& field : headers) {
    if (field.name == name) return &field.value;
  }
  return nullptr;
}

std::string_view reason_phrase(unsigned status) {
  using Phrase = std::pair<unsigned, std::string_view>;
  static constexpr Phrase kPhrases[] = {{200, "OK"},
                                        {201, "Created"},
                                        {204, "No Content"},
                                        {206, "Partial Content"},
                                        {304, "Not Modified"},
                                        {400, "Bad Request"},
                                        {401, "Unauthorized"},
                                        {403, "Forbidden"},
                                        {404, "Not Found"},
                                        {405, "Method Not Allowed"},
                                        {406, "Not Acceptable"},
                                        {408, "Request Timeout"},
                                        {409, "Conflict"},
                                        {411, "Length Required"},
                                        {412, "Precondition Failed"},
                                        {413, "Content Too Large"},
                                        {415, "Unsupported Media Type"},
                                        {416, "Range Not Satisfiable"},
                                        {421, "Misdirected Request"},
                                        {422, "Unprocessable Content"},
                                        {428, "Precondition Required"},
                                        {429, "Too Many Requests"},
                                        {431, "Request Header Fields Too Large"},
                                        {500, "Internal Server Error"},
                                        {501, "Not Implemented"},
                                        {503, "Service Unavailable"},
                                        {505, "HTTP Version Not Supported"},
                                        {507, "Insufficient Storage"}};
  for (const auto& [known, phrase] : kPhrases) {
    if (known == status) return phrase;
  }
  return "Unknown";
}

Result<std::string> percent_decode(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      const int high = i + 2 < text.size() ? hex_value(text[i + 1]) : -1;
      const int low = i + 2 < text.size() ? hex_value(text[i + 2]) : -1;
      if (high < 0 || low < 0) {
        return malformed_target("'%' in the URL is not followed by two hexadecimal digits");
      }
      c = static_cast<char>(high * 16 + low);
      i += 2;
    }
    if (c == '\0') return malformed_target("the URL contains a NUL");
    decoded.push_back(c);
  }
  if (!is_utf8(decoded)) return malformed_target("the URL is not UTF-8");
  return decoded;
}

std::string percent_encode(std::string_view text) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : text) {
    const bool is_unreserved = (lower_case(c) >= 'a' && lower_case(c) <= 'z') ||
                               (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_' ||
                               c == '~';
    if (is_unreserved) {
      encoded.push_back(c);
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    encoded.push_back('%');
    encoded.push_back(kHex[byte / 16U]);
    encoded.push_back(kHex[byte % 16U]);
  }
  return encoded;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_sequence(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

const std::string* Target::parameter(std::string_view name) const {
  for (const auto& [key, value] : parameters) {
    if (key == name) return &value;
  }
  return nullptr;
}

Result<Target> parse_target(std::string_view target) {
  // Every server must accept the absolute form (RFC 9112, section 3.2.2).
  if (target.starts_with("http://") && target.find('/', 7) != std::string_view::npos) {
    target.remove_prefix(target.find('/', 7));
  }
  if (target.empty() || target.front() != '/') {
    return malformed_target("the request target must be an absolute path");
  }
  Target parsed;
  std::string_view query = target.substr(0, target.find('#'));
  std::string_view path = cut(query, '?').substr(1);
  // A path with one slash at its end names the same resource.
  if (path.ends_with('/')) path.remove_suffix(1);
  while (!path.empty()) {
    const bool is_last = path.find('/') == std::string_view::npos;
    auto segment = percent_decode(cut(path, '/'));
    if (!segment) return std::move(segment).error();
    if (segment->empty() || (path.empty() && !is_last)) {
      return malformed_target("the path contains an empty segment");
    }
    parsed.segments.push_back(*std::move(segment));
  }
  while (!query.empty()) {
    std::string text(cut(query, '&'));
    if (text.empty()) continue;
    std::replace(text.begin(), text.end(), '+', ' ');
    std::string_view value = text;
    auto name = percent_decode(cut(value, '='));
    if (!name) return std::move(name).error();
    auto decoded = percent_decode(value);
    if (!decoded) return std::move(decoded).error();
    if (parsed.parameter(*name) != nullptr) {
      return Error{
          ErrorCode::invalid_argument, "the parameter '" + *name + "' is given twice", {}, {}};
    }
    parsed.parameters.emplace_back(*std::move(name), *std::move(decoded));
  }
  return parsed;
}

std::string media_type(std::string_view content_type) {
  return lower_case(trim(cut(content_type, ';')));
}

std::optional<std::size_t> negotiate(const std::string* accept,
                                     const std::vector<std::string_view>& offers) {
  if (offers.empty()) return std::nullopt;
  if (accept == nullptr || trim(*accept).empty()) return 0;
  const std::vector<MediaRange> ranges = parse_accept(*accept);
  std::optional<std::size_t> best;
  double best_quality = 0;
  for (std::size_t i = 0; i < offers.size(); ++i) {
    int closest = 0;
    double quality = 0;
    for (const MediaRange& range : ranges) {
      const int fit = specificity(range, offers[i]);
      if (fit > closest) {
        closest = fit;
        quality = range.quality;
      }
    }
    if (quality > best_quality) {
      best = i;
      best_quality = quality;
    }
  }
  return best;
}

}  // namespace watertight::server
