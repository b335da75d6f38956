// SPDX-License-Identifier: GPL-3.0-or-later
//
// The handlers in the route table, and the functions and constants that they share. Internal to
// server/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/cancel.h"
#include "server/access/keys.h"
#include "server/problem.h"
#include "server/routes.h"

namespace watertight::server {

inline constexpr std::string_view kJson = "application/json";
inline constexpr std::string_view kHtml = "text/html";
inline constexpr std::string_view kHtmlPage = "text/html; charset=utf-8";  // as answers name it
inline constexpr std::string_view kGeoJson = "application/geo+json";
inline constexpr std::string_view kJsonFg = "application/vnd.ogc.fg+json";
inline constexpr std::string_view kMergePatch = "application/merge-patch+json";
inline constexpr std::string_view kCityJson = "application/city+json";
inline constexpr std::string_view kCityJsonSeq = "application/city+json-seq";
inline constexpr std::string_view kGml = "application/gml+xml";
inline constexpr std::string_view kObj = "model/obj";
inline constexpr std::string_view kGltf = "model/gltf-binary";
inline constexpr std::string_view kBlob = "application/vnd.watertight.blob";
inline constexpr std::string_view kGeoPackage = "application/geopackage+sqlite3";
inline constexpr std::string_view kContainer = "application/vnd.watertight";

/// The bytes of a body, or of what is stored of a feature, that take a moment to compute with.
inline constexpr std::size_t kSmallBody = 64 * 1024;

/// A request that matched a route.
struct RoutedRequest {
  const Service& service;
  const Request& request;
  const Target& target;
  const CancelPoll& is_cancelled;
};

using Handler = Response (*)(const RoutedRequest&);

struct Route {
  std::string_view method;
  std::string_view path;  // "/collections/{collectionId}": as in the OpenAPI document
  Lane lane;    // requests of the computing lane whose bodies have at most kSmallBody bytes and are
                // not compressed, go to the small one
  Scope scope;  // of the key that a request needs, where keys are needed
  Handler handler;
  std::vector<std::string_view> parameters;  // the query parameters that the route knows
  bool has_attributes = false;               // others are names of attributes
};

/// The parameters of a list of items; others are names of attributes.
inline constexpr std::string_view kItemParameters[] = {
    "f",   "limit", "after",  "bbox",        "bbox-crs",   "datetime", "proven",
    "crs", "lod",   "filter", "filter-lang", "filter-crs", "sortby",   "profile"};

/// The parameters of a document that is judged, without and with storing it.
inline constexpr std::string_view kValidateParameters[] = {
    "f",     "surfaces", "planarity", "planarity-angle", "overlap", "exact-overlaps",
    "proof", "strict",   "chord"};
inline constexpr std::string_view kReportParameters[] = {
    "f",     "proven", "surfaces", "planarity",   "planarity-angle", "overlap", "exact-overlaps",
    "proof", "strict", "filter",   "filter-lang", "filter-crs",      "bbox",    "bbox-crs"};
inline constexpr std::string_view kSubmitParameters[] = {
    "f",       "invalid",        "surfaces", "planarity", "planarity-angle",
    "overlap", "exact-overlaps", "proof",    "strict",    "chord"};

/// The parameters of a document that is stored.
inline constexpr std::string_view kStoreParameters[] = {
    "f",      "invalid", "surfaces", "planarity", "planarity-angle", "overlap", "exact-overlaps",
    "proof",  "strict",  "repair",   "weld",      "islands",         "density", "regularity",
    "collar", "crease",  "chord"};

/// The parameters of a document that is repaired.
inline constexpr std::string_view kRepairParameters[] = {
    "f",       "to",         "remedies",        "weld",   "islands",
    "density", "regularity", "collar",          "crease", "chord",
    "invalid", "planarity",  "planarity-angle", "proof",  "strict"};

/// The parameters of a file that becomes a job.
inline constexpr std::string_view kJobParameters[] = {
    "collection",      "name",    "invalid",        "surfaces", "planarity",
    "planarity-angle", "overlap", "exact-overlaps", "proof",    "strict"};

/// All routes; the OpenAPI document describes exactly these (a test compares them).
const std::vector<Route>& routes();

Response get_landing(const RoutedRequest& request);
Response get_conformance(const RoutedRequest& request);
Response get_api(const RoutedRequest& request);
Response get_health(const RoutedRequest& request);
Response get_readiness(const RoutedRequest& request);
Response get_metrics(const RoutedRequest& request);
Response get_web_file(const RoutedRequest& request);
Response get_validate(const RoutedRequest& request);
Response get_collections(const RoutedRequest& request);
Response get_collection(const RoutedRequest& request);
Response put_collection(const RoutedRequest& request);
Response patch_collection(const RoutedRequest& request);
Response post_recount(const RoutedRequest& request);
Response delete_collection(const RoutedRequest& request);
Response get_items(const RoutedRequest& request);
Response get_item(const RoutedRequest& request);
Response post_items(const RoutedRequest& request);
Response put_item(const RoutedRequest& request);
Response patch_item(const RoutedRequest& request);
Response delete_item(const RoutedRequest& request);
Response get_queryables(const RoutedRequest& request);
Response get_sortables(const RoutedRequest& request);
Response get_schema(const RoutedRequest& request);
Response get_attributes(const RoutedRequest& request);
Response put_attributes(const RoutedRequest& request);
Response get_tileset(const RoutedRequest& request);
Response get_tile(const RoutedRequest& request);
Response get_export(const RoutedRequest& request);
Response get_report(const RoutedRequest& request);
Response get_statistics(const RoutedRequest& request);
Response post_validate(const RoutedRequest& request);
Response post_convert(const RoutedRequest& request);
Response post_tessellate(const RoutedRequest& request);
Response post_repair(const RoutedRequest& request);
Response post_encode(const RoutedRequest& request);
Response post_decode(const RoutedRequest& request);
Response post_job(const RoutedRequest& request);
Response get_jobs(const RoutedRequest& request);
Response get_job(const RoutedRequest& request);
Response delete_job(const RoutedRequest& request);
Response get_job_events(const RoutedRequest& request);
Response get_job_results(const RoutedRequest& request);

/// The answer with a problem that has no further members.
Response refuse(unsigned status, std::string kind, std::string detail);

/// The refusal of a change of a collection whose preconditions do not hold (412), or are missing
/// though wanted (428). They are compared before the change; what happens in between is not seen.
std::optional<Response> unless_change_is_wanted(const RoutedRequest& request);

/// The CRS URI of an EPSG code; the OGC's "unknown" for 0.
std::string crs_uri(std::uint32_t srid);

/// crs_uri() in the form of the value of a Content-Crs field.
std::string crs_header(std::uint32_t srid);

/// "/collections/<id>/items/<item>", percent-encoded.
std::string item_path(std::string_view collection, std::string_view item);

/// The OpenAPI 3 document: the file server/openapi.json, which server/CMakeLists.txt embeds.
extern const std::string_view kOpenApi;

}  // namespace watertight::server
