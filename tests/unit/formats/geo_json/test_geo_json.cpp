// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/city_json/city_json.h"
#include "formats/geo_json/geo_json.h"
#include "formats/geo_json/other_vertices.h"

namespace watertight::test_geo_json {
namespace {

using formats::CityFeature;
using formats::CityFeatureReader;
using Json = nlohmann::json;

const std::string kHeader =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.01,0.01,0.001],)"
    R"("translate":[85000,447000.5,-2]},"CityObjects":{},"vertices":[],"geometry-templates":)"
    R"({"templates":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}],)"
    R"("vertices-templates":[[0,0,0],[1,0,0],[0,1,0]]}})";

std::string feature_of(const std::string& objects, const std::string& vertices) {
  return R"({"type":"CityJSONFeature","id":"a","CityObjects":{)" + objects + R"(},"vertices":)" +
         vertices + "}";
}

const std::string kSquare =
    "[[0,0,0],[100,0,0],[100,100,0],[0,100,0],[20,20,0],[40,20,0],[20,40,0]]";

CityFeature read(const std::string& text, std::optional<std::string_view> lod = std::nullopt) {
  const auto reader = CityFeatureReader::make(kHeader);
  REQUIRE(reader);
  auto feature = reader->read(text, lod);
  REQUIRE(feature);
  return *std::move(feature);
}

Json written(const CityFeature& feature) {
  return Json::parse(formats::geo_json_feature("a", feature, {{"wt_version", "7"}}));
}

std::string surface(const std::string& lod, const std::string& boundaries) {
  return R"({"type":"MultiSurface","lod":")" + lod + R"(","boundaries":)" + boundaries + "}";
}

TEST_CASE("facets with holes are polygons with closed rings in world coordinates") {
  const CityFeature feature = read(feature_of(
      R"("a":{"type":"Building","geometry":[)" + surface("2", "[[[0,1,2,3],[4,6,5]]]") + "]}",
      kSquare));
  const std::string text = formats::geo_json_feature("a", feature, {});
  CHECK(
      text ==
      R"({"type":"Feature","id":"a","bbox":[85000,447000.5,-2,85001,447001.5,-2],"geometry":)"
      R"({"type":"MultiPolygon","coordinates":[[[[85000,447000.5,-2],[85001,447000.5,-2],)"
      R"([85001,447001.5,-2],[85000,447001.5,-2],[85000,447000.5,-2]],[[85000.2,447000.7,-2],)"
      R"([85000.2,447000.9,-2],[85000.4,447000.7,-2],[85000.2,447000.7,-2]]]]},"properties":{}})");
}

TEST_CASE("each object shows its highest level of detail, and footprints only where they are all") {
  const std::string low = surface("0", "[[[0,1,2,3]]]");
  const std::string high = surface("2.2", "[[[0,1,2]],[[0,2,3]]]");
  const std::string both = R"("a":{"type":"Building","geometry":[)" + low + "]}," +
                           R"("b":{"type":"BuildingPart","parents":["a"],"geometry":[)" +
                           surface("1.3", "[[[0,1,2]]]") + "," + high + "]}";
  CHECK(read(feature_of(both, kSquare)).shapes.polygons.size() == 2);
  CHECK(read(feature_of(both, kSquare), "1.3").shapes.polygons.size() == 1);
  CHECK(read(feature_of(both, kSquare), "0").shapes.polygons.size() == 1);
  CHECK(read(feature_of(both, kSquare), "7").shapes.polygons.empty());
  const std::string alone = R"("a":{"type":"Building","geometry":[)" + low + "]}";
  CHECK(read(feature_of(alone, kSquare)).shapes.polygons.size() == 1);
}

TEST_CASE("solids, lines, points and places of templates are shown") {
  const std::string objects =
      R"("a":{"type":"GenericCityObject","geometry":[)"
      R"({"type":"Solid","lod":"1","boundaries":[[[[0,1,2]],[[0,2,3]]]]},)"
      R"({"type":"MultiSolid","lod":"1","boundaries":[[[[[0,1,2]]]],[[[[0,2,3]]]]]},)"
      R"({"type":"MultiLineString","lod":"1","boundaries":[[0,1,2]]},)"
      R"({"type":"MultiPoint","lod":"1","boundaries":[3]}]},)"
      R"("b":{"type":"GenericCityObject","geometry":[{"type":"GeometryInstance","template":0,)"
      R"("boundaries":[1],"transformationMatrix":[2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1]}]})";
  const CityFeature feature = read(feature_of(objects, kSquare));
  CHECK(feature.shapes.polygons.size() == 5);
  const Json json = written(feature);
  REQUIRE(json["geometry"]["type"] == "GeometryCollection");
  const Json& parts = json["geometry"]["geometries"];
  REQUIRE(parts.size() == 3);
  CHECK(parts[0]["type"] == "MultiPolygon");
  CHECK(parts[0]["coordinates"][4][0] ==
        Json::parse("[[85001.0,447000.5,-2.0],[85003.0,447000.5,-2.0],[85001.0,447002.5,-2.0],"
                    "[85001.0,447000.5,-2.0]]"));
  CHECK(parts[1]["type"] == "MultiLineString");
  CHECK(parts[2]["coordinates"] == Json::parse("[[85000.0,447001.5,-2.0]]"));
}

TEST_CASE("rings that name no vertices are left out, with the holes of an exterior ring") {
  for (const char* boundaries :
       {"[[[0,1,99]]]", "[[[0,1]]]", "[[[]]]", "[[]]", "[]", "[[[0,1,-2]]]", "[[[0,1,\"2\"]]]",
        "[[[0,1],[0,1,2]]]", "[7]", "[[7]]", "[[7,[0,1,2]]]", "[[[[0,1,2]]]]", "[[[0,1,7]]]"}) {
    INFO(boundaries);
    const CityFeature feature =
        read(feature_of(R"("a":{"type":"Building","geometry":[)" + surface("2", boundaries) + "]}",
                        "[[0,0,0],[1,0,0],[1,1,0],[0,1,0],4,[1,2],null,[1,2,\"3\"]]"));
    CHECK(feature.shapes.polygons.empty());
    CHECK(written(feature)["geometry"].is_null());
    CHECK_FALSE(written(feature).contains("bbox"));
  }
}

TEST_CASE("JSON-FG has solids with their cavities as polyhedra, and other geometry as it is") {
  const std::string shells = "[[[[0,1,2]],[[0,2,3]]],[[[4,5,6]]]]";
  const std::string one =
      R"("a":{"type":"Building","geometry":[{"type":"Solid","lod":"2","boundaries":)" + shells +
      "}]}";
  const Json solid =
      Json::parse(formats::json_fg_feature("a", "Building", read(feature_of(one, kSquare)), {}));
  CHECK(solid["place"]["type"] == "Polyhedron");
  REQUIRE(solid["place"]["coordinates"].size() == 2);
  CHECK(solid["place"]["coordinates"][0].size() == 2);
  CHECK(solid["place"]["coordinates"][1][0][0].size() == 4);
  CHECK(solid["geometry"].is_null());
  CHECK(solid["time"].is_null());
  const std::string two = R"("a":{"type":"Building","geometry":[{"type":"MultiSolid","lod":"2",)"
                          R"("boundaries":[)" +
                          shells + "," + shells + "]}]}";
  const Json several =
      Json::parse(formats::json_fg_feature("a", "Building", read(feature_of(two, kSquare)), {}));
  CHECK(several["place"]["type"] == "MultiPolyhedron");
  CHECK(several["place"]["coordinates"].size() == 2);
  const std::string flat =
      R"("a":{"type":"TINRelief","geometry":[)" + surface("2", "[[[0,1,2]]]") + "]}";
  CHECK(Json::parse(formats::json_fg_feature("a", "TINRelief", read(feature_of(flat, kSquare)),
                                             {}))["place"]["type"] == "MultiPolygon");
}

TEST_CASE("small texts that place large templates are not shown beyond a limit") {
  std::string ring;
  for (int i = 0; i < 100'000; ++i) ring += "0,1,2,";
  std::string header = kHeader;
  header.replace(header.find("[[[0,1,2]]]"), 11, "[[[" + ring + "0]]]");
  std::string instances;
  for (int i = 0; i < 7; ++i) {
    instances += std::string(i > 0 ? "," : "") +
                 R"({"type":"GeometryInstance","template":0,"boundaries":[1],)"
                 R"("transformationMatrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})";
  }
  const auto reader = CityFeatureReader::make(header);
  REQUIRE(reader);
  const std::string text =
      feature_of(R"("a":{"type":"Building","geometry":[)" + instances + "]}", kSquare);
  const auto feature = reader->read(text);
  REQUIRE(feature);
  CHECK(feature->is_too_large);
  CHECK(feature->shapes.polygons.empty());
  CHECK(written(*feature)["geometry"].is_null());
}

TEST_CASE("properties are the attributes of the object and what its parts add with one voice") {
  const std::string objects =
      R"("a":{"type":"Building","attributes":{"year":1932,"name":"\u00e9","wt_version":1}},)"
      R"("b":{"type":"BuildingPart","attributes":{"year":5,"roof":"flat","use":[1,{"x":null}]}},)"
      R"("c":{"type":"BuildingPart","attributes":{"roof":"hip","use":[1,{"x":null}],"n":1.50}})";
  const std::string text =
      formats::geo_json_feature("a", read(feature_of(objects, "[]")), {{"wt_version", "7"}});
  CHECK(text == R"({"type":"Feature","id":"a","geometry":null,"properties":{"year":1932,)"
                "\"name\":\"\u00e9\","
                R"("use":[1,{"x":null}],"n":1.50,"wt_version":7}})");
}

TEST_CASE("a text that is no feature is an error") {
  const auto reader = CityFeatureReader::make(kHeader);
  REQUIRE(reader);
  for (const char* text : {"", "{", "[]", "{}", R"({"CityObjects":[]})",
                           R"({"type":"CityJSONFeature","CityObjects":{},"vertices":[]})",
                           R"({"type":"CityJSONFeature","id":"a","CityObjects":{}})",
                           R"({"type":"CityJSONFeature","id":"a","vertices":[]})"}) {
    INFO(text);
    CHECK_FALSE(reader->read(text));
  }
  CHECK_FALSE(CityFeatureReader::make("{"));
  CHECK_FALSE(CityFeatureReader::make(R"({"transform":{"scale":[1,2]}})"));
  CHECK_FALSE(reader->read(feature_of(R"("a":{"geometry":[)" + surface("2", "7") + "]}", "[]")));
  CHECK(reader->read(feature_of("", "[]")));
}

TEST_CASE("the ranges of other vertices have what no solid uses, in world coordinates") {
  formats::ReadOptions options;
  const std::string text =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.5,0.5,0.5],"translate":[10,20,30]},)"
      R"("CityObjects":{"a":{"type":"TINRelief","geometry":[)" +
      surface("1", "[[[0,1,2]]]") + R"(]}},"vertices":[[0,0,0],[4,-2,0],[0,2,8]]})";
  const auto document = formats::read_document(as_bytes(text), Format::city_json, options);
  REQUIRE(document);
  const auto header = formats::read_city_json_header(document->header);
  REQUIRE(header);
  const auto ranges =
      formats::ranges_of_other_vertices(document->features[0].skeleton, header->transform);
  REQUIRE(ranges);
  CHECK(ranges->min == std::array<double, 3>{10, 19, 30});
  CHECK(ranges->max == std::array<double, 3>{12, 21, 34});
  CHECK_FALSE(formats::ranges_of_other_vertices("{}", header->transform));
  CHECK_FALSE(formats::ranges_of_other_vertices("", header->transform));
}

}  // namespace
}  // namespace watertight::test_geo_json
