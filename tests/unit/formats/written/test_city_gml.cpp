// SPDX-License-Identifier: GPL-3.0-or-later
//
// City models as CityGML, read again by the reader of CityGML.
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/gml/city/city.h"
#include "formats/gml/written/city_gml.h"

namespace watertight::test_city_gml {
namespace {

using Json = nlohmann::json;

const std::string kVertices =
    "[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,1500],[1000,0,1500],[1000,1000,1500],"
    "[0,1000,1500],[200,0,300],[400,0,300],[300,0,700]]";

std::string model_of(const std::string& objects, const std::string& vertices = kVertices) {
  return R"({"type":"CityJSON","version":"2.0","metadata":{"title":"A <town> & more",)"
         R"("referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/28992"},)"
         R"("transform":{"scale":[0.001,0.001,0.01],"translate":[85000.5,447000,-2]},)"
         R"("CityObjects":{)" +
         objects + R"(},"vertices":)" + vertices + "}";
}

std::string gml_of(const std::string& text, bool is_split = true) {
  formats::ReadOptions options;
  options.split_features = is_split;
  const auto document = formats::read_document(as_bytes(text), Format::city_json, options);
  REQUIRE(document);
  const auto gml = formats::write_city_gml(*document);
  if (!gml) INFO(to_string(gml.error()));
  REQUIRE(gml);
  return *gml;
}

Json placed(const Json& boundaries, const Json& model) {
  if (boundaries.is_number()) {
    Json place = model["vertices"][boundaries.get<std::size_t>()];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value =
          place[axis].get<double>() * model["transform"]["scale"][axis].get<double>() +
          model["transform"]["translate"][axis].get<double>();
      place[axis] = std::llround(value * 1e6);
    }
    return place;
  }
  Json list = Json::array();
  for (const Json& element : boundaries) list.push_back(placed(element, model));
  return list;
}

Json surface_values(const Json& values, const Json& surfaces) {
  if (values.is_null()) return nullptr;
  if (values.is_number()) {
    Json surface = surfaces[values.get<std::size_t>()];
    surface.erase("children");
    if (surface.contains("parent")) {
      surface["parent"] = surfaces[surface["parent"].get<std::size_t>()]["type"];
    }
    return surface;
  }
  Json list = Json::array();
  for (const Json& value : values) list.push_back(surface_values(value, surfaces));
  return list;
}

/// The objects with coordinates in place of vertex numbers, and surfaces in place of theirs.
Json objects_of(const Json& model) {
  Json objects = model["CityObjects"];
  for (Json& object : objects) {
    if (!object.contains("geometry")) continue;
    for (Json& geometry : object["geometry"]) {
      geometry["boundaries"] = placed(geometry["boundaries"], model);
      if (!geometry.contains("semantics")) continue;
      geometry["semantics"] =
          surface_values(geometry["semantics"]["values"], geometry["semantics"]["surfaces"]);
    }
  }
  return objects;
}

Json read_again(const std::string& gml) {
  const auto city = formats::city_model_of_gml(as_bytes(gml), {});
  if (!city) INFO(to_string(city.error()) + "\n" + gml);
  REQUIRE(city);
  for (const auto& loss : city->losses) CHECK(loss.path.ends_with("/@gml:id"));
  const auto text = formats::write_document(city->model, Format::city_json);
  REQUIRE(text);
  return Json::parse(as_text(*text));
}

/// Compares the objects of a model with what its CityGML says.
void check_same(const std::string& objects) {
  const std::string text = model_of(objects);
  const std::string gml = gml_of(text, false);
  INFO(gml);
  CHECK(gml.find("not written") == std::string::npos);
  const Json again = read_again(gml);
  const Json expected = objects_of(Json::parse(text));
  const Json found = objects_of(again);
  for (const auto& [id, object] : expected.items()) {
    INFO(id);
    REQUIRE(found.contains(id));
    CHECK(found[id] == object);
  }
  CHECK(found.size() == expected.size());
  CHECK(again["metadata"]["referenceSystem"] == "https://www.opengis.net/def/crs/EPSG/0/28992");
  CHECK(again["metadata"]["title"] == "A <town> & more");
}

const std::string kCube =
    "[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4],[8,9,10]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]";

std::string solid(const std::string& level, const std::string& more = "") {
  return R"({"type":"Solid","lod":")" + level + R"(","boundaries":)" + kCube + more + "}";
}

std::string square(const std::string& level, const std::string& more = "") {
  return R"({"type":"MultiSurface","lod":")" + level + R"(","boundaries":[[[0,1,2,3]]])" + more +
         "}";
}

TEST_CASE("a building keeps its parts, levels, surfaces with openings and address") {
  const std::string semantics =
      R"(,"semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface","id":"roof",)"
      R"("slope":30.5},{"type":"WallSurface","children":[3]},{"type":"Window","parent":2}],)"
      R"("values":[[0,1,2,2,2,3]]})";
  check_same(
      R"("house":{"type":"Building","children":["porch","room","part"],"attributes":{)"
      R"("name":"Town hall","class":"1000","class_codeSpace":"codes.xml","function":["a","b"],)"
      R"("roofType":"flat","measuredHeight":12.50,"measuredHeight_uom":"m"},"address":[{)"
      R"("Country":"NL","Locality":"Delft","ThoroughfareNumber":"1","ThoroughfareName":"Markt",)"
      R"("Postcode":"2611"}]},)"
      R"("part":{"type":"BuildingPart","parents":["house"],"geometry":[)" +
      square("0", R"(,"semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[0]})") + "," +
      solid("1") + "," + solid("3", semantics) +
      R"(]},"porch":{"type":"BuildingInstallation","parents":["house"],"geometry":[)" + solid("2") +
      R"(]},"room":{"type":"BuildingRoom","parents":["house"],"children":["chair"],"geometry":[)" +
      solid("4") + R"(]},"chair":{"type":"BuildingFurniture","parents":["room"],"geometry":[)" +
      solid("4") + "]}");
}

TEST_CASE("objects of all modules keep their geometry") {
  const std::string area =
      R"(,"semantics":{"surfaces":[{"type":"TrafficArea","function":"1"}],"values":[0]})";
  const std::string water =
      R"(,"semantics":{"surfaces":[{"type":"WaterSurface"}],"values":[[0,0,0,0,0,0]]})";
  check_same(R"("road":{"type":"Road","geometry":[)" + square("2", area) +
             R"(]},"track":{"type":"Railway","geometry":[)" + square("1") +
             R"(]},"market":{"type":"TransportSquare","geometry":[)" + square("2") +
             R"(]},"lake":{"type":"WaterBody","geometry":[)" + square("1") + "," +
             solid("2", water) + R"(]},"field":{"type":"LandUse","geometry":[)" + square("0") +
             R"(]},"wood":{"type":"PlantCover","attributes":{"averageHeight":7},"geometry":[)" +
             R"({"type":"MultiSolid","lod":"2","boundaries":[)" + kCube + "]}" +
             R"(]},"tree":{"type":"SolitaryVegetationObject","attributes":{"species":"oak"},)"
             R"("geometry":[)" +
             solid("2") +
             R"(]},"ground":{"type":"TINRelief","attributes":{"lod":1},"geometry":[)"
             R"({"type":"CompositeSurface","lod":"1","boundaries":[[[0,1,2]],[[0,2,3]]]})"
             R"(]},"lamp":{"type":"CityFurniture","geometry":[)"
             R"({"type":"MultiPoint","lod":"1","boundaries":[0,1]})"
             R"(]},"thing":{"type":"GenericCityObject","geometry":[)"
             R"({"type":"MultiLineString","lod":"0","boundaries":[[0,1,2],[4,5]]})"
             R"(]},"bridge":{"type":"Bridge","children":["pier"],"geometry":[)" +
             solid("1") +
             R"(]},"pier":{"type":"BridgeConstructiveElement","parents":["bridge"],"geometry":[)" +
             solid("2") +
             R"(]},"tunnel":{"type":"Tunnel","children":["hollow"]},)"
             R"("hollow":{"type":"TunnelHollowSpace","parents":["tunnel"],"geometry":[)" +
             solid("4") + R"(]},"group":{"type":"CityObjectGroup","children":["tree2"],)" +
             R"("children_roles":["old"]},"tree2":{"type":"SolitaryVegetationObject",)" +
             R"("parents":["group"],"geometry":[)" + solid("1") + "]}");
}

TEST_CASE("attributes keep their names, values and digits") {
  check_same(
      R"("a":{"type":"LandUse","attributes":{"creationDate":"2024-05-01","externalReference":)"
      R"({"informationSystem":"x","externalObject":{"uri":"urn:1"}},"text":"a < b & \"c\"",)"
      R"("long":123456789012345678901234567890,"exact":1.2300,"none":"","day":"2020-01-01",)"
      R"("day_type":"date","link":"http://a","link_type":"uri","height":{"value":3.10,"uom":"m"},)"
      R"("list":["a","b"],"numbers":[1,2.50],"set":{"inner":1,"deeper":{"x":"y"}},"class":"1",)"
      R"("generic:usage":{"value":1,"uom":"cm"},"usage":"u","line\nend":"1\n2"},"geometry":[)" +
      square("1") + "]}");
}

/// The element of a list in an appearance; null for null.
Json meant(const Json& number, const Json& list) {
  return number.is_null() ? Json() : list[number.get<std::size_t>()];
}

/// Materials and textures by theme, with what they are in place of numbers.
Json looks_of(const Json& geometry, const Json& appearance) {
  Json looks = Json::object();
  for (const auto& [theme, look] : geometry["material"].items()) {
    for (const Json& value : look["values"]) {
      looks["material"][theme].push_back(meant(value, appearance["materials"]));
    }
  }
  for (const auto& [theme, look] : geometry["texture"].items()) {
    for (const Json& facet : look["values"]) {
      Json rings = Json::array();
      for (const Json& ring : facet) {
        Json named = Json::array({meant(ring[0], appearance["textures"])});
        for (std::size_t i = 1; i < ring.size(); ++i) {
          named.push_back(meant(ring[i], appearance["vertices-texture"]));
        }
        rings.push_back(named);
      }
      looks["texture"][theme].push_back(rings);
    }
  }
  return looks;
}

TEST_CASE("materials and textures come back with the facets that have them") {
  const std::string geometry =
      R"({"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2,3],[8,9,10]],[[4,5,6]],[[0,1,4]]],)"
      R"("semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[0,null,0]},)"
      R"("material":{"day":{"values":[0,null,1]},"night":{"values":[1,1,1]}},)"
      R"("texture":{"day":{"values":[[[0,0,1,2,3],[1,3,2,0]],[[null]],[[0,1,2,3]]]}}})";
  std::string text = model_of(R"("a":{"type":"Building","geometry":[)" + geometry + "]}");
  text.pop_back();
  text += R"(,"appearance":{"materials":[{"name":"red","diffuseColor":[1.0,0,0],"shininess":0.2,)"
          R"("isSmooth":true},{"name":"glass","transparency":0.5}],"textures":[{"type":"PNG",)"
          R"("image":"a/b.png","wrapMode":"wrap"},{"type":"JPG","image":"c.jpg","borderColor":)"
          R"([0,0.5,1,1]}],"vertices-texture":[[0,0],[1,0],[1.0,0.250],[0,1]]}})";
  const Json model = Json::parse(text);
  const Json& expected = model["CityObjects"]["a"]["geometry"][0];
  for (const bool is_split : {false, true}) {
    const std::string gml = gml_of(text, is_split);
    INFO(gml);
    CHECK(gml.find("not written") == std::string::npos);
    const Json again = read_again(gml);
    const Json& found = again["CityObjects"]["a"]["geometry"][0];
    CHECK(placed(found["boundaries"], again) == placed(expected["boundaries"], model));
    CHECK(looks_of(found, again["appearance"]) == looks_of(expected, model["appearance"]));
  }
}

TEST_CASE("parts without a place in CityGML are named") {
  const std::string gml = gml_of(model_of(
      R"("a":{"type":"Building","geographicalExtent":[0,0,0,1,1,1],"attributes":{"n":null,"b":true},)"
      R"("children":["s"],"geometry":[)" +
      solid("1.2") + "," + solid("1.3") + "," + solid("2", R"(,"material":{"m":{"value":0}})") +
      R"(]},"s":{"type":"BuildingStorey","parents":["a"]},)"
      R"("x":{"type":"+Shed","geometry":[)" +
      square("1", R"(,"semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[0]})") + "]}"));
  for (const char* part :
       {"attributes without a value (1 time)", "the type of the values true and false (1 time)",
        "geometries of level of detail 1.2 (1 time)", "materials that do not exist (6 times)",
        "the level of detail as 1.3 (1 time)", "places in a parent, of BuildingStorey (1 time)",
        "the type of objects: +Shed (1 time)", "the type of objects: BuildingStorey (1 time)",
        "semantics of facets: RoofSurface (1 time)",
        "the member geographicalExtent of objects (1 time)"}) {
    INFO(gml);
    CHECK(gml.find(std::string("<!-- not written: ") + part + " -->") != std::string::npos);
  }
  const Json again = read_again(gml);
  CHECK(again["CityObjects"]["x"]["type"] == "GenericCityObject");
  CHECK(again["CityObjects"]["a"]["geometry"].size() == 2);
}

TEST_CASE("ids that are no names of XML get some, all different") {
  const Json again = read_again(gml_of(model_of(
      R"("{1}":{"type":"LandUse"},"{2}":{"type":"LandUse"},"1":{"type":"LandUse"},)"
      R"("_x_7B1_7D":{"type":"LandUse"},"\u00e9\u0001":{"type":"LandUse"},"":{"type":"LandUse"})")));
  CHECK(again["CityObjects"].size() == 6);
}

TEST_CASE("CityGML of a damaged model is well-formed") {
  std::string deep = R"("p0":{"type":"Building","children":["p1"]})";
  for (int i = 1; i < 3000; ++i) {
    deep += ",\"p" + std::to_string(i) + R"(":{"type":"BuildingPart","parents":["p)" +
            std::to_string(i - 1) + R"("],"children":["p)" + std::to_string((i + 1) % 3000) +
            "\"]}";
  }
  CHECK(read_again(gml_of(model_of(deep), false))["CityObjects"].size() == 3000);
  const std::string bad =
      R"("a":{"type":"Building","attributes":{"b":"\u0001\uffff--"},"children":["b",7],)"
      R"("address":[{"location":{"boundaries":[99,"x",0]}}],"geometry":[)"
      R"({"type":"Solid","lod":1,"boundaries":[[[[0,1,99]],[[0,1]],[[0,11,2]],[]]]},)"
      R"({"type":"Solid","lod":"2","boundaries":[[["y"]]]},{"type":"MultiSurface","lod":"2"},)"
      R"({"type":"MultiSurface","lod":"3","boundaries":[[[0,1,2]]],"semantics":)"
      R"({"surfaces":[{"type":"Window","parent":0},{"type":"Door","parent":9}],"values":[0]}}]},)"
      R"("b":{"type":"BuildingPart","parents":["b"],"children":["a","b"]})";
  std::string vertices = kVertices;
  vertices.insert(vertices.size() - 1, ",[1,2]");
  const std::string gml = gml_of(model_of(bad, vertices), false);
  const auto read = formats::city_model_of_gml(as_bytes(gml), {});
  INFO(gml);
  CHECK(read);
  CHECK(gml.find("rings without vertices (2 times)") != std::string::npos);
  CHECK(gml.find("geometries that cannot be read (2 times)") != std::string::npos);
}

}  // namespace
}  // namespace watertight::test_city_gml
