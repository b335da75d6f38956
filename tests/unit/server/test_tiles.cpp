// SPDX-License-Identifier: GPL-3.0-or-later
//
// Collections as 3D Tiles and features as glTF. tests/integration/tiles.py compares their geometry
// with the document.
#include <catch2/catch_test_macros.hpp>
#include <cstring>
#include <functional>
#include <set>

#include "server/items/representation_cache.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_tiles {
namespace {

using samples::header_of;
using samples::Json;
using samples::kTwo;
using samples::problem_of;
using Fixture = samples::RoutesFixture;

class TiledCity : public Fixture {
 public:
  TiledCity() {
    std::string text = kTwo;
    text.replace(text.find("100.0,200.0"), 11, "155000,463000");
    REQUIRE(post("/collections/town/items", text).status == 201);
  }
};

Json json_of_glb(const std::string& glb) {
  REQUIRE(glb.size() > 28);
  REQUIRE(glb.starts_with("glTF"));
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, sizeof length);
  return Json::parse(glb.substr(20, length));
}

std::uint64_t features_of_glb(const std::string& glb) {
  return json_of_glb(glb)["extensions"]["EXT_structural_metadata"]["propertyTables"][0]["count"]
      .get<std::uint64_t>();
}

std::string content_of(const Json& tile) {
  return "/collections/town/" + tile["content"]["uri"].get<std::string>();
}

TEST_CASE_METHOD(TiledCity, "a collection is a tileset whose tiles have its features") {
  const server::Response response = get("/collections/town/3dtiles");
  REQUIRE(response.status == 200);
  CHECK(response.content_type == "application/json");
  const Json tileset = Json::parse(response.body);
  CHECK(tileset["asset"]["version"] == "1.1");
  const server::Response tile = get(content_of(tileset["root"]));
  INFO(tile.body);
  REQUIRE(tile.status == 200);
  CHECK(tile.content_type == "model/gltf-binary");
  CHECK(features_of_glb(tile.body) == 2);
  const Json classes = json_of_glb(tile.body)["extensions"]["EXT_structural_metadata"]["schema"];
  const Json& properties = classes["classes"]["feature"]["properties"];
  CHECK(properties.contains("wt_proven"));
  CHECK(properties["height"]["type"] == "SCALAR");
}

TEST_CASE_METHOD(TiledCity, "solids that are not proven are shown too") {
  REQUIRE(post("/collections/open/items?invalid=keep", samples::kOneOpen).status == 201);
  const Json tileset = Json::parse(get("/collections/open/3dtiles").body);
  const server::Response tile =
      get("/collections/open/" + tileset["root"]["content"]["uri"].get<std::string>());
  REQUIRE(tile.status == 200);
  CHECK(features_of_glb(tile.body) == 2);
}

TEST_CASE_METHOD(TiledCity, "the findings are a layer of their own: a pin for each") {
  REQUIRE(post("/collections/open/items?invalid=keep", samples::kOneOpen).status == 201);
  const Json tileset = Json::parse(get("/collections/open/3dtiles?layer=findings").body);
  const std::string address = tileset["root"]["content"]["uri"];
  const server::Response tile = get("/collections/open/" + address);
  INFO(tile.body);
  REQUIRE(tile.status == 200);
  const Json json = json_of_glb(tile.body);
  const Json statistics = Json::parse(get("/collections/open/statistics").body);
  std::uint64_t findings = 0;
  for (const Json& found : statistics["findings"]) findings += found["count"].get<std::uint64_t>();
  CHECK(findings > 0);
  CHECK(features_of_glb(tile.body) == findings);
  const Json& schema = json["extensions"]["EXT_structural_metadata"]["schema"];
  const Json& properties = schema["classes"]["feature"]["properties"];
  CHECK(properties["code"]["type"] == "SCALAR");
  CHECK(properties.contains("detail"));
  // The layer without defects has nothing.
  CHECK_FALSE(Json::parse(get("/collections/town/3dtiles?layer=findings").body)["root"].contains(
      "content"));
  // Both layers are in one frame.
  const Json features = Json::parse(get("/collections/open/3dtiles").body);
  const auto frame_of = [](std::string text) {
    return text.substr(text.find("frame="), text.find('&') - text.find("frame="));
  };
  CHECK(frame_of(address) == frame_of(features["root"]["content"]["uri"]));
  CHECK(problem_of(get("/collections/open/3dtiles?layer=roofs"))["status"] == 400);
}

TEST_CASE_METHOD(TiledCity, "a tileset is unchanged as long as its collection is") {
  const server::Response first = get("/collections/town/3dtiles");
  const std::string tag = *header_of(first, "ETag");
  CHECK(get("/collections/town/3dtiles", {{"if-none-match", tag}}).status == 304);
  const std::string content = content_of(Json::parse(first.body)["root"]);
  CHECK(get(content, {{"if-none-match", tag}}).status == 304);
  REQUIRE(send({"DELETE", "/collections/town/items/a", {}, ""}).status == 204);
  CHECK(get("/collections/town/3dtiles", {{"if-none-match", tag}}).status == 200);
  // An older address still means the features that are in its square.
  const server::Response rest = get(content);
  CHECK((rest.status == 404 || features_of_glb(rest.body) == 1));
}

TEST_CASE_METHOD(TiledCity, "addresses that are in no tileset are refused") {
  const std::string path = "/collections/town/3dtiles/content";
  const std::string good = "?frame=1,2&origin=0,0,0&bounds=0,0,1,1&from=1:2";
  for (const char* wrong : {"", "?frame=1,2", "?frame=1,2&origin=0,0,0&bounds=0,0,1&from=1:2",
                            "?frame=1,nan&origin=0,0,0&bounds=0,0,1,1&from=1:2",
                            "?frame=1,2&origin=0,0,1e300&bounds=0,0,1,1&from=1:2",
                            "?frame=1,2&origin=0,0,0&bounds=0,0,1,1&from=1",
                            "?frame=1,2&origin=0,0,0&bounds=0,0,1,1&from=1:2&below=x",
                            "?frame=1,2,3&origin=0,0,0&bounds=0,0,1,1&from=1:2"}) {
    INFO(wrong);
    CHECK(problem_of(get(path + wrong))["status"] == 400);
  }
  CHECK(problem_of(get(path + good))["status"] == 404);
  CHECK(get("/collections/nowhere/3dtiles").status == 404);
  CHECK(get("/collections/nowhere/3dtiles/content" + good).status == 404);
}

TEST_CASE_METHOD(TiledCity, "tiles are plain glTF where they are wanted so") {
  const Json tileset = Json::parse(get("/collections/town/3dtiles?compression=none").body);
  const server::Response plain = get(content_of(tileset["root"]));
  REQUIRE(plain.status == 200);
  CHECK_FALSE(json_of_glb(plain.body).contains("extensionsRequired"));
  const Json other = Json::parse(get("/collections/town/3dtiles?compression=meshopt").body);
  CHECK(json_of_glb(get(content_of(other["root"])).body).contains("extensionsRequired"));
  CHECK(problem_of(get("/collections/town/3dtiles?compression=draco"))["status"] == 400);
}

TEST_CASE_METHOD(TiledCity, "many features in one place are in several tiles, each once") {
  std::vector<std::string> lines;
  for (int i = 0; i < 1100; ++i) lines.push_back(samples::feature(std::to_string(i)));
  REQUIRE(post("/collections/pile/items", samples::sequence(lines)).status == 201);
  const Json tileset = Json::parse(get("/collections/pile/3dtiles").body);
  std::uint64_t features = 0;
  std::size_t tiles = 0;
  const std::function<void(const Json&)> walk = [&](const Json& tile) {
    const server::Response content =
        get("/collections/pile/" + tile["content"]["uri"].get<std::string>());
    REQUIRE(content.status == 200);
    features += features_of_glb(content.body);
    ++tiles;
    if (!tile.contains("children")) return;
    for (const Json& child : tile["children"]) walk(child);
  };
  walk(tileset["root"]);
  CHECK(features == 1100);
  CHECK(tiles == 3);
}

TEST_CASE_METHOD(TiledCity, "a collection without features is a tileset without tiles") {
  REQUIRE(send({"DELETE", "/collections/town/items/a", {}, ""}).status == 204);
  REQUIRE(send({"DELETE", "/collections/town/items/b", {}, ""}).status == 204);
  const server::Response response = get("/collections/town/3dtiles");
  REQUIRE(response.status == 200);
  CHECK_FALSE(Json::parse(response.body)["root"].contains("content"));
}

TEST_CASE_METHOD(TiledCity, "a feature is a glTF of its own") {
  const server::Response response = get("/collections/town/items/a?f=glb");
  REQUIRE(response.status == 200);
  CHECK(response.content_type == "model/gltf-binary");
  const Json json = json_of_glb(response.body);
  CHECK_FALSE(json.contains("extensionsRequired"));
  const std::size_t indices = json["meshes"][0]["primitives"][0]["indices"];
  CHECK(json["accessors"][indices]["count"] == 36);
  CHECK(get("/collections/town/items/a", {{"accept", "model/gltf-binary"}}).body == response.body);
}

}  // namespace
}  // namespace watertight::test_tiles
