// SPDX-License-Identifier: GPL-3.0-or-later
//
// Schemas and profiles. The names of abstract tests are those of OGC 23-058r2 (OGC API - Common,
// part 3), annex A, and of JSON-FG (OGC 21-045r1).
#include <catch2/catch_test_macros.hpp>
#include <set>
#include <string>

#include "tests/unit/server/answers.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_schemas {
namespace {

using samples::header_of;
using samples::Json;

std::string with_attributes(const std::string& id, const std::string& attributes) {
  std::string text = samples::feature(id);
  const std::string own = R"({"height":2.50})";
  text.replace(text.find(own), own.size(), attributes);
  return text;
}

class Town : public samples::RoutesFixture {
 public:
  Town() {
    const std::string text = samples::sequence(
        {with_attributes("a", R"({"n":1,"r":1,"t":true,"m":"x","o":{"k":1},"id":"A","e":null})"),
         with_attributes("b", R"({"n":2,"r":0.5,"m":3,"l":[1,2]})")});
    REQUIRE(post("/collections/town/items", text).status == 201);
    REQUIRE(
        send({"PUT", "/collections/town/attributes", {}, R"({"attributes":["n","m"]})"}).status ==
        200);
  }
  Json schema(const std::string& name) {
    const auto response = get("/collections/town/" + name,
                              {{"host", "example.org"}, {"accept", "application/schema+json"}});
    REQUIRE(response.status == 200);
    CHECK(response.content_type == "application/schema+json");
    return Json::parse(response.body);
  }
};

// /conf/schemas/basic-schema-inspection, role, role-id; /conf/advanced-property-roles/
// role-primary-geometry, role-type; /conf/sortables/op-and-response
TEST_CASE_METHOD(Town, "schemas are JSON Schemas whose properties have types and roles") {
  for (const std::string name : {"schema", "sortables", "queryables"}) {
    INFO(name);
    const Json found = schema(name);
    CHECK(found["$schema"] == "https://json-schema.org/draft/2020-12/schema");
    CHECK(found["$id"] == "http://example.org/collections/town/" + name);
    CHECK(found["type"] == "object");
    const std::set<std::string> known{"title", "type", "format", "readOnly", "x-ogc-role"};
    for (const auto& [key, property] : found["properties"].items()) {
      INFO(key);
      if (property.contains("format")) {
        CHECK_FALSE(property.contains("type"));
        CHECK(property["format"].get<std::string>().starts_with("geometry-"));
      } else {
        CHECK(property.contains("type"));
      }
      for (const auto& [keyword, value] : property.items()) CHECK(known.contains(keyword));
    }
  }
  const Json sortables = schema("sortables");
  for (const auto& [key, property] : sortables["properties"].items()) {
    CHECK(property["type"] != "array");
    CHECK(property["type"] != "object");
  }
}

TEST_CASE_METHOD(Town, "the schema of features has the types of all values") {
  const Json properties = schema("schema")["properties"];
  CHECK(properties["n"]["type"] == "integer");
  CHECK(properties["r"]["type"] == "number");
  CHECK(properties["t"]["type"] == "boolean");
  CHECK(properties["m"]["type"] == Json({"string", "integer"}));
  CHECK(properties["o"]["type"] == "object");
  CHECK(properties["l"]["type"] == "array");
  CHECK(properties["e"]["type"].is_array());
  CHECK(properties["id"]["type"] == "string");
  CHECK_FALSE(properties["id"].contains("x-ogc-role"));
  CHECK(properties["wt_id"]["x-ogc-role"] == "id");
  CHECK(properties["geometry"]["x-ogc-role"] == "primary-geometry");
  CHECK(properties["wt_type"]["x-ogc-role"] == "type");
  // The features have these properties, and no others.
  const Json page = Json::parse(get("/collections/town/items?f=geojson").body);
  for (const Json& feature : page["features"]) {
    for (const auto& [name, value] : feature["properties"].items()) {
      INFO(name);
      CHECK(properties.contains(name));
    }
  }
  // It changes with the collection.
  const auto etag = *header_of(get("/collections/town/schema"), "ETag");
  CHECK(get("/collections/town/schema", {{"if-none-match", etag}}).status == 304);
  REQUIRE(send({"PATCH", "/collections/town/items/b", {}, R"({"properties":{"new":1}})"}).status ==
          200);
  CHECK(schema("schema")["properties"].contains("new"));
  CHECK(get("/collections/none/schema").status == 404);
  CHECK(get("/collections/town/schema", {{"accept", "text/html"}}).status == 406);
}

// /conf/sortables/link
TEST_CASE_METHOD(Town, "a collection leads to its schemas") {
  const Json collection = Json::parse(get("/collections/town", {{"host", "h"}}).body);
  std::set<std::string> found;
  for (const Json& link : collection["links"]) {
    const std::string relation = link["rel"];
    const std::string prefix = "http://www.opengis.net/def/rel/ogc/1.0/";
    if (!relation.starts_with(prefix)) continue;
    const std::string name = relation.substr(prefix.size());
    found.insert(name);
    CHECK(link["href"] == "http://h/collections/town/" + name);
    CHECK(link["type"] == "application/schema+json");
  }
  CHECK(found == std::set<std::string>{"queryables", "schema", "sortables"});
}

// /conf/profile-parameter/profile-param, profile-param-response; JSON-FG:
// /req/api/profile-parameter
TEST_CASE_METHOD(Town, "GeoJSON comes in the profile that the client wants") {
  const std::string fg = "http://www.opengis.net/def/profile/OGC/0/jsonfg";
  const std::string plain = "http://www.opengis.net/def/profile/OGC/0/rfc7946";
  for (const std::string item : {"/collections/town/items", "/collections/town/items/a"}) {
    for (const std::string& profile :
         {std::string(), std::string("rfc7946"), std::string("jsonfg"), std::string("other,jsonfg"),
          std::string("%5Bogc-profile:jsonfg%5D"), fg, std::string("other")}) {
      INFO(item + " " + profile);
      const auto response = get(item + (profile.empty() ? "" : "?profile=" + profile),
                                {{"accept", "application/geo+json"}});
      REQUIRE(response.status == 200);
      CHECK(response.content_type == "application/geo+json");
      const Json json = Json::parse(response.body);
      const bool is_json_fg = profile.find("jsonfg") != std::string::npos;
      CHECK(json.contains("conformsTo") == is_json_fg);
      std::string links;
      for (const Json& link : json.value("links", Json::array())) {
        if (link["rel"] == "profile") links += link["href"].get<std::string>();
      }
      if (const std::string* field = header_of(response, "Link")) links += *field;
      CHECK((links.find(fg) != std::string::npos) == is_json_fg);
      CHECK((links.find(plain) != std::string::npos) == !is_json_fg);
    }
  }
}

}  // namespace
}  // namespace watertight::test_schemas
