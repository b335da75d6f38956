// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers that only read: landing, health, lists of items.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "pipeline/stored/attributes.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

constexpr std::string_view kUnknownCrs = "http://www.opengis.net/def/nil/OGC/0/unknown";

constexpr std::string_view kHtml = "text/html";
constexpr std::string_view kOpenApiType = "application/vnd.oai.openapi+json;version=3.0";
constexpr std::string_view kTitle = "Watertight";
constexpr std::string_view kDescription = "Validates, stores and compresses 3D solids";

/// The landing page in HTML. It has the links of the page in JSON, and loads nothing from
/// elsewhere.
std::string landing_html(const Json& links) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta "
      "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n<title>";
  html.append(kTitle).append("</title>\n<style>body{font:16px/1.5 sans-serif;margin:3em auto;");
  html.append("max-width:40em;padding:0 1em}</style>\n<h1>").append(kTitle).append("</h1>\n<p>");
  html.append(kDescription).append(".</p>\n<ul>\n");
  for (const Json& item : links) {
    const auto href = item["href"].get<std::string>();
    html.append("<li><a href=\"").append(href).append("\"><code>").append(href);
    html.append("</code></a> ").append(item["title"].get<std::string>()).append("</li>\n");
  }
  return html.append("</ul>\n</html>\n");
}

/// The type of the landing page by `f` or the Accept header; nullopt when the client wants neither
/// JSON nor HTML.
std::optional<std::string_view> landing_type(const RoutedRequest& request) {
  if (const std::string* format = request.target.parameter("f")) {
    if (*format == "json") return kJson;
    if (*format == "html") return kHtml;
    return std::nullopt;
  }
  const auto offer = negotiate(request.request.header("accept"), {kJson, kHtml});
  if (!offer) return std::nullopt;
  return *offer == 0 ? std::string_view(kJson) : kHtml;
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// A box from 4 or 6 numbers; a box of 4 numbers has no limit in z.
Result<store::StoredBox> parse_box(std::string_view text) {
  const Error wrong{ErrorCode::invalid_argument,
                    "bbox needs 4 or 6 comma-separated numbers: minima, then maxima"};
  std::vector<double> numbers;
  while (numbers.size() <= 6) {
    const std::size_t comma = text.find(',');
    const auto number = parse_number(text.substr(0, comma));
    if (!number) return wrong;
    numbers.push_back(*number);
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
  }
  if (numbers.size() != 4 && numbers.size() != 6) return wrong;
  const std::size_t axes = numbers.size() / 2;
  store::StoredBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_given = axis < axes;
    box.min[axis] = is_given ? numbers[axis] : std::numeric_limits<double>::lowest();
    box.max[axis] = is_given ? numbers[axes + axis] : std::numeric_limits<double>::max();
    if (box.min[axis] > box.max[axis]) {
      return Error{ErrorCode::invalid_argument, "bbox: a minimum is above its maximum"};
    }
  }
  return box;
}

/// How much of an extent in x and y a box covers, 0 to 1.
double share_of(const store::StoredBox& extent, const store::StoredBox& box) {
  double share = 1;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double low = std::max(extent.min[axis], box.min[axis]);
    const double high = std::min(extent.max[axis], box.max[axis]);
    const double length = extent.max[axis] - extent.min[axis];
    share *= length > 0 ? std::clamp((high - low) / length, 0.0, 1.0) : 1;
  }
  return share;
}

/// The box of a request. It counts in the collection's own CRS only, and the client has to state
/// that.
Result<std::optional<store::StoredBox>> box_of_request(const Target& target,
                                                       const store::StoredCollection& collection) {
  const std::string* box = target.parameter("bbox");
  const std::string* crs = target.parameter("bbox-crs");
  const std::string storage_crs = crs_uri(collection.srid);
  if (crs != nullptr && *crs != storage_crs) {
    return Error{ErrorCode::invalid_argument, "bbox-crs can only be " + storage_crs};
  }
  if (box == nullptr) return std::optional<store::StoredBox>();
  if (crs == nullptr) {
    return Error{ErrorCode::invalid_argument,
                 "bbox needs bbox-crs=" + storage_crs + " (the collection's storage CRS)"};
  }
  auto parsed = parse_box(*box);
  if (!parsed) return std::move(parsed).error();
  return std::optional<store::StoredBox>(*parsed);
}

std::string page_path(const RoutedRequest& request, std::string_view after) {
  std::string path = "/collections/" + percent_encode(request.target.segments[1]) + "/items";
  char separator = '?';
  for (const auto& [name, value] : request.target.parameters) {
    if (name == "after") continue;
    path += separator + percent_encode(name) + "=" + percent_encode(value);
    separator = '&';
  }
  if (!after.empty()) path += separator + ("after=" + percent_encode(after));
  return path;
}

Json feature_json(const std::string& collection, const store::FeatureSummary& feature) {
  Json json{{"type", "Feature"}, {"id", feature.id}};
  if (feature.box) json["bbox"] = box_json(*feature.box);
  json["geometry"] = nullptr;
  json["properties"] = {{"type", feature.type},
                        {"solids", feature.solids},
                        {"blobBytes", feature.blob_bytes},
                        {"proven", feature.is_proven},
                        {"unprovenSolids", feature.unproven},
                        {"version", feature.version}};
  const std::string path = item_path(collection, feature.id);
  json["links"] = Json::array({link(path + "?f=cityjson", "item", kCityJson, "CityJSON"),
                               link(path + "?f=obj", "alternate", kObj, "OBJ"),
                               link(path + "?f=wt", "alternate", kContainer, "Watertight file")});
  return json;
}

/// The conditions in the parameters that are names of attributes.
Result<std::vector<store::AttributeCondition>> conditions_of_request(const Target& target) {
  std::vector<store::AttributeCondition> conditions;
  for (const auto& [name, value] : target.parameters) {
    if (std::find(std::begin(kItemParameters), std::end(kItemParameters), name) !=
        std::end(kItemParameters)) {
      continue;
    }
    auto condition = pipeline::condition_of(name, value);
    if (!condition) return std::move(condition).error();
    conditions.push_back(*std::move(condition));
  }
  return conditions;
}

/// The number of features of a collection that are proven, or are not, or of all.
std::uint64_t matched(const store::StoredCollection& collection, std::optional<bool> is_proven) {
  if (!is_proven) return collection.features;
  return *is_proven ? collection.features - collection.unproven_features
                    : collection.unproven_features;
}

}  // namespace

Result<std::optional<bool>> proof_of_request(const Target& target) {
  const std::string* text = target.parameter("proven");
  if (text == nullptr) return std::optional<bool>();
  if (*text == "true" || *text == "false") return std::optional<bool>(*text == "true");
  return Error{ErrorCode::invalid_argument, "proven is true or false"};
}

std::string crs_uri(std::uint32_t srid) {
  if (srid == 0) return std::string(kUnknownCrs);
  return "http://www.opengis.net/def/crs/EPSG/0/" + std::to_string(srid);
}

std::string crs_header(std::uint32_t srid) {
  std::string header = "<";
  header += crs_uri(srid);
  header += '>';
  return header;
}

std::string item_path(std::string_view collection, std::string_view item) {
  return "/collections/" + percent_encode(collection) + "/items/" + percent_encode(item);
}

Response get_landing(const RoutedRequest& request) {
  const auto type = landing_type(request);
  if (!type) {
    return refuse(406, "not-acceptable",
                  "this resource is available as application/json and text/html");
  }
  const Json links = Json::array(
      {link("/", "self", kJson, "this page"), link("/api", "service-desc", kOpenApiType, "the API"),
       link("/collections", "data", kJson, "collections of solids"),
       link("/validate", "validate", kJson, "POST a document to validate it"),
       link("/healthz", "status", kJson, "state of the process"),
       link("/readyz", "status", kJson, "state of the database")});
  if (*type == kHtml) return Response{200, "text/html; charset=utf-8", landing_html(links), {}};
  return json_response({{"title", kTitle}, {"description", kDescription}, {"links", links}});
}

Response get_api(const RoutedRequest& request) {
  const std::string* format = request.target.parameter("f");
  const bool is_acceptable =
      format != nullptr
          ? *format == "json"
          : negotiate(request.request.header("accept"), {"application/vnd.oai.openapi+json", kJson})
                .has_value();
  if (!is_acceptable) {
    return refuse(406, "not-acceptable", "the API description is OpenAPI 3 in JSON");
  }
  return Response{200, std::string(kOpenApiType), std::string(kOpenApi), {}};
}

Response get_health(const RoutedRequest& /*request*/) {
  return json_response(Json{{"status", "ok"}});
}

Response get_readiness(const RoutedRequest& request) {
  const Service& service = request.service;
  const Status status = service.readiness ? service.readiness() : service.store->ping();
  if (status) return json_response(Json{{"status", "ready"}});
  Problem problem = to_problem(status.error());
  problem.status = 503;
  problem.headers = {{"Retry-After", "5"}};
  return to_response(problem);
}

Response get_items(const RoutedRequest& request) {
  if (auto refusal = json_only(request)) return *std::move(refusal);
  const auto collection = request.service.store->collection(request.target.segments[1]);
  if (!collection) return to_response(to_problem(collection.error()));
  const auto box = box_of_request(request.target, *collection);
  if (!box) return to_response(to_problem(box.error()));
  const auto limit = limit_of_request(request.target, request.service.options);
  if (!limit) return to_response(to_problem(limit.error()));
  const auto is_proven = proof_of_request(request.target);
  if (!is_proven) return to_response(to_problem(is_proven.error()));
  auto where = conditions_of_request(request.target);
  if (!where) return to_response(to_problem(where.error()));
  const bool has_conditions = !where->empty();
  const std::string* after = request.target.parameter("after");
  const auto page = request.service.store->list(
      {collection->id, *limit, after == nullptr ? std::string() : *after, *box,
       *box && collection->box ? share_of(*collection->box, **box) : 0, *is_proven,
       *std::move(where)});
  if (!page) {
    Problem problem = to_problem(page.error());
    if (has_conditions && problem.status == 400) {
      problem.detail += "; other parameters:";
      for (const std::string_view known : kItemParameters) problem.detail.append(" ").append(known);
    }
    return to_response(problem);
  }

  Json json{{"type", "FeatureCollection"}};
  json["links"] = Json::array(
      {link(page_path(request, after == nullptr ? "" : *after), "self", kJson, "this page")});
  if (!page->next.empty()) {
    json["links"].push_back(link(page_path(request, page->next), "next", kJson, "next page"));
  }
  const bool is_whole = page->next.empty() && after == nullptr;
  if (is_whole) {
    json["numberMatched"] = page->features.size();
  } else if (!*box && !has_conditions) {
    json["numberMatched"] = matched(*collection, *is_proven);
  }
  json["numberReturned"] = page->features.size();
  json["features"] = Json::array();
  for (const store::FeatureSummary& feature : page->features) {
    json["features"].push_back(feature_json(collection->id, feature));
  }
  Response response = json_response(json);
  response.headers.push_back({"Content-Crs", crs_header(collection->srid)});
  return response;
}

}  // namespace watertight::server
