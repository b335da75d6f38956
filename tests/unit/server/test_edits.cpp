// SPDX-License-Identifier: GPL-3.0-or-later
// PUT and PATCH of one feature.
#include <catch2/catch_test_macros.hpp>

#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_edits {
namespace {

using samples::feature;
using samples::header_of;
using samples::Json;
using samples::problem_of;
using samples::sequence;

class EditRoutes : public samples::RoutesFixture {
 public:
  EditRoutes() { REQUIRE(post("/collections/town/items", samples::kTwo).status == 201); }
  server::Response change(const std::string& method, const std::string& id, std::string body,
                          std::vector<server::HeaderField> headers = {},
                          const std::string& query = "") const {
    return send(
        {method, "/collections/town/items/" + id + query, std::move(headers), std::move(body)});
  }
  std::string document(const std::string& id) const {
    return get("/collections/town/items/" + id + "?f=cityjsonseq").body;
  }
  std::string tag(const std::string& id) const {
    return *header_of(get("/collections/town/items/" + id), "ETag");
  }
};

TEST_CASE_METHOD(EditRoutes, "a document is put in the place of a feature, or makes one") {
  const auto replaced = change("PUT", "a", sequence({feature("a")}));
  CHECK(replaced.status == 200);
  CHECK(*header_of(replaced, "ETag") == tag("a"));
  CHECK(header_of(replaced, "Location") == nullptr);
  const auto made = change("PUT", "c", sequence({feature("c")}), {{"host", "gis.example"}});
  CHECK(made.status == 201);
  CHECK(*header_of(made, "Location") == "http://gis.example/collections/town/items/c");
  CHECK(get("/collections/town/items/c").status == 200);
  // A CityJSONFeature alone, under the header of the collection.
  CHECK(change("PUT", "b", feature("b")).status == 200);
}

TEST_CASE_METHOD(EditRoutes, "a document of other features is not put") {
  for (const std::string& body : {sequence({feature("b")}), sequence({feature("a"), feature("b")}),
                                  sequence({}), std::string("{\"type\":")}) {
    const auto refused = change("PUT", "a", body);
    CHECK(refused.status == 400);
    CHECK_FALSE(problem_of(refused)["detail"].get<std::string>().empty());
  }
  CHECK(change("PUT", "a", "solid", {{"content-type", "model/stl"}}).status == 415);
  CHECK(change("PUT", "a", sequence({feature("a")}), {}, "?planarity=x").status == 400);
}

TEST_CASE_METHOD(EditRoutes, "a feature that is not valid is not put, and the old one stays") {
  const std::string before = document("a");
  const std::string open = sequence({feature("a", samples::kOpenFacets)});
  const auto refused = change("PUT", "a", open);
  CHECK(refused.status == 422);
  CHECK(problem_of(refused)["report"]["verdict"] == "invalid");
  CHECK(change("PUT", "a", open, {}, "?invalid=skip").status == 422);
  CHECK(document("a") == before);
  CHECK(change("PUT", "a", open, {}, "?invalid=keep").status == 200);
  CHECK(document("a") != before);
}

TEST_CASE_METHOD(EditRoutes, "a patch changes attributes and nothing else") {
  const std::string before = document("a");
  const auto changed = change("PATCH", "a", R"({"properties":{"owner":"city","floors":3}})");
  CHECK(changed.status == 200);
  CHECK(*header_of(changed, "ETag") == tag("a"));
  CHECK(Json::parse(changed.body)["verdict"] == "valid");
  const std::string after = document("a");
  const std::size_t at = after.find(R"("owner":"city","floors":3)");
  REQUIRE(at != std::string::npos);
  CHECK(Json::parse(get("/collections/town/items/a?f=geojson").body)["properties"]["floors"] == 3);
  CHECK(change("PATCH", "a", R"({"properties":{"owner":null,"floors":null}})").status == 200);
  CHECK(document("a") == before);
  CHECK(Json::parse(get("/collections/town/items/a?f=proof").body)["proven"] == true);
}

TEST_CASE_METHOD(EditRoutes,
                 "a patch of a feature that is not proven leaves it as unproven as it was") {
  REQUIRE(post("/collections/town/items?invalid=keep", samples::kOneOpen).status == 201);
  const std::string proof = get("/collections/town/items/open?f=proof").body;
  CHECK(change("PATCH", "open", R"({"properties":{"seen":true}})").status == 200);
  CHECK(get("/collections/town/items/open?f=proof").body == proof);
}

TEST_CASE_METHOD(EditRoutes, "a patch that is not understood changes nothing") {
  const std::string before = tag("a");
  for (const char* body :
       {"", "[]", "{}", "{\"properties\":1}", "{\"properties\":{},\"geometry\":null}",
        "{\"properties\":{\"wt_proven\":true}}", "{\"properties\":{\"a\":"}) {
    INFO(body);
    CHECK(change("PATCH", "a", body).status == 400);
  }
  CHECK(change("PATCH", "nobody", "{\"properties\":{\"a\":1}}").status == 404);
  CHECK(change("PATCH", "a", std::string((1 << 20) + 1, ' ')).status == 413);
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "{\"a\":";
  deep += "1" + std::string(100'000, '}');
  CHECK(change("PATCH", "a", "{\"properties\":" + deep + "}").status == 413);
  CHECK(tag("a") == before);
}

TEST_CASE_METHOD(EditRoutes, "changes keep their conditions") {
  const std::string old = tag("a");
  const std::string patch = R"({"properties":{"n":1}})";
  CHECK(change("PATCH", "a", patch, {{"if-match", old}}).status == 200);
  CHECK(change("PATCH", "a", patch, {{"if-match", old}}).status == 412);
  CHECK(change("PATCH", "a", patch, {{"if-none-match", "*"}}).status == 412);
  CHECK(change("PATCH", "a", patch, {{"if-match", "*"}}).status == 200);
  CHECK(change("PUT", "a", sequence({feature("a")}), {{"if-match", old}}).status == 412);
  CHECK(change("PUT", "a", sequence({feature("a")}), {{"if-none-match", "*"}}).status == 412);
  CHECK(change("PUT", "new", sequence({feature("new")}), {{"if-match", "*"}}).status == 412);
  CHECK(change("PUT", "new", sequence({feature("new")}), {{"if-none-match", "*"}}).status == 201);
  CHECK(change("PUT", "a", sequence({feature("a")}), {{"if-match", tag("a")}}).status == 200);
}

TEST_CASE_METHOD(EditRoutes, "no route is brought down by JSON that is nested a million times") {
  constexpr std::size_t kLevels = 1'000'000;
  std::string objects;
  for (std::size_t i = 0; i < kLevels; ++i) objects += "{\"a\":";
  objects += "1" + std::string(kLevels, '}');
  const std::string lists = std::string(kLevels, '[') + std::string(kLevels, ']');
  for (const server::Route& route : server::routes()) {
    if (!route.method.starts_with('P')) continue;
    std::string path(route.path);
    for (const auto& [name, value] :
         {std::pair{"{collectionId}", "town"}, std::pair{"{itemId}", "a"}}) {
      const std::size_t at = path.find(name);
      if (at != std::string::npos) path.replace(at, std::string(name).size(), value);
    }
    for (const std::string& body : {objects, lists, "{\"properties\":" + objects + "}",
                                    "{\"type\":\"CityJSON\",\"x\":" + lists + "}"}) {
      for (const char* type : {"application/json", "application/geo+json"}) {
        INFO(route.method << ' ' << path << ' ' << type << ' ' << body.substr(0, 30));
        const auto answer = send({std::string(route.method), path, {{"content-type", type}}, body});
        // A count that needs no body does not look at one.
        CHECK((answer.status >= 400 || path.ends_with("/recount")));
        // A service without a folder has no jobs.
        CHECK((answer.status < 500 || path == "/jobs"));
      }
    }
  }
}

}  // namespace
}  // namespace watertight::test_edits
