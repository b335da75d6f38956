// SPDX-License-Identifier: GPL-3.0-or-later
//
// The routes of the service (docs/api.md): pure functions of a request, a store and the engines.
// The routes know nothing of sockets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "base/cancel.h"
#include "pipeline/pipeline.h"
#include "server/transport/http.h"
#include "server/transport/listener.h"

namespace watertight::server {

class Budget;
class ExportFiles;
class Gate;
class Jobs;
class Metrics;
class RepresentationCache;

struct RouteOptions {
  Limits limits;  // limits of a submitted document
  std::size_t threads_per_request = 1;
  std::uint64_t largest_page = 1000;  // the most features of a page
  std::uint64_t default_page = 10;
  std::uint64_t largest_findings = 1000;  // the most findings of a report in an answer
  std::size_t longest_report = std::size_t{256} << 20U;  // of POST /validate, bytes
  bool is_encrypted = false;                             // whether clients speak HTTPS
  std::string base_url;     // the start of links; "": from the request (server/features/links.h)
  std::string user_field;   // in which a proxy with a key names the user, lower case; "": none
  std::string cors_origin;  // whose pages may read answers (server/features/cors.h); "": none
  bool requires_preconditions = false;  // on every write; without one it gets 428
};

/// The parts that routes work with. Store and workers must outlive the service and be thread-safe.
struct Service {
  SolidStore* store = nullptr;
  delaunay::EngineWorkers* workers = nullptr;  // null: rung 0 only
  RouteOptions options;
  /// Whether the store can be used, answered at once. Null: the store is asked.
  std::function<Status()> readiness = nullptr;
  /// Keeps answers for items. Null: none is kept. Outlives the service.
  RepresentationCache* cache = nullptr;
  /// Keeps exports of which ranges are wanted. Null: exports have no ranges, and there are no
  /// GeoPackages. Outlives the service.
  ExportFiles* export_files = nullptr;
  /// The memory for documents that are read whole, bytes. Null: no limit. Outlives the service.
  Budget* document_memory = nullptr;
  /// The keys of clients. Null: everybody may do everything. Outlives the service.
  const Gate* gate = nullptr;
  /// Counts for Prometheus. Null: nothing is counted. Outlives the service.
  Metrics* metrics = nullptr;
  /// Keeps and does jobs. Null: there are none. Outlives the service.
  Jobs* jobs = nullptr;
};

/// Whether a request may be answered, by its key.
Admission admit(const Service& service, const Request& request);

/// Answers a request. Never fails: every error is an application/problem+json answer.
Response respond(const Service& service, const Request& request, const CancelPoll& is_cancelled);

/// The threads that should answer a request whose body has so many bytes.
Lane lane_of(const Request& request, std::uint64_t body_bytes);

/// lane_of() and respond() in the form in which the server calls them.
Application make_application(const Service& service);

/// The application that answers /healthz, /readyz and /metrics only, without keys.
Application probe_application(const Service& service);

}  // namespace watertight::server
