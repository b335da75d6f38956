// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers of one stored feature: they return it in the format that the client wants, or delete it.
#include <array>
#include <charconv>
#include <optional>

#include "base/checksum.h"
#include "pipeline/container.h"
#include "server/handlers.h"

namespace watertight::server {
namespace {

struct ItemFormat {
  std::string_view parameter;  // value of f=
  std::string_view type;
};

constexpr std::array<ItemFormat, 6> kFormats{{{"cityjson", kCityJson},
                                              {"json", kJson},
                                              {"cityjsonseq", kCityJsonSeq},
                                              {"obj", kObj},
                                              {"wt", kContainer},
                                              {"blob", kBlob}}};

std::optional<ItemFormat> chosen_format(const RoutedRequest& request) {
  const std::string* wanted = request.target.parameter("f");
  if (wanted != nullptr) {
    for (const ItemFormat& format : kFormats) {
      if (format.parameter == *wanted) return format;
    }
    return std::nullopt;
  }
  std::vector<std::string_view> offers;
  for (const ItemFormat& format : kFormats) offers.push_back(format.type);
  const auto chosen = negotiate(request.request.header("accept"), offers);
  if (!chosen) return std::nullopt;
  return kFormats[*chosen];
}

/// The entity tag of a representation. Versions are never used twice, so version, format and the
/// number of the solid are enough.
std::string etag_of(const StoredFeature& feature, const RoutedRequest& request,
                    const ItemFormat& format) {
  std::string etag = "\"";
  etag += std::to_string(feature.version);
  etag += '-';
  etag += format.parameter;
  const std::string* solid = request.target.parameter("solid");
  if (solid != nullptr) {
    etag += '-';
    etag += percent_encode(*solid);
  }
  etag += '"';
  return etag;
}

/// Whether a list of tags, compared weakly, has the tag (RFC 9110, section 13.1.2).
bool is_listed(std::string_view list, std::string_view etag) {
  if (list == "*") return true;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    std::string_view tag = list.substr(0, comma);
    while (tag.starts_with(' ')) tag.remove_prefix(1);
    while (tag.ends_with(' ')) tag.remove_suffix(1);
    if (tag.starts_with("W/")) tag.remove_prefix(2);
    if (tag == etag) return true;
    list = comma == std::string_view::npos ? std::string_view{} : list.substr(comma + 1);
  }
  return false;
}

Result<Bytes> blob_of(const StoredFeature& feature, const Target& target) {
  const std::string* text = target.parameter("solid");
  const std::string count = std::to_string(feature.solids.size());
  if (feature.solids.empty()) {
    return Error{ErrorCode::not_encodable, "this feature has no solids, so there is no blob of it"};
  }
  std::size_t solid = 0;
  if (text != nullptr) {
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), solid);
    if (error != std::errc{} || end != text->data() + text->size() ||
        solid >= feature.solids.size()) {
      return Error{ErrorCode::invalid_argument, "solid counts from 0; this feature has " + count};
    }
  } else if (feature.solids.size() != 1) {
    return Error{ErrorCode::invalid_argument,
                 "this feature has " + count +
                     " solids: choose one with solid=0, ..., or use f=wt for all in one file"};
  }
  return feature.solids[solid].blob;
}

Result<Bytes> represent(StoredFeature feature, const ItemFormat& format,
                        const RoutedRequest& request) {
  if (format.parameter == "blob") return blob_of(feature, request.target);
  if (format.parameter == "wt") {
    auto encoded = pipeline::unpack(std::move(feature));
    if (!encoded) return std::move(encoded).error();
    pipeline::EncodedDocument document{encoded->format, encoded->header, {}, {}};
    document.features.push_back(*std::move(encoded));
    return pipeline::write_container(document, {}, pipeline::SolidLayout::blobs);
  }
  auto document = pipeline::from_stored(std::move(feature), request.service.options.limits);
  if (!document) {
    return Error{ErrorCode::unavailable,
                 "the stored feature cannot be decoded: " + to_string(document.error())};
  }
  Format target = Format::city_json;
  if (format.parameter == "obj") target = Format::obj;
  if (format.parameter == "cityjsonseq") target = Format::city_json_seq;
  return pipeline::convert_document(*document, target);
}

}  // namespace

Response get_item(const RoutedRequest& request) {
  const auto format = chosen_format(request);
  if (!format) {
    return refuse(
        406, "not-acceptable",
        "an item is available as application/city+json (f=cityjson), application/json (f=json), "
        "application/city+json-seq (f=cityjsonseq), model/obj (f=obj), "
        "application/vnd.watertight (f=wt) or application/vnd.watertight.blob (f=blob)");
  }
  if (request.target.parameter("solid") != nullptr && format->parameter != "blob") {
    return refuse(400, "invalid-argument", "the parameter solid is for f=blob only");
  }
  auto feature = request.service.store->get(request.target.segments[1], request.target.segments[3]);
  if (!feature) return to_response(to_problem(feature.error()));
  const std::string etag = etag_of(*feature, request, *format);
  const std::vector<HeaderField> headers{
      {"ETag", etag}, {"Vary", "Accept"}, {"Content-Crs", crs_header(feature->srid)}};
  const std::string* known = request.request.header("if-none-match");
  if (known != nullptr && is_listed(*known, etag)) return Response{304, "", "", headers};
  auto body = represent(*std::move(feature), *format, request);
  if (!body) {
    Problem problem = to_problem(body.error());
    // The feature is there, but not in this format.
    if (body.error().code == ErrorCode::unsupported) problem.status = 406;
    if (body.error().code == ErrorCode::not_encodable) problem.status = 406;
    return to_response(problem);
  }
  return Response{200, std::string(format->type), std::string(as_text(*body)), headers};
}

Response delete_item(const RoutedRequest& request) {
  const Status status =
      request.service.store->remove(request.target.segments[1], request.target.segments[3]);
  if (!status) return to_response(to_problem(status.error()));
  return Response{204, "", "", {}};
}

}  // namespace watertight::server
