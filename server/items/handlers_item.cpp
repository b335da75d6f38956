// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers of one stored feature: they return it in the format that the client wants, or delete it.
#include <array>
#include <charconv>
#include <memory>
#include <optional>

#include "pipeline/container.h"
#include "pipeline/outcome_json.h"
#include "pipeline/structure.h"
#include "server/features/feature_text.h"
#include "server/features/links.h"
#include "server/features/pages.h"
#include "server/handlers.h"
#include "server/items/preconditions.h"
#include "server/items/ranges.h"
#include "server/items/representation_cache.h"
#include "server/scene/stored_mesh.h"

namespace watertight::server {
namespace {

struct ItemFormat {
  std::string_view parameter;  // value of f=
  std::string_view type;
};

constexpr std::array<ItemFormat, 15> kFormats{{{"cityjson", kCityJson},
                                               {"jsonfg", kJsonFg},
                                               {"html", kHtml},
                                               {"geojson", kGeoJson},
                                               {"json", kJson},
                                               {"cityjsonseq", kCityJsonSeq},
                                               {"gml", kGml},
                                               {"obj", kObj},
                                               {"wkt", "text/wkt"},
                                               {"ewkb", "application/ewkb"},
                                               {"glb", kGltf},
                                               {"wt", kContainer},
                                               {"blob", kBlob},
                                               {"proof", kJson},
                                               {"structure", kJson}}};

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

/// The request for one representation of one feature, apart from the message that stated it, so
/// that another thread can answer it later.
struct ItemRequest {
  Service service;
  std::string collection;
  std::string id;
  ItemFormat format;
  std::string solid;  // the parameter `solid`, "" if there is none
  FeatureForm form;   // of GeoJSON and JSON-FG; others are in the storage CRS
  Request message;    // of a GET or HEAD, so without a body

  std::string links = {};  // the value of a field Link

  /// The word that names the representation in its tag.
  std::string representation() const {
    if (is_geo_json()) return form.name() + (is_profile() ? "-profile" : "");
    std::string name(format.parameter);
    if (!solid.empty()) name += '-' + percent_encode(solid);
    return name;
  }
  /// Whether the type of the answer is that of GeoJSON, but it is JSON-FG.
  bool is_profile() const { return form.is_json_fg && format.type == kGeoJson; }
  bool is_geo_json() const { return format.parameter == "geojson" || form.is_json_fg; }
  /// The key of the newest answer that was made.
  std::string key() const { return collection + '/' + id + '/' + representation(); }
};

Result<Bytes> blob_of(const StoredFeature& feature, const std::string& text, const Limits& limits) {
  const std::string count = std::to_string(feature.solids.size());
  if (feature.solids.empty()) {
    return Error{ErrorCode::not_encodable, "this feature has no solids, so there is no blob of it"};
  }
  std::size_t solid = 0;
  if (!text.empty()) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), solid);
    if (error != std::errc{} || end != text.data() + text.size() ||
        solid >= feature.solids.size()) {
      return Error{ErrorCode::invalid_argument, "solid counts from 0; this feature has " + count};
    }
  } else if (feature.solids.size() != 1) {
    return Error{ErrorCode::invalid_argument,
                 "this feature has " + count +
                     " solids: choose one with solid=0, ..., or use f=wt for all in one file"};
  }
  if (!feature.solids[solid].is_proven) {
    return Error{ErrorCode::not_encodable, "this solid is not proven, so there is no blob of it"};
  }
  return pipeline::blob_of(feature, solid, limits);
}

Bytes bytes_of(std::string_view text) {
  const ByteView bytes = as_bytes(text);
  return {bytes.begin(), bytes.end()};
}

/// The inside of the solids of a feature.
Result<Bytes> structure_of(StoredFeature feature, const ItemRequest& item,
                           const CancelPoll& is_cancelled) {
  const std::size_t text_bytes = feature.skeleton.bytes.size();
  const auto encoded = pipeline::unpack(std::move(feature), {}, pipeline::Reports::none);
  if (!encoded) return encoded.error();
  CertifyOptions options;
  options.limits = item.service.options.limits;
  options.ladder.cancel = is_cancelled;
  const auto text = pipeline::structure_json(*encoded, text_bytes, item.service.workers, options);
  if (!text) return text.error();
  return bytes_of(*text + "\n");
}

Result<Bytes> represent(StoredFeature feature, const ItemRequest& item,
                        const CancelPoll& is_cancelled) {
  const std::string_view format = item.format.parameter;
  if (item.is_geo_json()) {
    const std::uint32_t srid = feature.srid;
    auto text = FeatureWriter(item.form, item.service.options.limits).write(std::move(feature));
    if (!text) return std::move(text).error();
    if (item.form.is_json_fg) text->insert(1, json_fg_head(item.form.system, srid));
    return bytes_of(*text + "\n");
  }
  if (format == "html") {
    const auto text = FeatureWriter({}, item.service.options.limits).write(std::move(feature));
    if (!text) return text.error();
    return bytes_of(item_page(item.collection, Json::parse(*text)));
  }
  if (format == "glb") return glb_of_feature(std::move(feature), item.service.options.limits);
  if (format == "blob") return blob_of(feature, item.solid, item.service.options.limits);
  if (format == "structure") return structure_of(std::move(feature), item, is_cancelled);
  if (format == "proof") {
    const auto encoded = pipeline::unpack(std::move(feature));
    if (!encoded) return encoded.error();
    return bytes_of(pipeline::proof_json(*encoded) + "\n");
  }
  if (format == "wt") {
    auto encoded = pipeline::unpack(std::move(feature), {}, pipeline::Reports::of_unproven);
    if (!encoded) return std::move(encoded).error();
    pipeline::EncodedDocument document{encoded->format, encoded->header, {}, {}};
    document.features.push_back(*std::move(encoded));
    return pipeline::write_container(document, {.layout = pipeline::SolidLayout::blobs});
  }
  auto document = pipeline::from_stored(std::move(feature), item.service.options.limits);
  if (!document) {
    return Error{ErrorCode::unavailable,
                 "the stored feature cannot be decoded: " + to_string(document.error())};
  }
  Format target = Format::city_json;
  if (format == "gml") target = Format::gml;
  if (format == "obj") target = Format::obj;
  if (format == "wkt") target = Format::wkt;
  if (format == "ewkb") target = Format::ewkb;
  if (format == "cityjsonseq") target = Format::city_json_seq;
  return pipeline::convert_document(*document, target);
}

/// The answer with the links that the client needs; they depend on its name for the service, so the
/// cache does not have them.
Response linked(const ItemRequest& item, Response response) {
  if (response.status < 300 && item.is_geo_json()) response.headers.push_back({"Link", item.links});
  return response;
}

/// The representation of a feature that was read, which the cache keeps.
Response represented(StoredFeature feature, const ItemRequest& item,
                     const CancelPoll& is_cancelled) {
  const std::uint64_t version = feature.version;
  const std::vector<HeaderField> headers{
      {"ETag", etag_of(version, item.representation())},  // first, for cached()
      {"Vary", "Accept"},
      {"Content-Crs", content_crs(item.form.system, feature.srid)}};
  auto body = represent(std::move(feature), item, is_cancelled);
  if (!body) {
    Problem problem = to_problem(body.error());
    // The feature is there, but not in this format.
    if (body.error().code == ErrorCode::unsupported) problem.status = 406;
    if (body.error().code == ErrorCode::not_encodable) problem.status = 406;
    return to_response(problem);
  }
  const std::string_view type = item.format.type == kHtml ? kHtmlPage : item.format.type;
  Response response{200, std::string(type), std::string(as_text(*body)), headers};
  if (RepresentationCache* cache = item.service.cache) {
    cache->keep(item.key(), std::make_shared<const Response>(response));
  }
  return linked(item, in_range(item.message, std::move(response)));
}

/// The answer that the cache has, for the newest version of the feature or an older one.
RepresentationCache::Answer kept_answer(const ItemRequest& item) {
  return item.service.cache == nullptr ? nullptr : item.service.cache->find(item.key());
}

/// The answer that the cache has for this version of the feature.
std::optional<Response> cached(const ItemRequest& item, std::uint64_t version) {
  const auto kept = kept_answer(item);
  if (!kept || kept->headers.front().value != etag_of(version, item.representation())) {
    return std::nullopt;
  }
  return linked(item, in_range(item.message, *kept));
}

/// The answer that needs the feature's version alone: that of the cache, 304 or 412 by the
/// request's preconditions, or an error. One query, which a request for what nobody has asked for
/// goes without.
std::optional<Response> answered_by_version(const ItemRequest& item) {
  const auto version = item.service.store->version(item.collection, item.id);
  if (!version) return to_response(to_problem(version.error()));
  if (auto unneeded = unless_needed(item.message, etag_of(*version, item.representation()))) {
    return unneeded;
  }
  return cached(item, *version);
}

Response in_lane(Lane lane, std::string key, std::function<Response(const CancelPoll&)> make) {
  Response response;
  response.further =
      std::make_shared<const FurtherWork>(FurtherWork{lane, std::move(key), std::move(make)});
  return response;
}

/// Reads the feature and makes its representation; leaves a large one to the lane for that.
Response read_and_represent(const ItemRequest& item, const CancelPoll& is_cancelled) {
  auto feature = item.service.store->get(item.collection, item.id);
  if (!feature) return to_response(to_problem(feature.error()));
  if (item.format.parameter == "blob" || !is_large(*feature)) {
    return represented(*std::move(feature), item, is_cancelled);
  }
  const auto large = std::make_shared<StoredFeature>(*std::move(feature));
  return in_lane(Lane::computing, {}, [large, item](const CancelPoll& is_stopped) {
    return represented(std::move(*large), item, is_stopped);
  });
}

/// The work that makes the answer; `kept` is the answer that the cache had when it was asked for.
Response to_be_made(const ItemRequest& item, const RepresentationCache::Answer& kept) {
  return in_lane(Lane::items, item.key(), [item, kept](const CancelPoll& is_cancelled) {
    // A request for the same may have been answered meanwhile.
    if (kept_answer(item) != kept) {
      if (auto answered = answered_by_version(item)) return *std::move(answered);
    }
    return read_and_represent(item, is_cancelled);
  });
}

/// The answer that the version gives, or the work that makes one.
Response answered_or_to_be_made(const ItemRequest& item) {
  const auto kept = kept_answer(item);
  if (has_precondition(item.message) || kept) {
    if (auto answered = answered_by_version(item)) return *std::move(answered);
  }
  return to_be_made(item, kept);
}

/// The links of a feature to itself, its collection and its profile (RFC 8288).
std::string links_of_item(const RoutedRequest& request, bool is_json_fg) {
  const std::string base = base_url(request);
  std::string links = "<";
  links.append(base).append(item_path(request.target.segments[1], request.target.segments[3]));
  links.append(">; rel=\"self\", <").append(base).append("/collections/");
  links.append(percent_encode(request.target.segments[1])).append(">; rel=\"collection\", <");
  return links.append(profile_uri(is_json_fg)).append(">; rel=\"profile\"");
}

}  // namespace

Response get_item(const RoutedRequest& request) {
  const auto format = chosen_format(request);
  if (!format) {
    return refuse(
        406, "not-acceptable",
        "an item is available as application/city+json (f=cityjson), application/json (f=json), "
        "application/geo+json (f=geojson), application/vnd.ogc.fg+json (f=jsonfg), text/html "
        "(f=html), "
        "application/city+json-seq (f=cityjsonseq), application/gml+xml (f=gml), model/obj "
        "(f=obj), text/wkt (f=wkt), "
        "application/ewkb (f=ewkb), model/gltf-binary (f=glb), "
        "application/vnd.watertight (f=wt) or application/vnd.watertight.blob (f=blob), its proofs "
        "and findings with f=proof, the tetrahedra in its solids with f=structure");
  }
  const std::string* solid = request.target.parameter("solid");
  if (solid != nullptr && format->parameter != "blob") {
    return refuse(400, "invalid-argument", "the parameter solid is for f=blob only");
  }
  const bool is_json_fg = format->parameter == "jsonfg" ||
                          (format->parameter == "geojson" && wants_json_fg(request.target));
  const bool has_form = is_json_fg || format->parameter == "geojson";
  const bool states_form =
      request.target.parameter("crs") != nullptr || request.target.parameter("lod") != nullptr;
  if (states_form && !has_form) {
    return refuse(400, "invalid-argument",
                  "the parameters crs and lod are for f=geojson and f=jsonfg only");
  }
  ItemRequest item{request.service,
                   request.target.segments[1],
                   request.target.segments[3],
                   *format,
                   solid == nullptr ? std::string() : *solid,
                   FeatureForm{false, PlaceSystem::storage, std::nullopt},
                   request.request,
                   has_form ? links_of_item(request, is_json_fg) : std::string()};
  if (!has_form && !has_precondition(request.request) && kept_answer(item) == nullptr) {
    return to_be_made(item, nullptr);
  }
  return in_lane(Lane::reading, {}, [=, target = request.target](const CancelPoll&) {
    ItemRequest formed = item;
    if (has_form) {
      const auto collection = item.service.store->collection(item.collection);
      if (!collection) return to_response(to_problem(collection.error()));
      const auto form = FeatureForm::of_request(target, collection->srid, is_json_fg);
      if (!form) return to_response(to_problem(form.error()));
      formed.form = *form;
    }
    return answered_or_to_be_made(formed);
  });
}

Response delete_item(const RoutedRequest& request) {
  if (auto refusal = unless_conditional(request)) return *std::move(refusal);
  const auto condition = write_condition(request.request);
  if (!condition) return to_response(to_problem(condition.error()));
  const Status status = request.service.store->remove(request.target.segments[1],
                                                      request.target.segments[3], *condition);
  if (!status) return to_response(to_problem(status.error()));
  return Response{204, "", "", {}};
}

}  // namespace watertight::server
