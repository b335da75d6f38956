// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers of the service as a whole: landing page, conformance, description, health.
#include <algorithm>
#include <array>
#include <optional>

#include "server/features/links.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

constexpr std::string_view kUnknownCrs = "http://www.opengis.net/def/nil/OGC/0/unknown";

constexpr std::string_view kHtml = "text/html";
constexpr std::string_view kOpenApiType = "application/vnd.oai.openapi+json;version=3.0";
constexpr std::string_view kSpecifications = "http://www.opengis.net/spec/";
constexpr std::string_view kConformance[] = {
    "ogcapi-common-1/1.0/conf/core",    "ogcapi-common-2/1.0/conf/collections",
    "ogcapi-features-1/1.0/conf/core",  "ogcapi-features-1/1.0/conf/geojson",
    "ogcapi-features-1/1.0/conf/oas30", "ogcapi-features-2/1.0/conf/crs"};
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
  const std::string base = base_url(request);
  const Json links = Json::array(
      {link(base + "/", "self", kJson, "this page"),
       link(base + "/api", "service-desc", kOpenApiType, "the API"),
       link(base + "/conformance", "conformance", kJson, "the standards that the service follows"),
       link(base + "/collections", "data", kJson, "collections of solids"),
       link(base + "/validate", "validate", kJson, "POST a document to validate it"),
       link(base + "/healthz", "status", kJson, "state of the process"),
       link(base + "/readyz", "status", kJson, "state of the database")});
  if (*type == kHtml) return Response{200, "text/html; charset=utf-8", landing_html(links), {}};
  return json_response({{"title", kTitle}, {"description", kDescription}, {"links", links}});
}

Response get_conformance(const RoutedRequest& request) {
  if (auto refusal = json_only(request)) return *std::move(refusal);
  Json classes = Json::array();
  for (const std::string_view name : kConformance) {
    classes.push_back(std::string(kSpecifications).append(name));
  }
  return json_response({{"conformsTo", std::move(classes)}});
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

}  // namespace watertight::server
