// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests to the routes, without sockets, for the tests of server.
#pragma once

#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/export_files.h"
#include "server/handlers.h"
#include "server/metrics/metrics.h"
#include "tests/unit/pipeline/samples.h"
#include "tests/unit/server/answers.h"

namespace watertight::samples {

using Json = nlohmann::json;

/// The routes over a store in memory.
class RoutesFixture {
 public:
  server::Response send(server::Request request) const {
    const CancelPoll never = [] { return false; };
    server::Service service{&store, nullptr, {}};
    service.metrics = &metrics;
    service.export_files = &files;
    server::Response response = server::respond(service, request, never);
    while (response.further) response = std::shared_ptr(response.further)->make(never);
    return response;
  }
  server::Response get(const std::string& target,
                       std::vector<server::HeaderField> headers = {}) const {
    return send({"GET", target, std::move(headers), ""});
  }
  server::Response post(const std::string& target, std::string body,
                        const std::string& type = "application/city+json-seq") const {
    return send({"POST", target, {{"content-type", type}}, std::move(body)});
  }
  mutable MemoryStore store;
  mutable server::Metrics metrics;
  mutable server::ExportFiles files;
};

inline Json problem_of(const server::Response& response) {
  CHECK(response.content_type == "application/problem+json");
  Json json = Json::parse(response.body, nullptr, false);
  REQUIRE(json.is_object());
  CHECK(json["status"] == response.status);
  CHECK(json.contains("type"));
  return json;
}

inline const std::string* header_of(const server::Response& response, std::string_view name) {
  for (const server::HeaderField& field : response.headers) {
    if (field.name == name) return &field.value;
  }
  return nullptr;
}

inline const std::string kTwo = sequence({feature("a"), feature("b")});
inline const std::string kOneOpen = sequence({feature("a"), feature("open", kOpenFacets)});

}  // namespace watertight::samples
