// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>

#include "formats/city_json/city_json.h"
#include "formats/document.h"
#include "samples.h"

namespace watertight::test_city_json {
namespace {

using test::kTwoBuildings;
using test::read;

std::string written(const Document& document, Format format) {
  const auto bytes = formats::write_document(document, format);
  REQUIRE(bytes);
  return std::string(as_text(*bytes));
}

TEST_CASE("a whole CityJSON comes back byte for byte when it was compact") {
  const auto document = read(kTwoBuildings, Format::city_json, false);
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  CHECK(document->features[0].solids.size() == 3);
  CHECK(written(*document, Format::city_json) == kTwoBuildings);
}

TEST_CASE("numbers and strings of attributes keep their value") {
  const std::string text =
      R"({"type":"CityJSON","version":"1.1","transform":{"scale":[0.0010,1e-3,0.001],)"
      R"("translate":[-0.0,1E5,3]},"CityObjects":{"a/b~c":{"type":"GenericCityObject",)"
      R"("attributes":{"s":"\"\\\n\u0001é","f":[0.1,1.50,1e22,5E-324,100000000000000000000],)"
      R"("i":[18446744073709551615,-9223372036854775808],"n":[null,true,false,{},[]]}}},)"
      R"("vertices":[]})";
  const auto document = read(text, Format::city_json, false);
  REQUIRE(document);
  CHECK(written(*document, Format::city_json) == text);
}

TEST_CASE("solids carry source, lattice and SRID") {
  const auto document = read(kTwoBuildings, Format::city_json);
  REQUIRE(document);
  REQUIRE(document->features.size() == 2);
  const Feature& a = document->features[0];
  CHECK(a.id == "a");
  CHECK(a.type == "Building");
  CHECK(a.srid == 7415);
  REQUIRE(a.solids.size() == 1);
  CHECK(a.solids[0].source.object_id == "a");
  CHECK(a.solids[0].source.geometry_type == "Solid");
  CHECK(a.solids[0].source.lod == "2.2");
  CHECK(a.solids[0].source.geometry == 1);
  CHECK(a.solids[0].source.pointer == "/CityObjects/a/geometry/1/boundaries");
  CHECK(a.solids[0].solid.srid() == 7415);
  CHECK(a.solids[0].solid.facet_count() == 4);
  CHECK(a.solids[0].solid.world(1) == std::array<double, 3>{85000.5, 447001.25, -3.0});

  const Feature& b = document->features[1];
  REQUIRE(b.solids.size() == 2);
  CHECK(b.solids[1].source.object_id == "b-1");
  CHECK(b.solids[1].source.ordinal == 1);
  CHECK(b.solids[1].source.pointer == "/CityObjects/b-1/geometry/0/boundaries/1");
  CHECK(b.solids[0].solid.lattice() == b.solids[1].solid.lattice());
}

TEST_CASE("solids are the same whether features are split or not") {
  const auto split = read(kTwoBuildings, Format::city_json, true);
  const auto whole = read(kTwoBuildings, Format::city_json, false);
  REQUIRE(split);
  REQUIRE(whole);
  CHECK(split->features[0].solids[0].solid == whole->features[0].solids[0].solid);
  CHECK(split->features[1].solids[0].solid == whole->features[0].solids[1].solid);
  CHECK(split->features[1].solids[1].solid == whole->features[0].solids[2].solid);
}

TEST_CASE("vertices of a solid are numbered by first use and equal ones are kept apart") {
  const std::string text =
      R"({"type":"CityJSON","version":"1.0","CityObjects":{"a":{"type":"Building","geometry":[)"
      R"({"type":"Solid","lod":1,"boundaries":[[[[3,2,1]],[[1,2,0]]]]}]}},)"
      R"("vertices":[[0.5,0,0],[1,2,3],[0.25,1,1],[1,2,3]]})";
  const auto document = read(text, Format::city_json);
  REQUIRE(document);
  const Solid& solid = document->features[0].solids[0].solid;
  REQUIRE(solid.vertex_count() == 4);
  CHECK(solid.vertices()[0] == solid.vertices()[2]);
  CHECK(solid.world(1) == std::array<double, 3>{0.25, 1, 1});
  CHECK(document->features[0].solids[0].source.lod == "1");
}

TEST_CASE("a feature is a CityJSONFeature with its own vertices") {
  const auto document = read(kTwoBuildings, Format::city_json);
  REQUIRE(document);
  const auto line = formats::write_feature(*document, document->features[0]);
  REQUIRE(line);
  CHECK(*line ==
        R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building",)"
        R"("attributes":{"height":12.50,"big":123456789012345678901234567890},"geometry":[)"
        R"({"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2]]]},)"
        R"({"type":"Solid","lod":"2.2","boundaries":[[[[0,3,1]],[[0,1,4]],[[1,3,4]],[[3,0,4]]]],)"
        R"("semantics":{"surfaces":[{"type":"WallSurface"}],"values":[[0,null,0,0]]}}]}},)"
        R"("vertices":[[0,0,0],[1000,0,0],[99,98,97],[0,1000,0],[0,0,1000]]})");
}

TEST_CASE("a CityJSONSeq of a document reads as the same features") {
  const auto document = read(kTwoBuildings, Format::city_json);
  REQUIRE(document);
  const std::string text = written(*document, Format::city_json_seq);
  const auto again = read(text, Format::city_json_seq);
  REQUIRE(again);
  CHECK(again->header == document->header);
  REQUIRE(again->features.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(again->features[i].skeleton == document->features[i].skeleton);
    CHECK(again->features[i].srid == 7415);
    for (std::size_t j = 0; j < again->features[i].solids.size(); ++j) {
      CHECK(again->features[i].solids[j].solid == document->features[i].solids[j].solid);
    }
  }
  CHECK(written(*again, Format::city_json_seq) == text);
}

TEST_CASE("a stream is read line by line with the header of its first line") {
  const auto document = read(kTwoBuildings, Format::city_json);
  REQUIRE(document);
  const auto header = formats::read_city_json_header(document->header);
  REQUIRE(header);
  CHECK(header->srid == 7415);
  REQUIRE(header->transform);
  CHECK(header->transform->translate[0] == GridNumber{850005, -1});
  const auto line = formats::write_city_json_feature(*header, document->features[1]);
  REQUIRE(line);
  const auto feature = formats::read_city_json_feature(*header, *line);
  REQUIRE(feature);
  CHECK(feature->id == "b");
  CHECK(feature->skeleton == document->features[1].skeleton);
}

TEST_CASE("a changed solid does not fit its skeleton") {
  auto document = read(kTwoBuildings, Format::city_json);
  REQUIRE(document);
  Feature feature = document->features[1];
  feature.solids.pop_back();
  CHECK_FALSE(formats::write_feature(*document, feature));
  feature = document->features[0];
  feature.solids[0].solid = document->features[1].solids[0].solid;
  const auto other = formats::write_feature(*document, feature);
  // The number of vertices is equal: another tetrahedron takes the place of the first one.
  CHECK(other);
  feature.skeleton = "{}";
  CHECK_FALSE(formats::write_feature(*document, feature));
}

TEST_CASE("EPSG codes are found in every spelling of a reference system") {
  const auto srid_of = [](const std::string& name) {
    const auto header = formats::read_city_json_header(
        R"({"type":"CityJSON","version":"1.1","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
        R"("metadata":{"referenceSystem":")" +
        name + R"("},"CityObjects":{},"vertices":[]})");
    REQUIRE(header);
    return header->srid;
  };
  CHECK(srid_of("https://www.opengis.net/def/crs/EPSG/0/7415") == 7415);
  CHECK(srid_of("http://www.opengis.net/def/crs/EPSG/6.12/3068") == 3068);
  CHECK(srid_of("urn:ogc:def:crs:EPSG::7415") == 7415);
  CHECK(srid_of("EPSG:28992") == 28992);
  CHECK(srid_of("urn:ogc:def:crs:EPSG::") == 0);
  CHECK(srid_of("https://www.opengis.net/def/crs/OGC/1.3/CRS84") == 0);
  CHECK(srid_of("EPSG:99999999999999") == 0);
}

}  // namespace
}  // namespace watertight::test_city_json
