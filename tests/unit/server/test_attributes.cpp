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

namespace watertight::test_attributes {
namespace {

using samples::Json;
using samples::problem_of;
using Fixture = samples::RoutesFixture;

// Abstract tests of part 3: /conf/filter, /conf/features-filter, /conf/queryables; of CQL2:
// /conf/cql2-text, /conf/cql2-json, /conf/basic-cql2, /conf/advanced-comparison-operators.
TEST_CASE_METHOD(Fixture, "a filter in CQL2 selects items, as text and as JSON") {
  const auto house = [](const std::string& id, const std::string& attributes) {
    return R"({"type":"CityJSONFeature","id":")" + id + R"(","CityObjects":{")" + id +
           R"(":{"type":"Building","attributes":)" + attributes + R"(}},"vertices":[]})";
  };
  const std::string lines = samples::sequence(
      {house("a", R"({"height":12.5,"roof":"flat","old":true,"built":"1899-03-01"})"),
       house("b", R"({"height":3,"roof":"gable","old":false,"built":"1950-01-01"})"),
       house("c", R"({"roof":"flatter"})"), samples::feature("d")});
  REQUIRE(post("/collections/town/items", lines).status == 201);
  REQUIRE(send({"PUT",
                "/collections/town/attributes",
                {{"content-type", "application/json"}},
                R"({"attributes":["height","roof","old","built"]})"})
              .status == 200);
  const auto ids = [&](const std::string& filter, const std::string& more = "") {
    const server::Response response =
        get("/collections/town/items?limit=100&filter=" + server::percent_encode(filter) + more);
    INFO(filter << ' ' << response.body);
    REQUIRE(response.status == 200);
    std::string found;
    const Json page = Json::parse(response.body);
    for (const Json& item : page["features"]) found += item["id"].get<std::string>();
    return found;
  };
  const std::pair<const char*, const char*> kTexts[] = {{"height > 3", "a"},
                                                        {"height >= 3", "ab"},
                                                        {"height <> 3", "ad"},
                                                        {"NOT height = 3", "ad"},
                                                        {"roof = 'flat' OR old = FALSE", "ab"},
                                                        {"roof LIKE 'flat%'", "ac"},
                                                        {"roof NOT LIKE 'flat%'", "b"},
                                                        {"roof IN ('gable','flatter')", "bc"},
                                                        {"height BETWEEN 3 AND 12.5", "ab"},
                                                        {"height IS NULL", "c"},
                                                        {"NOT (height > 3 OR roof = 'x')", "b"},
                                                        {"built < DATE('1900-01-01')", "a"},
                                                        {"TRUE", "abcd"},
                                                        {"FALSE", ""}};
  for (const auto& [filter, found] : kTexts) CHECK(ids(filter) == found);
  CHECK(ids("roof LIKE 'flat%'", "&height=12.5") == "a");
  CHECK(ids(R"({"op":"and","args":[{"op":">=","args":[{"property":"height"},3]},
            {"op":"like","args":[{"property":"roof"},"g%"]}]})",
            "&filter-lang=cql2-json") == "b");
  const std::string storage = "&filter-crs=" + server::percent_encode(server::crs_uri(7415));
  CHECK(ids("S_INTERSECTS(geometry, BBOX(-1000, -1000, 1000, 1000))", storage) == "d");
  CHECK(ids("NOT S_INTERSECTS(geometry, BBOX(-1000, -1000, 1000, 1000))", storage) == "abc");
  CHECK(ids("S_INTERSECTS(geometry, BBOX(5000, 5000, 6000, 6000))", storage) == "");
  const auto page =
      get("/collections/town/items?limit=1&filter=" + server::percent_encode("height >= 3"));
  CHECK(page.body.find("filter=height%20%3E%3D%203") != std::string::npos);  // in the next link
  CHECK(get("/collections/town/items?sortby=-height").status == 200);
  for (const char* wrong :
       {"?sortby=", "?sortby=-", "?sortby=width", "?sortby=height,roof",
        "?filter=", "?filter=height", "?filter=width%20%3D%203", "?filter-lang=ecql&filter=TRUE",
        "?filter=TRUE&filter-lang=cql2-json&filter-crs=x", "?filter=height%20%3D%203%29"}) {
    INFO(wrong);
    CHECK(get(std::string("/collections/town/items") + wrong).status == 400);
  }
  const Json problem = problem_of(get("/collections/town/items?filter=height%20%3D%20%27"));
  CHECK(problem["detail"].get<std::string>().find("(at character 9)") != std::string::npos);
  CHECK_FALSE(problem.contains("byteOffset"));
  const Json queryables = Json::parse(get("/collections/town/queryables").body);
  CHECK(queryables["properties"]["geometry"]["x-ogc-role"] == "primary-geometry");
  CHECK(queryables["properties"].contains("height"));
}

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
}  // namespace watertight::test_attributes
