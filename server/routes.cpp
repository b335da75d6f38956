// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/routes.h"

#include <algorithm>

#include "pipeline/container.h"
#include "server/access/gate.h"
#include "server/documents/submission.h"
#include "server/features/answer_coding.h"
#include "server/features/cors.h"
#include "server/handlers.h"
#include "server/jobs/handlers_jobs.h"
#include "server/metrics/metrics.h"

namespace watertight::server {
namespace {

constexpr std::size_t kLongestId = 1024;  // bytes

std::vector<std::string_view> segments_of(std::string_view path) {
  std::vector<std::string_view> segments;
  for (std::size_t start = 1; start < path.size();) {
    const std::size_t end = std::min(path.find('/', start), path.size());
    segments.push_back(path.substr(start, end - start));
    start = end + 1;
  }
  return segments;
}

bool matches(const Route& route, const Target& target) {
  const std::vector<std::string_view> segments = segments_of(route.path);
  if (segments.size() != target.segments.size()) return false;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!segments[i].starts_with('{') && segments[i] != target.segments[i]) return false;
  }
  return true;
}

/// HEAD is GET without the body, which the session leaves out.
std::string_view effective_method(const Request& request) {
  return request.method == "HEAD" ? std::string_view("GET") : std::string_view(request.method);
}

/// The route of a request; null if there is none.
const Route* route_of(const Request& request) {
  const auto target = parse_target(request.target);
  if (!target) return nullptr;
  for (const Route& route : routes()) {
    if (route.method == effective_method(request) && matches(route, *target)) return &route;
  }
  return nullptr;
}

std::string allowed_methods(const Target& target) {
  std::string allowed;
  for (const Route& route : routes()) {
    if (!matches(route, target)) continue;
    allowed += std::string(route.method) + ", ";
    if (route.method == "GET") allowed += "HEAD, ";
  }
  return allowed.empty() ? allowed : allowed + "OPTIONS";
}

/// The refusal of a target that matches a route; nothing when the target is fine.
std::optional<Response> refusal_of(const Target& target, const Route& route) {
  if (target.segments.size() > 1 && target.segments[0] == "collections") {
    const Status checked = store::check_collection_id(target.segments[1]);
    if (!checked) {
      return refuse(route.method == "GET" ? 404 : 400, "collection-id", checked.error().message);
    }
  }
  if (target.segments.size() > 3 && target.segments[3].size() > kLongestId) {
    return refuse(400, "item-id", "an item id has at most 1024 bytes");
  }
  if (route.has_attributes) return std::nullopt;  // its other parameters are names of attributes
  for (const auto& [name, value] : target.parameters) {
    if (std::find(route.parameters.begin(), route.parameters.end(), name) !=
        route.parameters.end()) {
      continue;
    }
    std::string known;
    for (const std::string_view parameter : route.parameters) {
      known += (known.empty() ? "" : ", ") + std::string(parameter);
    }
    return refuse(400, "invalid-argument",
                  "unknown parameter '" + name.substr(0, 64) +
                      "'; known here: " + (known.empty() ? "none" : known));
  }
  return std::nullopt;
}

/// What a path allows, and the types of bodies that it takes to make and change features (OGC API -
/// Common, part 5).
Response options_of(const Target& target, const std::string& allowed) {
  Response response{200, "", "", {{"Allow", allowed}}};
  for (const Route& route : routes()) {
    if (!matches(route, target)) continue;
    if (route.handler == post_items) {
      response.headers.push_back({"Accept-Post", storable_types()});
    } else if (route.handler == patch_item) {
      response.headers.push_back({"Accept-Patch", std::string(kMergePatch)});
    }
  }
  return response;
}

Response unrouted(const Request& request, const Target& target) {
  const std::string allowed = allowed_methods(target);
  if (allowed.empty()) {
    return refuse(404, "not-found", "there is nothing at this path; see /api");
  }
  if (request.method == "OPTIONS") return options_of(target, allowed);
  Problem problem{405, "method-not-allowed", "this path allows " + allowed, {}, {}, {}, {}};
  problem.headers.push_back({"Allow", allowed});
  return to_response(problem);
}

}  // namespace

namespace {

using enum Lane;
using enum Scope;

/// The service as a whole.
const std::vector<Route>& general_routes() {
  static const std::vector<Route> table{
      {"GET", "/", quick, read, get_landing, {"f"}},
      {"GET", "/api", quick, read, get_api, {"f"}},
      {"GET", "/conformance", quick, read, get_conformance, {"f"}},
      {"GET", "/healthz", quick, none, get_health, {}},
      {"GET", "/readyz", quick, none, get_readiness, {}},
      {"GET", "/metrics", quick, read, get_metrics, {}},
      {"GET", "/web/{file}", quick, none, get_web_file, {}},
      {"GET", "/validate", quick, read, get_validate, {"f"}},
      {"POST",
       "/validate",
       computing,
       read,
       post_validate,
       {std::begin(kValidateParameters), std::end(kValidateParameters)}},
      {"POST", "/convert", computing, read, post_convert, {"f", "to", "surfaces", "chord"}},
      {"POST", "/tessellate", computing, read, post_tessellate, {"f", "to", "chord", "lattice"}},
      {"POST",
       "/repair",
       computing,
       read,
       post_repair,
       {std::begin(kRepairParameters), std::end(kRepairParameters)}},
      {"POST",
       "/encode",
       computing,
       read,
       post_encode,
       {std::begin(kSubmitParameters), std::end(kSubmitParameters)}},
      {"POST", "/decode", computing, read, post_decode, {"f", "to"}},
  };
  return table;
}

const std::vector<Route>& collection_routes() {
  static const std::vector<Route> table{
      {"GET", "/collections", reading, read, get_collections, {"f", "limit", "after"}},
      {"GET", "/collections/{collectionId}", reading, read, get_collection, {"f"}},
      {"PUT", "/collections/{collectionId}", small, admin, put_collection, {}},
      {"PATCH", "/collections/{collectionId}", small, admin, patch_collection, {}},
      {"DELETE", "/collections/{collectionId}", small, admin, delete_collection, {}},
      {"POST", "/collections/{collectionId}/recount", small, write, post_recount, {}},
      {"GET", "/collections/{collectionId}/queryables", reading, read, get_queryables, {"f"}},
      {"GET", "/collections/{collectionId}/sortables", reading, read, get_sortables, {"f"}},
      {"GET", "/collections/{collectionId}/schema", computing, read, get_schema, {"f"}},
      {"GET", "/collections/{collectionId}/attributes", reading, read, get_attributes, {"f"}},
      {"PUT", "/collections/{collectionId}/attributes", small, write, put_attributes, {}},
      {"GET",
       "/collections/{collectionId}/export",
       computing,
       read,
       get_export,
       {"f", "proven", "part", "lod", "filter", "filter-lang", "filter-crs", "bbox", "bbox-crs"}},
      {"GET",
       "/collections/{collectionId}/report",
       computing,
       read,
       get_report,
       {std::begin(kReportParameters), std::end(kReportParameters)}},
      {"GET", "/collections/{collectionId}/statistics", computing, read, get_statistics, {"f"}},
      {"GET",
       "/collections/{collectionId}/3dtiles",
       computing,
       read,
       get_tileset,
       {"compression", "layer"}},
      {"GET",
       "/collections/{collectionId}/3dtiles/content",
       computing,
       read,
       get_tile,
       {"frame", "origin", "bounds", "from", "below", "compression", "layer"}},
  };
  return table;
}

const std::vector<Route>& item_routes() {
  static const std::vector<Route> table{
      {"GET",
       "/collections/{collectionId}/items",
       reading,
       read,
       get_items,
       {std::begin(kItemParameters), std::end(kItemParameters)},
       true},
      {"POST",
       "/collections/{collectionId}/items",
       computing,
       write,
       post_items,
       {std::begin(kStoreParameters), std::end(kStoreParameters)}},
      {"GET",
       "/collections/{collectionId}/items/{itemId}",
       quick,
       read,
       get_item,
       {"f", "solid", "crs", "lod", "profile"}},
      {"PUT",
       "/collections/{collectionId}/items/{itemId}",
       computing,
       write,
       put_item,
       {std::begin(kStoreParameters), std::end(kStoreParameters)}},
      {"PATCH", "/collections/{collectionId}/items/{itemId}", computing, write, patch_item, {}},
      {"DELETE", "/collections/{collectionId}/items/{itemId}", small, write, delete_item, {}},
  };
  return table;
}

const std::vector<Route>& job_routes() {
  static const std::vector<Route> table{
      {"GET", "/jobs", quick, read, get_jobs, {"f", "limit", "after"}},
      {"POST",
       "/jobs",
       small,
       write,
       post_job,
       {std::begin(kJobParameters), std::end(kJobParameters)}},
      {"GET", "/jobs/{jobId}", quick, read, get_job, {"f"}},
      {"DELETE", "/jobs/{jobId}", small, write, delete_job, {}},
      {"GET", "/jobs/{jobId}/results", small, read, get_job_results, {}},
      {"GET", "/jobs/{jobId}/events", quick, read, get_job_events, {}},
  };
  return table;
}

}  // namespace

const std::vector<Route>& routes() {
  static const std::vector<Route> all = [] {
    std::vector<Route> joined;
    for (const auto* part :
         {&general_routes(), &collection_routes(), &item_routes(), &job_routes()}) {
      joined.insert(joined.end(), part->begin(), part->end());
    }
    return joined;
  }();
  return all;
}

Response refuse(unsigned status, std::string kind, std::string detail) {
  return to_response(Problem{status, std::move(kind), std::move(detail), {}, {}, {}, {}});
}

Lane lane_of(const Request& request, std::uint64_t body_bytes) {
  const Route* route = route_of(request);
  if (route == nullptr) return Lane::quick;
  // A Watertight file is compressed: its size says little about the work in it.
  // POST, PUT and PATCH have bodies.
  const bool is_small = request.method.starts_with('P') && body_bytes <= kSmallBody &&
                        !pipeline::is_container(as_bytes(request.body));
  return route->lane == Lane::computing && is_small ? Lane::small : route->lane;
}

namespace {

/// The scope that a request needs where keys are needed. That of an unknown path or method is read,
/// so that only who has a key learns what there is. The question of a browser whether a page may
/// ask (OPTIONS) never has a key.
Scope scope_of(const Request& request) {
  if (request.method == "OPTIONS") return Scope::none;
  const Route* route = route_of(request);
  return route == nullptr ? Scope::read : route->scope;
}

Response routed(const Service& service, const Request& request, const CancelPoll& is_cancelled) {
  // The service as a whole (RFC 9110, section 9.3.7).
  if (request.method == "OPTIONS" && request.target == "*") {
    return Response{204, "", "", {{"Allow", "GET, HEAD, POST, PUT, PATCH, DELETE, OPTIONS"}}};
  }
  const auto target = parse_target(request.target);
  if (!target) return to_response(to_problem(target.error()));
  for (const Route& route : routes()) {
    if (route.method != effective_method(request) || !matches(route, *target)) continue;
    auto refusal = refusal_of(*target, route);
    if (refusal) return *std::move(refusal);
    return route.handler({service, request, *target, is_cancelled});
  }
  return unrouted(request, *target);
}

}  // namespace

Response respond(const Service& service, const Request& request, const CancelPoll& is_cancelled) {
  const Route* route = route_of(request);
  Response response = routed(service, request, is_cancelled);
  // Answers that are made at once keep all others waiting, so nothing is computed for them.
  if (route != nullptr && (route->lane != Lane::quick || response.further)) {
    response = with_coding(request, std::move(response));
  }
  return with_leave_to_read(service.options.cors_origin, request, std::move(response));
}

namespace {

/// Counts an answered request under its route.
void count(const Service& service, const AnsweredRequest& answered) {
  if (service.metrics == nullptr) return;
  const Route* route =
      route_of({std::string(answered.method), std::string(answered.target), {}, ""});
  service.metrics->count(answered, route == nullptr ? std::string_view() : route->path);
}

}  // namespace

namespace {

/// The refusal of a body that makes or changes a feature and states no type.
std::optional<Response> unless_typed(const Route* route, const Request& request) {
  const bool needs_type =
      route != nullptr &&
      (route->handler == post_items || route->handler == put_item || route->handler == patch_item);
  if (!needs_type || request.header("content-type") != nullptr) return std::nullopt;
  const auto target = parse_target(request.target);
  if (target->parameter("f") != nullptr) return std::nullopt;
  return refuse(400, "invalid-argument",
                "the request needs a field Content-Type, which says what its body is");
}

constexpr std::size_t kLongestUser = 256;  // bytes; a longer name is cut off

/// The user whom a proxy names that has a key; "" for a request without key.
std::string user_of(const Service& service, const Request& request, const std::string& key) {
  const std::string& field = service.options.user_field;
  const std::string* user = key.empty() || field.empty() ? nullptr : request.header(field);
  return user == nullptr ? std::string() : user->substr(0, kLongestUser);
}

/// A request that the gate has admitted, with the place of its body: that of a job goes to a file.
Admission admit_body(const Service& service, const Request& request, Admission admitted) {
  const Route* route = route_of(request);
  admitted.refusal = unless_typed(route, request);
  if (admitted.refusal || route == nullptr || route->handler != post_job) return admitted;
  const auto target = parse_target(request.target);
  admitted.refusal = refusal_of(*target, *route);
  if (admitted.refusal) return admitted;
  const CancelPoll never = [] { return false; };
  std::string owner = admitted.key;
  if (!admitted.user.empty()) owner.append("/").append(admitted.user);
  Admission begun = begin_job({service, request, *target, never}, owner);
  begun.key = std::move(admitted.key);
  begun.user = std::move(admitted.user);
  return begun;
}

}  // namespace

Admission admit(const Service& service, const Request& request) {
  Admission admission;
  if (service.gate != nullptr) admission = service.gate->admit(request, scope_of(request));
  admission.user = user_of(service, request, admission.key);
  if (!admission.refusal) admission = admit_body(service, request, std::move(admission));
  if (admission.refusal) {
    admission.refusal =
        with_leave_to_read(service.options.cors_origin, request, *std::move(admission.refusal));
  }
  return admission;
}

Application make_application(const Service& service) {
  return Application{lane_of,
                     [service](const Request& request, const CancelPoll& is_cancelled) {
                       return respond(service, request, is_cancelled);
                     },
                     [service](const Request& request) { return admit(service, request); },
                     [service](const AnsweredRequest& request) { count(service, request); }};
}

Application probe_application(const Service& service) {
  return Application{[](const Request&, std::uint64_t) { return Lane::quick; },
                     [service](const Request& request, const CancelPoll& is_cancelled) {
                       if (request.target == "/healthz" || request.target == "/readyz" ||
                           request.target == "/metrics") {
                         return respond(service, request, is_cancelled);
                       }
                       return refuse(404, "not-found",
                                     "this address answers /healthz, /readyz and /metrics only");
                     }};
}

}  // namespace watertight::server
