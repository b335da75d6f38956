// SPDX-License-Identifier: GPL-3.0-or-later
//
// Attributes that are chosen and queried over HTTP.
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "server/handlers.h"
#include "tests/unit/pipeline/samples.h"
#include "tests/unit/server/answers.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight {
namespace {

using samples::Json;
using samples::problem_of;
using Fixture = samples::RoutesFixture;

TEST_CASE_METHOD(Fixture, "chosen attributes select items, others are refused by name") {
  const std::string lines = samples::sequence(
      {R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building","attributes":)"
       R"({"the name":"d'Oude & Kerk","levels":3,"old":true}}},"vertices":[]})",
       R"({"type":"CityJSONFeature","id":"b","CityObjects":{"b":{"type":"Building","children":)"
       R"(["p"]},"p":{"type":"BuildingPart","parents":["b"],"attributes":{"levels":"3","roof":)"
       R"({"type":"flat"}}}},"vertices":[]})"});
  REQUIRE(post("/collections/town/items", lines).status == 201);
  const auto ids = [&](const std::string& query) {
    const server::Response response = get("/collections/town/items" + query);
    INFO(response.body);
    REQUIRE(response.status == 200);
    std::string found;
    const Json page = Json::parse(response.body);
    for (const Json& item : page["features"]) {
      found += item["id"].get<std::string>();
    }
    return found;
  };
  const server::Response refused = get("/collections/town/items?levels=3");
  CHECK(refused.status == 400);
  CHECK(problem_of(refused)["detail"].get<std::string>().find("bbox-crs") != std::string::npos);
  const auto choose = [&](const std::string& body) {
    return send({"PUT",
                 "/collections/town/attributes",
                 {{"content-type", "application/json"}},
                 body})
        .status;
  };
  for (const char* wrong : {"", "[]", "{}", R"({"attributes":"levels"})", R"({"attributes":[1]})",
                            R"({"attributes":[],"more":1})"}) {
    CHECK(choose(wrong) == 400);
  }
  CHECK(choose(R"({"attributes":["levels","the name","old","roof.type"]})") == 200);
  CHECK(ids("?levels=3") == "ab");
  CHECK(ids("?levels=3&limit=1") == "a");
  CHECK(ids("?the%20name=d'Oude%20%26%20Kerk") == "a");
  CHECK(ids("?old=true&levels=3") == "a");
  CHECK(ids("?old=false") == "");
  CHECK(ids("?roof.type=flat") == "b");
  const Json page = Json::parse(get("/collections/town/items?levels=3&limit=1").body);
  CHECK_FALSE(page.contains("numberMatched"));
  bool has_next = false;
  for (const Json& link : page["links"]) {
    if (link["rel"] != "next") continue;
    has_next = true;
    const Json next = Json::parse(get(link["href"].get<std::string>()).body);
    REQUIRE(next["features"].size() == 1);
    CHECK(next["features"][0]["id"] == "b");
  }
  CHECK(has_next);
  const server::Response queryables = get("/collections/town/queryables");
  CHECK(queryables.content_type == "application/schema+json");
  CHECK(Json::parse(queryables.body)["properties"].contains("the name"));
  CHECK(get("/collections/none/queryables").status == 404);
  CHECK(choose(R"({"attributes":["old"]})") == 200);
  CHECK(get("/collections/town/items?levels=3").status == 400);
  const Json chosen = Json::parse(get("/collections/town/attributes").body);
  REQUIRE(chosen["attributes"].size() == 1);
  CHECK(chosen["attributes"][0]["name"] == "old");
}

}  // namespace
}  // namespace watertight
