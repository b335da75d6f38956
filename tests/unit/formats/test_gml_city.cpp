// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/gml/city/city.h"
#include "gml_samples.h"

namespace watertight::test_gml_city {
namespace {

using namespace test;
using Json = nlohmann::json;

formats::GmlCityModel city_of(const std::string& text) {
  auto city = formats::city_model_of_gml(as_bytes(text), Limits{});
  if (!city) FAIL(to_string(city.error()));
  return std::move(*city);
}

Json json_of(const Document& document) {
  const auto bytes = formats::write_document(document, Format::city_json);
  if (!bytes) FAIL(to_string(bytes.error()));
  return Json::parse(as_text(*bytes));
}

/// The object `id` of the CityJSON of a GML text.
Json object_of(const std::string& text, const std::string& id) {
  const Json json = json_of(city_of(text).model);
  REQUIRE(json["CityObjects"].contains(id));
  return json["CityObjects"][id];
}

std::uint64_t losses(const formats::GmlCityModel& city, const std::string& path) {
  for (const formats::GmlLoss& loss : city.losses) {
    if (loss.path == path) return loss.count;
  }
  return 0;
}

bool has_note(const Document& document, const std::string& words) {
  return std::any_of(document.notes.begin(), document.notes.end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

std::string object(const std::string& content) {
  return model("<cityObjectMember><Building g:id=\"b\">" + content +
               "</Building></cityObjectMember>");
}

const std::string kSample = file_text("gml/city_2.gml");

TEST_CASE("GML to CityJSON: objects keep type, id, parents and children") {
  const Json objects = json_of(city_of(kSample).model)["CityObjects"];
  CHECK(objects["house"]["type"] == "Building");
  CHECK(objects["house"]["children"] == Json({"chimney", "room", "BuildingPart-5"}));
  CHECK(objects["chimney"]["type"] == "BuildingInstallation");
  CHECK(objects["room"]["type"] == "BuildingRoom");
  CHECK(objects["stove"]["parents"] == Json({"room"}));
  CHECK(objects["BuildingPart-5"]["parents"] == Json({"house"}));
  CHECK(objects["tin"]["type"] == "TINRelief");
  CHECK(objects["tin"]["attributes"]["ReliefFeature"]["name"] == "Terrain");
  CHECK(objects["group"]["children"] == Json({"tree", "house"}));
  CHECK(objects["group"]["children_roles"] == Json({"shade", "main"}));
  CHECK(objects["house"]["parents"] == Json({"group"}));
}

TEST_CASE("GML to CityJSON: attributes keep names, types, units and the spelling of numbers") {
  const auto city = city_of(kSample);
  const Json attributes = json_of(city.model)["CityObjects"]["house"]["attributes"];
  CHECK(attributes["measuredHeight_uom"] == "m");
  CHECK(attributes["storeyHeightsAboveGround"] == Json({5.0, 5.5}));
  CHECK(attributes["yearOfConstruction"] == 1907);
  CHECK(attributes["function"] == Json({"1010", "1020"}));
  CHECK(attributes["generic:function"] == "taken");
  CHECK(attributes["class_codeSpace"] == "https://example.org/class");
  CHECK(attributes["name_codeSpace"] == Json({nullptr, "https://example.org/names"}));
  CHECK(attributes["key"] == "007");
  CHECK(attributes["flats"] == 3);
  CHECK(attributes["odd"] == "+.5");
  CHECK(attributes["approved_type"] == "date");
  CHECK(attributes["page_type"] == "uri");
  CHECK(attributes["masses"]["volume"]["uom"] == "m3");
  CHECK(attributes["externalReference"]["externalObject"]["name"] == "H-1");
  CHECK(attributes["owner"]["type"] == "Person");
  const auto bytes = formats::write_document(city.model, Format::city_json);
  REQUIRE(bytes);
  const std::string_view text = as_text(*bytes);
  CHECK(text.find(R"("measuredHeight":10.50,)") != std::string_view::npos);
  CHECK(text.find(R"("share":0.330,)") != std::string_view::npos);
  CHECK(text.find(R"("volume":{"value":1260.00,"uom":"m3"})") != std::string_view::npos);
}

TEST_CASE("GML to CityJSON: facets of a solid have the semantics of the surfaces that they are") {
  const Json house = object_of(kSample, "house");
  const Json& solid = house["geometry"][1];
  CHECK(solid["type"] == "Solid");
  CHECK(solid["lod"] == "2");
  CHECK(solid["semantics"]["values"] == Json::parse("[[0,1,1,2]]"));
  const Json& surfaces = solid["semantics"]["surfaces"];
  CHECK(surfaces[0]["type"] == "GroundSurface");
  CHECK(surfaces[1]["id"] == "walls");
  CHECK(surfaces[1]["area"] == 1.0);
  CHECK(surfaces[2]["type"] == "RoofSurface");
  const Json& opening = house["geometry"][3];
  CHECK(opening["type"] == "MultiSurface");
  CHECK(opening["lod"] == "3");
  CHECK(opening["semantics"]["values"] == Json({1}));
  CHECK(opening["semantics"]["surfaces"][1]["type"] == "Door");
  CHECK(opening["semantics"]["surfaces"][1]["parent"] == 0);
  CHECK(opening["semantics"]["surfaces"][0]["children"] == Json({1}));
  CHECK(house["geometry"][0]["semantics"]["surfaces"][0]["type"] == "RoofSurface");
  CHECK(object_of(kSample, "road")["geometry"][0]["semantics"]["surfaces"][0]["type"] ==
        "TrafficArea");
}

TEST_CASE("GML to CityJSON: addresses and appearance are kept") {
  const Json json = json_of(city_of(kSample).model);
  const Json& address = json["CityObjects"]["house"]["address"][0];
  CHECK(address["Country"] == "Germany");
  CHECK(address["Locality"] == "Selfkant");
  CHECK(address["ThoroughfareName"] == "Straße");
  CHECK(address["Postcode"] == "52538");
  CHECK(address["location"]["type"] == "MultiPoint");
  CHECK(json["appearance"]["materials"][0]["name"] == "red");
  CHECK(json["appearance"]["textures"][0]["image"] == "roof.png");
  const Json& solid = json["CityObjects"]["house"]["geometry"][1];
  CHECK(solid["material"]["summer"]["values"] == Json::parse("[[null,0,0,0]]"));
  // The ring of the roof is turned, and its texture with it.
  CHECK(solid["texture"]["summer"]["values"][0][3] == Json::parse("[[0,0,1,2]]"));
}

TEST_CASE("GML to CityJSON: every loss is listed with its place and number") {
  const auto city = city_of(kSample);
  CHECK(losses(city, "Building/lod2TerrainIntersection") == 1);
  CHECK(losses(city, "Building/boundedBy/ClosureSurface") == 1);
  CHECK(losses(city, "CityFurniture/lod1Geometry") == 1);
  CHECK(losses(city, "CityModel/cityObjectMember/Rumour") == 1);
  CHECK(losses(city, "CityModel/description") == 1);
  CHECK(losses(city, "Appearance/surfaceDataMember/GeoreferencedTexture") == 1);
  CHECK(losses(city, "ParameterizedTexture/target/TexCoordList") == 1);
  CHECK(losses(city, "Polygon/@gml:id") == 5);
  CHECK(city.losses.size() == 11);
  CHECK(has_note(city.model, "not mapped: CityModel/description (1 time)"));
  CHECK(has_note(city.model, "written as GenericCityObject: Mast (1 time)"));
  CHECK(has_note(city.model, "1 city object without a gml:id of its own: ids made up"));
  CHECK(has_note(city.model, "geometry left out: line 125: two-dimensional"));
}

TEST_CASE("GML to CityJSON: the solids are those that validation sees") {
  for (const char* name : {"city_2.gml", "citygml_2_xlinks.gml", "defects.gml", "csol5.gml",
                           "igml_703_1.gml", "ogc_Building_LOD2-EPSG25832.gml"}) {
    INFO(name);
    const std::string text = file_text(std::string("gml/") + name);
    const Document solids = gml_of(text);
    const Document city = city_of(text).model;
    for (const Feature& feature : solids.features) {
      for (const SubmittedSolid& solid : feature.solids) {
        CHECK(std::any_of(city.features.begin(), city.features.end(), [&](const Feature& other) {
          return std::any_of(other.solids.begin(), other.solids.end(),
                             [&](const SubmittedSolid& own) { return own.solid == solid.solid; });
        }));
      }
    }
  }
}

TEST_CASE("GML to CityJSON: documents read for a store keep the city model of their features") {
  formats::ReadOptions options;
  options.keep_text = true;
  const auto document = formats::read_document(as_bytes(kSample), Format::gml, options);
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  CHECK(document->features[0].id == "house");
  CHECK(document->features[0].solids.size() == 2);
  CHECK(has_note(*document, "not mapped: CityModel/description (1 time)"));
  const Json objects = json_of(*document)["CityObjects"];
  CHECK(objects.size() == 5);
  CHECK_FALSE(objects["house"].contains("parents"));
  CHECK(objects["house"]["attributes"]["flats"] == 3);
  CHECK(objects["BuildingPart-5"]["geometry"][0]["type"] == "Solid");
}

TEST_CASE("GML to CityJSON: without a store's options features keep no skeleton") {
  CHECK(gml_of(kSample).features[0].skeleton.empty());
}

TEST_CASE("GML to CityJSON: latitude and longitude change places with a note") {
  const std::string solid =
      solid_of(member(kBase) + kSides, R"( srsName="urn:ogc:def:crs:EPSG::6697")");
  const auto city = city_of(object("<lod1Solid>" + solid + "</lod1Solid>"));
  const Document solids = gml_of(object("<lod1Solid>" + solid + "</lod1Solid>"));
  REQUIRE(city.model.features.size() == 1);
  CHECK(city.model.features[0].srid == 6697);
  CHECK(city.model.features[0].solids[0].solid == solids.features[0].solids[0].solid);
  CHECK(has_note(city.model, "written as longitude, latitude"));
}

TEST_CASE("GML to CityJSON: a solid that cannot be read is left out and listed") {
  const std::string text = object("<lod1Solid>" + solid_of(member_of("none")) + "</lod1Solid>");
  const auto city = city_of(text);
  CHECK(has_note(city.model, "line 1: xlink:href '#none': no geometry"));
  CHECK(losses(city, "Building/lod1Solid") == 1);
}

TEST_CASE("GML to CityJSON: surfaces that contain themselves are left out and listed") {
  const std::string loop =
      "<g:CompositeSurface g:id=\"c\">" + member_of("c") + "</g:CompositeSurface>";
  const std::string text =
      object("<lod1Solid><g:Solid><g:exterior>" + loop + "</g:exterior></g:Solid></lod1Solid>");
  const auto city = city_of(text);
  CHECK(has_note(city.model, "contains itself by xlink"));
  CHECK(losses(city, "Building/lod1Solid") == 1);
  const auto other = city_of(object("<lod1MultiSurface>" + loop + "</lod1MultiSurface>"));
  CHECK(has_note(other.model, "contains itself by xlink"));
  CHECK(losses(other, "Building/lod1MultiSurface") == 1);
}

TEST_CASE("GML to CityJSON: xlinks cannot multiply the geometry of a document") {
  std::string text = "<lod1MultiSurface><g:MultiSurface g:id=\"m0\">" + member(kBase) +
                     "</g:MultiSurface></lod1MultiSurface>";
  for (int level = 1; level < 40; ++level) {
    const std::string below = std::string("m").append(std::to_string(level - 1));
    text.append("<lod1MultiSurface><g:MultiSurface g:id=\"m").append(std::to_string(level));
    text.append("\">").append(member_of(below)).append(member_of(below));
    text.append("</g:MultiSurface></lod1MultiSurface>");
  }
  const auto city = city_of(object(text));
  CHECK(has_note(city.model, "xlinks repeat more geometry"));
}

TEST_CASE("GML to CityJSON: themes beyond the limit are listed") {
  std::string text = "<lod1MultiSurface><g:MultiSurface>" +
                     member(polygon("0 0 0 0 1 0 1 0 0 0 0 0", " g:id=\"p\"")) +
                     "</g:MultiSurface></lod1MultiSurface>";
  for (int theme = 0; theme < 70; ++theme) {
    text.append("<appearance><Appearance><theme>t").append(std::to_string(theme));
    text.append("</theme><surfaceDataMember><X3DMaterial><target>#p</target></X3DMaterial>");
    text.append("</surfaceDataMember></Appearance></appearance>");
  }
  const auto city = city_of(object(text));
  CHECK(losses(city, "Building/appearance/Appearance") == 6);
  CHECK(json_of(city.model)["CityObjects"]["b"]["geometry"][0]["material"].size() == 64);
}

TEST_CASE("GML to CityJSON: surfaces that many geometries share cannot multiply their text") {
  std::string text = "<boundedBy><WallSurface g:id=\"w\"><name>" + std::string(200'000, 'n') +
                     "</name><lod2MultiSurface><g:MultiSurface>" +
                     member(polygon("0 0 0 0 1 0 1 0 0 0 0 0", " g:id=\"p\"")) +
                     "</g:MultiSurface></lod2MultiSurface></WallSurface></boundedBy>";
  for (int i = 0; i < 1000; ++i) {
    text.append("<lod2MultiSurface><g:MultiSurface>").append(member_of("p"));
    text.append("</g:MultiSurface></lod2MultiSurface>");
  }
  const auto city = formats::city_model_of_gml(as_bytes(object(text)), Limits{});
  REQUIRE_FALSE(city);
  CHECK(city.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("GML to CityJSON: text and attributes that nothing reads are listed") {
  const std::string point =
      "<g:MultiPoint>stray<g:pointMember><g:Point><g:pos>0 0 0</g:pos>"
      "</g:Point></g:pointMember></g:MultiPoint>";
  const auto city = city_of(object("stray<lod0Point extra=\"1\">" + point + "</lod0Point>"));
  CHECK(losses(city, "Building/text()") == 1);
  CHECK(losses(city, "MultiPoint/text()") == 1);
  CHECK(losses(city, "lod0Point/@extra") == 1);
  CHECK(city.losses.size() == 3);
}

TEST_CASE("GML to CityJSON: long names are cut in the list of losses") {
  const std::string name = std::string(300, 'a') + "TerrainIntersection";
  const auto city = city_of(object("<" + name + "><g:Point/></" + name + ">"));
  REQUIRE(city.losses.size() == 1);
  CHECK(city.losses[0].path == "Building/" + std::string(80, 'a') + "...");
}

TEST_CASE("GML to CityJSON: XML that is not GML is refused as by the reader") {
  const std::string page = "<html><body>404</body></html>";
  const auto city = formats::city_model_of_gml(as_bytes(page), Limits{});
  REQUIRE_FALSE(city);
  CHECK(says(city.error(), "not GML: the root element is 'html'"));
}

TEST_CASE("GML to CityJSON: coordinates that no grid holds are rounded with a note") {
  const auto far = solid_of(member(polygon("0 0 0 0 1 0 1 0 0 0 0 0")) + kSides +
                            member(polygon("1e16 0 0 0 1e-3 0 1 0 0 1e16 0 0")));
  const auto city = city_of(object("<lod1Solid>" + far + "</lod1Solid>"));
  CHECK(has_note(city.model, "rounded to the finest grid"));
}

TEST_CASE("GML to CityJSON: equal and missing ids get new ones") {
  const std::string twice = "<cityObjectMember><Building g:id=\"b\"/></cityObjectMember>";
  const auto city =
      city_of(model(twice + twice + "<cityObjectMember><Building/></cityObjectMember>"));
  const Json objects = json_of(city.model)["CityObjects"];
  CHECK(objects.size() == 3);
  CHECK(objects.contains("b"));
  CHECK(objects.contains("b-2"));
  CHECK(objects.contains("Building-3"));
  CHECK(has_note(city.model, "2 city objects without a gml:id of its own"));
}

}  // namespace
}  // namespace watertight::test_gml_city
