// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "server/metrics/metrics.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_metrics {
namespace {

using server::Metrics;
using server::Request;

/// A service over a store in memory that counts.
class Counting {
 public:
  Counting() {
    service.store = &store;
    service.metrics = &metrics;
  }
  server::Response send(const Request& request) const {
    const CancelPoll never = [] { return false; };
    return server::respond(service, request, never);
  }
  void answered(const std::string& method, const std::string& target, unsigned status) const {
    server::make_application(service).answered({method, target, status, 1000, 0.02});
  }
  /// Whether the text has the line.
  bool has(const std::string& line) {
    const std::string text = metrics.text(true);
    INFO(text);
    const bool found = text.find("\n" + line + "\n") != std::string::npos;
    CHECK(found);
    return found;
  }

  samples::MemoryStore store;
  Metrics metrics;
  server::Service service;
};

TEST_CASE_METHOD(Counting, "requests count under their routes, whatever clients name") {
  answered("GET", "/collections/a/items/b?f=obj", 200);
  answered("GET", "/collections/c/items/d", 200);
  answered("HEAD", "/collections/c/items/d", 404);
  answered("BREW", "/collections/c/items/d", 405);
  answered("GET", "/tea/pot", 404);
  answered("GET", "/%zz", 400);
  answered("", "", 0);
  const std::string item = "path=\"/collections/{collectionId}/items/{itemId}\"";
  has("watertight_requests_total{method=\"GET\"," + item + ",status=\"200\"} 2");
  has("watertight_requests_total{method=\"HEAD\"," + item + ",status=\"404\"} 1");
  has(R"(watertight_requests_total{method="other",path="other",status="405"} 1)");
  has(R"(watertight_requests_total{method="other",path="other",status="404"} 1)");
  has(R"(watertight_requests_total{method="other",path="other",status="0"} 1)");
  has("watertight_answer_bytes_total{" + item + "} 3000");
  has("watertight_request_seconds_bucket{" + item + ",le=\"0.01\"} 0");
  has("watertight_request_seconds_bucket{" + item + ",le=\"0.03\"} 3");
  has("watertight_request_seconds_count{" + item + "} 3");
}

TEST_CASE_METHOD(Counting, "solids count by verdict and rung, findings by code") {
  has(R"(watertight_solids_total{verdict="valid"} 0)");
  const std::vector<server::HeaderField> type{{"content-type", "application/city+json-seq"}};
  CHECK(send({"POST", "/validate", type, samples::kOneOpen}).status == 200);
  CHECK(send({"POST", "/collections/a/items", type, samples::kTwo}).status == 201);
  CHECK(send({"POST", "/collections/a/items", type, samples::kOneOpen}).status == 422);
  has(R"(watertight_solids_total{verdict="valid"} 4)");
  has(R"(watertight_solids_total{verdict="invalid"} 2)");
  has(R"(watertight_solids_total{verdict="undecided"} 0)");
  has(R"(watertight_proofs_total{rung="delaunay"} 4)");
  has(R"(watertight_findings_total{code="302"} 2)");
}

TEST_CASE_METHOD(Counting, "metrics are text that says whether the database is there") {
  const server::Response response = send({"GET", "/metrics", {}, ""});
  CHECK(response.status == 200);
  CHECK(response.content_type == "text/plain; version=0.0.4; charset=utf-8");
  CHECK(response.body.find("\nwatertight_database_ready 1\n") != std::string::npos);
  service.readiness = [] { return Error{ErrorCode::unavailable, "away"}; };
  const server::Response away = send({"GET", "/metrics", {}, ""});
  CHECK(away.status == 200);
  CHECK(away.body.find("\nwatertight_database_ready 0\n") != std::string::npos);
  CHECK(send({"GET", "/metrics?f=json", {}, ""}).status == 400);
}

TEST_CASE_METHOD(Counting, "the address of probes answers for metrics without a key") {
  const auto probes = server::probe_application(service);
  const CancelPoll never = [] { return false; };
  CHECK(!probes.admit);
  CHECK(probes.respond({"GET", "/metrics", {}, ""}, never).status == 200);
  CHECK(probes.respond({"GET", "/collections", {}, ""}, never).status == 404);
}

}  // namespace
}  // namespace watertight::test_metrics
