// SPDX-License-Identifier: GPL-3.0-or-later
//
// Collections that are made before their first document, with policy and rules.
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "tests/unit/server/answers.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_collections {
namespace {

using samples::header_of;
using samples::Json;
using samples::problem_of;

constexpr const char* kCrs = "http://www.opengis.net/def/crs/EPSG/0/7415";

/// A box whose top is bent by some 20 mm.
std::string bent() {
  std::string text = samples::feature("bent");
  const std::string corner = "[1000,1000,2500]";
  text.replace(text.find(corner), corner.size(), "[1000,1000,2580]");
  return samples::sequence({text});
}

class Fixture : public samples::RoutesFixture {
 public:
  server::Response put(const std::string& body, const std::string& id = "town") {
    return send({"PUT", "/collections/" + id, {{"content-type", "application/json"}}, body});
  }
  server::Response patch(const std::string& body) {
    return send({"PATCH", "/collections/town", {{"content-type", "application/json"}}, body});
  }
  Json town() { return Json::parse(get("/collections/town").body); }
};

TEST_CASE_METHOD(Fixture, "a collection is made with its CRS, its policy and its rules") {
  const std::string body = std::string(R"({"storageCrs":")") + kCrs +
                           R"(","invalid":"keep","rules":{"planarity":0.02,"proof":"boundary"}})";
  const auto made = put(body);
  REQUIRE(made.status == 201);
  CHECK(*header_of(made, "Location") == "/collections/town");
  const Json json = Json::parse(made.body);
  CHECK(json["storageCrs"] == kCrs);
  CHECK(json["invalid"] == "keep");
  CHECK(json["rules"] == Json{{"planarity", 0.02}, {"proof", "boundary"}});
  CHECK(json["features"] == 0);
  CHECK(Json::parse(get("/collections/town/items").body)["features"].empty());
  // Again it sets both; what is not stated becomes the usual.
  CHECK(put(R"({"rules":{"strict":true}})").status == 200);
  CHECK(town()["rules"] == Json{{"strict", true}});
  CHECK(town()["invalid"] == "refuse");
  CHECK(put(R"({"storageCrs":null})").status == 409);
  CHECK(post("/collections/town/items", samples::kTwo).status == 201);
  CHECK(town()["features"] == 2);
}

TEST_CASE_METHOD(Fixture, "a body about a collection that means nothing is refused") {
  for (const char* wrong :
       {"", "[]", "{", R"({})", R"({"storageCrs":"EPSG:7415"})", R"({"storageCrs":7415})",
        R"({"storageCrs":"http://www.opengis.net/def/crs/EPSG/0/0"})",
        R"({"storageCrs":null,"rules":{"planarity":0}})",
        R"({"storageCrs":null,"rules":{"planarity":"x"}})",
        R"({"storageCrs":null,"rules":{"planarity":[1]}})",
        R"({"storageCrs":null,"rules":{"other":1}})", R"({"storageCrs":null,"rules":7})",
        R"({"storageCrs":null,"rules":{"strict":1}})", R"({"storageCrs":null,"invalid":"maybe"})",
        R"({"storageCrs":null,"id":"other"})", R"({"storageCrs":null,"name":"x"})"}) {
    INFO(wrong);
    CHECK(put(wrong).status == 400);
  }
  CHECK(get("/collections/town").status == 404);
  CHECK(put(R"({"storageCrs":null})", "no%2Fname").status == 400);
  REQUIRE(put(R"({"storageCrs":null})").status == 201);
  for (const char* wrong : {"{}", R"({"storageCrs":null})", R"({"rules":1})"}) {
    INFO(wrong);
    CHECK(patch(wrong).status == 400);
  }
}

TEST_CASE_METHOD(Fixture, "the rules of a collection count where a request states no others") {
  REQUIRE(put(std::string(R"({"storageCrs":")") + kCrs + R"("})").status == 201);
  CHECK(post("/collections/town/items", bent()).status == 422);
  REQUIRE(patch(R"({"rules":{"planarity":0.05}})").status == 200);
  CHECK(post("/collections/town/items", bent()).status == 201);
  CHECK(post("/collections/town/items?planarity=0.001", bent()).status == 422);
  // A change of attributes judges the solids again, by the rules of the collection.
  const auto changed = send({"PATCH",
                             "/collections/town/items/bent",
                             {{"content-type", "application/merge-patch+json"}},
                             R"({"properties":{"height":3}})"});
  CHECK(changed.status == 200);
  CHECK(town()["unproven"]["features"] == 0);
  CHECK(patch(R"({"rules":null})").status == 200);
  CHECK(town()["rules"].empty());
  CHECK(post("/collections/town/items", bent()).status == 422);
}

TEST_CASE_METHOD(Fixture, "statistics sum up volumes, findings and bytes") {
  const std::string text = samples::sequence({samples::feature("a"), samples::feature("b"),
                                              samples::feature("open", samples::kOpenFacets)});
  REQUIRE(post("/collections/town/items?invalid=keep", text).status == 201);
  const auto response = get("/collections/town/statistics");
  REQUIRE(response.status == 200);
  const Json json = Json::parse(response.body);
  CHECK(json["features"] == 3);
  REQUIRE(json["levels"].size() == 1);
  const Json& level = json["levels"][0];
  CHECK(level["lod"] == "2.2");
  CHECK(level["solids"] == 3);
  CHECK(level["proven"] == 2);
  CHECK(level["volume"] == 5.0);  // two boxes of 1 x 1 x 2.5
  CHECK(level["area"] == 24.0);
  REQUIRE(json["findings"].size() == 1);
  CHECK(json["findings"][0]["code"] == 302);
  CHECK(json["findings"][0]["name"] == "SHELL_NOT_CLOSED");
  CHECK(json["findings"][0]["count"].get<int>() >= 1);
  CHECK(json["bytes"]["arrays"] == 2 * (8 * 24 + 24 * 4));
  CHECK(json["bytes"]["solids"].get<int>() > 0);
  CHECK(json["ratio"].get<double>() > 1);
  const auto unchanged =
      get("/collections/town/statistics", {{"if-none-match", *header_of(response, "ETag")}});
  CHECK(unchanged.status == 304);
  CHECK(get("/collections/none/statistics").status == 404);
}

TEST_CASE_METHOD(Fixture, "an answer names features that may be there twice") {
  const auto first = post("/collections/town/items", samples::sequence({samples::feature("a")}));
  CHECK_FALSE(Json::parse(first.body).contains("duplicates"));
  // The same again is no duplicate; under another id it is.
  const auto again = post("/collections/town/items", samples::sequence({samples::feature("a")}));
  CHECK_FALSE(Json::parse(again.body).contains("duplicates"));
  const auto second = post("/collections/town/items", samples::sequence({samples::feature("b")}));
  REQUIRE(second.status == 201);
  CHECK(Json::parse(second.body)["duplicates"] ==
        Json{{"count", 1}, {"first", {{{"id", "b"}, {"sameBoxAs", "a"}}}}});
}

}  // namespace
}  // namespace watertight::test_collections
