// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers of the service as a whole: landing page, conformance, description, health.
#include <algorithm>
#include <array>
#include <optional>

#include "archives/gzip.h"
#include "base/checksum.h"
#include "server/features/answer_coding.h"
#include "server/features/links.h"
#include "server/features/pages.h"
#include "server/items/preconditions.h"
#include "server/json_answers.h"
#include "server/metrics/metrics.h"
#include "web/files.h"

namespace watertight::server {
namespace {

constexpr std::string_view kUnknownCrs = "http://www.opengis.net/def/nil/OGC/0/unknown";

constexpr std::string_view kOpenApiType = "application/vnd.oai.openapi+json;version=3.0";
constexpr std::string_view kSpecifications = "http://www.opengis.net/spec/";
constexpr std::string_view kConformance[] = {
    "ogcapi-common-1/1.0/conf/core",
    "ogcapi-common-2/1.0/conf/collections",
    "ogcapi-common-3/1.0/conf/schemas",
    "ogcapi-common-3/1.0/conf/advanced-property-roles",
    "ogcapi-common-3/1.0/conf/sortables",
    "ogcapi-common-3/1.0/conf/profile-parameter",
    "ogcapi-common-5/1.0/conf/create-replace-delete",
    "ogcapi-common-5/1.0/conf/update",
    "ogcapi-common-5/1.0/conf/optimistic-locking-etags",
    "ogcapi-features-1/1.0/conf/core",
    "ogcapi-features-1/1.0/conf/geojson",
    "ogcapi-features-1/1.0/conf/html",
    "ogcapi-features-1/1.0/conf/oas30",
    "ogcapi-features-2/1.0/conf/crs",
    "ogcapi-features-3/1.0/conf/queryables",
    "ogcapi-features-3/1.0/conf/queryables-query-parameters",
    "ogcapi-features-3/1.0/conf/filter",
    "ogcapi-features-3/1.0/conf/features-filter",
    "ogcapi-features-4/1.0/conf/features",
    "json-fg-1/1.0/conf/api",
    "cql2/1.0/conf/cql2-text",
    "cql2/1.0/conf/cql2-json",
    "cql2/1.0/conf/basic-cql2",
    "cql2/1.0/conf/advanced-comparison-operators"};
constexpr std::string_view kTitle = "Watertight";
constexpr std::string_view kDescription = "Validates, stores and compresses 3D solids";

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
  const auto form = answer_form(request);
  if (!form) return refuse_forms();
  const std::string base = base_url(request);
  Json links = Json::array(
      {link(base + "/", "self", kJson, "this page"),
       link(base + "/api", "service-desc", kOpenApiType, "the API"),
       link(base + "/conformance", "conformance", kJson, "the standards that the service follows"),
       link(base + "/collections", "data", kJson, "collections of solids"),
       link(base + "/validate", "validate", kHtml, "validate a file, or POST one"),
       link(base + "/healthz", "status", kJson, "state of the process"),
       link(base + "/readyz", "status", kJson, "state of the database"),
       link(base + "/metrics", "monitor", "text/plain", "counters for Prometheus")});
  if (request.service.jobs != nullptr) {
    links.push_back(link(base + "/jobs", "http://www.opengis.net/def/rel/ogc/1.0/job-list", kJson,
                         "files that were uploaded to be stored"));
  }
  const Json json{{"title", kTitle}, {"description", kDescription}, {"links", links}};
  return *form == AnswerForm::html ? html_response(landing_page(json)) : json_response(json);
}

Response get_validate(const RoutedRequest& request) {
  const auto form = answer_form(request);
  if (!form) return refuse_forms();
  const std::string base = base_url(request);
  if (*form == AnswerForm::html) return html_response(validate_page(base));
  return json_response(
      Json{{"title", "Validate a document"},
           {"description", "POST a document to this address; the answer is the report"},
           {"links", Json::array({link(base + "/validate", "self", kJson, "this page"),
                                  link(base + "/api", "service-desc", kOpenApiType, "the API")})}});
}

Response get_web_file(const RoutedRequest& request) {
  // Compressed once, when the first is asked for: all are asked for together.
  static const std::vector<Result<std::string>> packed = [] {
    std::vector<Result<std::string>> all;
    for (const web::WebFile& file : web::files()) {
      all.push_back(archives::gzip(file.text, archives::Effort::best));
    }
    return all;
  }();
  for (std::size_t i = 0; i < packed.size(); ++i) {
    const web::WebFile& file = web::files()[i];
    if (file.name != request.target.segments[1]) continue;
    const std::string etag = etag_of(content_hash(as_bytes(file.text)), "web");
    if (auto unneeded = unless_needed(request.request, etag)) return *std::move(unneeded);
    Response response{200,
                      std::string(file.type),
                      std::string(file.text),
                      {{"ETag", etag}, {"Cache-Control", "no-cache"}, {"Vary", "Accept-Encoding"}}};
    if (packed[i] && takes_gzip(request.request)) {
      response.body = *packed[i];
      response.headers.front().value.insert(etag.size() - 1, kGzipTag);
      response.headers.push_back({"Content-Encoding", "gzip"});
    }
    return response;
  }
  return refuse(404, "not-found", "there is no such file of the pages");
}

Response get_conformance(const RoutedRequest& request) {
  const auto form = answer_form(request);
  if (!form) return refuse_forms();
  Json classes = Json::array();
  for (const std::string_view name : kConformance) {
    classes.push_back(std::string(kSpecifications).append(name));
  }
  const Json json{{"conformsTo", std::move(classes)}};
  return *form == AnswerForm::html ? html_response(conformance_page(json)) : json_response(json);
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

Response get_metrics(const RoutedRequest& request) {
  const Service& service = request.service;
  if (service.metrics == nullptr) return refuse(404, "not-found", "this service counts nothing");
  const Status status = service.readiness ? service.readiness() : service.store->ping();
  return Response{200,
                  "text/plain; version=0.0.4; charset=utf-8",
                  service.metrics->text(status.has_value()),
                  {}};
}

}  // namespace watertight::server
