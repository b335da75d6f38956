// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/features/answer_coding.h"

#include <algorithm>
#include <charconv>
#include <memory>

#include "archives/gzip.h"
#include "base/ascii.h"

namespace watertight::server {
namespace {

constexpr std::size_t kLeastBytes = 1024;  // below, the fields of a compressed answer cost more

std::string_view trimmed(std::string_view text) {
  const std::size_t start = std::min(text.find_first_not_of(" \t"), text.size());
  return text.substr(start, text.find_last_not_of(" \t") + 1 - start);
}

/// The quality of "gzip;q=0.5"; 1 without one, 0 for one that is no number.
double quality_of(std::string_view parameters) {
  const std::size_t at = parameters.find("q=");
  if (at == std::string_view::npos) return 1;
  const std::string_view text = trimmed(parameters.substr(at + 2));
  double quality = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), quality);
  return error == std::errc{} && end == text.data() + text.size() ? quality : 0;
}

Response compressed(Response response) {
  auto packed = archives::gzip(response.body, archives::Effort::fast);
  if (!packed) return response;
  response.body = *std::move(packed);
  response.headers.push_back({"Content-Encoding", "gzip"});
  for (HeaderField& field : response.headers) {
    if (field.name == "ETag" && field.value.ends_with('"')) {
      field.value.insert(field.value.size() - 1, kGzipTag);
    }
  }
  return response;
}

}  // namespace

bool takes_gzip(const Request& request) {
  const std::string* accepted = request.header("accept-encoding");
  if (accepted == nullptr) return false;
  const std::string list = lower_case(*accepted);
  double of_all = 0;
  for (std::string_view rest = list; !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view entry = rest.substr(0, comma);
    rest.remove_prefix(std::min(rest.size(), comma + 1));
    const std::size_t semicolon = std::min(entry.find(';'), entry.size());
    const std::string_view name = trimmed(entry.substr(0, semicolon));
    const double quality = quality_of(entry.substr(semicolon));
    if (name == "gzip" || name == "x-gzip") return quality > 0;
    if (name == "*") of_all = quality;
  }
  return of_all > 0;
}

bool is_compressible(std::string_view type) {
  type = type.substr(0, type.find(';'));
  constexpr std::string_view kOthers[] = {kJson, kObj, "model/vnd.off", kCityJsonSeq};
  return type.starts_with("text/") || type.ends_with("+json") || type.ends_with("+xml") ||
         std::find(std::begin(kOthers), std::end(kOthers), type) != std::end(kOthers);
}

Response with_coding(const Request& request, Response response) {
  if (const auto work = response.further) {
    response.further = std::make_shared<const FurtherWork>(
        FurtherWork{work->lane, work->key, [request, work](const CancelPoll& is_cancelled) {
                      return with_coding(request, work->make(is_cancelled));
                    }});
    return response;
  }
  if (response.status != 200 || !is_compressible(response.content_type) || response.rest) {
    return response;
  }
  response.headers.push_back({"Vary", "Accept-Encoding"});
  const bool is_long = response.body.size() >= kLeastBytes;
  return is_long && takes_gzip(request) ? compressed(std::move(response)) : response;
}

}  // namespace watertight::server
