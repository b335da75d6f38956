// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "formats/document.h"
#include "samples.h"

namespace watertight::test_json_fg {
namespace {

using test::read;

// A tetrahedron; a double would keep the digits of its coordinates, but would print some of them
// otherwise.
const std::string kShell = R"([[[[0.10,0,0],[0.10,1e0,0],[1.1,0,0],[0.10,0,0]]],)"
                           R"([[[0.10,0,0],[1.1,0,0],[0.10,0,1],[0.10,0,0]]],)"
                           R"([[[1.1,0,0],[0.10,1,0],[0.10,0,1],[1.1,0,0]]],)"
                           R"([[[0.10,1,0],[0.10,0,0],[0.10,0,1],[0.10,1,0]]]])";

std::string feature(const std::string& place, const std::string& more = "") {
  return R"({"type":"Feature","id":"a",)" + more +
         R"("geometry":{"type":"Point","coordinates":[5,52]},"properties":{},"place":)" + place +
         "}";
}

std::string polyhedron(const std::string& shells) {
  return R"({"type":"Polyhedron","coordinates":[)" + shells + "]}";
}

Error json_fg_error(const std::string& text) {
  const auto document = read(text, Format::json_fg);
  REQUIRE_FALSE(document);
  CHECK_FALSE(document.error().message.empty());
  return document.error();
}

TEST_CASE("a polyhedron of JSON-FG is a solid with exact coordinates") {
  const auto document =
      read(feature(polyhedron(kShell), R"("featureType":"Building","coordRefSys":"[EPSG:7415]",)"),
           Format::json_fg);
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  const Feature& found = document->features[0];
  CHECK(found.id == "a");
  CHECK(found.type == "Building");
  CHECK(found.srid == 7415);
  REQUIRE(found.solids.size() == 1);
  const SubmittedSolid& solid = found.solids[0];
  CHECK(solid.solid.srid() == 7415);
  CHECK(solid.solid.vertex_count() == 4);
  CHECK(solid.solid.facet_count() == 4);
  CHECK(solid.solid.lattice().kind == LatticeKind::decimal);
  CHECK(solid.solid.world(0) == std::array<double, 3>{0.1, 0, 0});
  CHECK(solid.source.pointer == "/place/coordinates");
  CHECK(solid.source.geometry_type == "Polyhedron");
  CHECK(solid.unclosed_rings.empty());
  CHECK(document->notes.size() == 1);
}

TEST_CASE("collections give their reference system to features that state none") {
  const std::string uri = R"("coordRefSys":["http://www.opengis.net/def/crs/EPSG/0/28992","x"],)";
  const auto document = read(
      R"({"type":"FeatureCollection",)" + uri + R"("features":[)" + feature(polyhedron(kShell)) +
          ',' +
          feature(R"({"type":"MultiPolyhedron","coordRefSys":)"
                  R"({"type":"Reference","href":"https://www.opengis.net/def/crs/EPSG/0/4979"},)"
                  R"("coordinates":[[)" +
                      kShell + "],[" + kShell + ',' + kShell + "]]}",
                  R"("coordRefSys":"EPSG:1",)") +
          R"(,{"type":"Feature","geometry":null,"id":7},)"
          R"({"type":"Feature","place":{"type":"Point","coordinates":[1,2]}}]})",
      Format::json_fg);
  REQUIRE(document);
  REQUIRE(document->features.size() == 2);
  CHECK(document->features[0].srid == 28992);
  CHECK(document->features[1].srid == 4979);
  REQUIRE(document->features[1].solids.size() == 2);
  CHECK(document->features[1].solids[1].solid.shell_count() == 2);
  CHECK(document->features[1].solids[1].source.pointer == "/features/1/place/coordinates/1");
  CHECK(document->features[1].solids[0].solid == document->features[1].solids[0].solid);
  CHECK(document->notes.size() == 2);
}

TEST_CASE("a ring of JSON-FG that does not repeat its first position is listed") {
  std::string shell = kShell;
  const std::string closing = ",[0.10,0,0]]]";
  shell.erase(shell.find(closing), closing.size() - 2);
  const auto document = read(feature(polyhedron(kShell + ',' + shell)), Format::json_fg);
  REQUIRE(document);
  const SubmittedSolid& solid = document->features[0].solids[0];
  CHECK(solid.unclosed_rings == std::vector<Index>{4});
  CHECK(solid.solid.ring(4).size() == 3);
}

TEST_CASE("JSON-FG keeps more digits than a double has, and says what it rounds") {
  std::string shell = kShell;
  shell.replace(shell.find("1.1,"), 4, "1.100000000000000000001,");
  const auto document = read(feature(polyhedron(shell)), Format::json_fg);
  REQUIRE(document);
  CHECK(document->features[0].solids[0].rounded.size() == 1);
}

TEST_CASE("GeoJSON without a polyhedron is unsupported") {
  CHECK(json_fg_error(feature("null")).code == ErrorCode::unsupported);
  CHECK(json_fg_error(R"({"type":"Feature","geometry":null})").code == ErrorCode::unsupported);
  CHECK(json_fg_error(feature(R"({"type":"Polygon","coordinates":[]})")).message.find("GeoJSON") !=
        std::string::npos);
  const Error prism = json_fg_error(feature(R"({"type":"Prism","base":{}})"));
  CHECK(prism.code == ErrorCode::unsupported);
  CHECK(prism.pointer == "/place");
  CHECK(read(R"({"type":"FeatureCollection","features":[]})", Format::json_fg));
}

TEST_CASE("JSON-FG errors have a pointer") {
  CHECK(json_fg_error(feature(polyhedron("5"))).pointer == "/place/coordinates/0");
  CHECK(json_fg_error(feature(polyhedron("[5]"))).pointer == "/place/coordinates/0/0");
  CHECK(json_fg_error(feature(polyhedron("[[5]]"))).pointer == "/place/coordinates/0/0/0");
  CHECK(json_fg_error(feature(polyhedron("[[[5]]]"))).pointer == "/place/coordinates/0/0/0/0");
  CHECK(json_fg_error(feature(polyhedron("[[[[1,2]]]]"))).pointer == "/place/coordinates/0/0/0/0");
  CHECK(json_fg_error(feature(polyhedron("[[[[1,2,\"3\"]]]]"))).pointer ==
        "/place/coordinates/0/0/0/0/2");
  CHECK(json_fg_error(feature(R"({"type":"Polyhedron"})")).pointer == "/place/coordinates");
  CHECK(json_fg_error(R"({"type":"FeatureCollection"})").pointer == "/features");
  CHECK(json_fg_error(R"({"type":"FeatureCollection","features":[{}]})").pointer ==
        "/features/0/type");
  CHECK(json_fg_error(R"({"type":"Topology"})").pointer == "/type");
  CHECK(json_fg_error("[]").pointer == "/type");
  CHECK(json_fg_error("{").byte_offset.has_value());
  CHECK(json_fg_error(std::string(100000, '[')).code == ErrorCode::limit_exceeded);
}

TEST_CASE("empty polyhedra, shells, polygons and rings are left to the validator") {
  for (const std::string shells : {"", "[]", "[[]]", "[[[]]]", "[[[[1,2,3]]]]"}) {
    CHECK(read(feature(polyhedron(shells)), Format::json_fg));
  }
}

TEST_CASE("the type decides the format of JSON files") {
  const auto format = [](std::string_view name, const std::string& text) {
    return *formats::detect_format(name, as_bytes(text));
  };
  CHECK(format("a.json", R"({"metadata":{"type":"Feature"},"x":"\"type", "type" : "CityJSON"})") ==
        Format::city_json);
  CHECK(format("a.json", R"({"features":[{"type":"CityJSON"}],"type":"FeatureCollection"})") ==
        Format::json_fg);
  CHECK(format("", R"({"type":"Feature"})") == Format::json_fg);
  CHECK(format("a.json", R"({"type":"CityJSONFeature"})") == Format::city_json);
  CHECK(format("a.json", "{\"type\":\"CityJSON\"}\n{\"type\":\"CityJSONFeature\"}") ==
        Format::city_json_seq);
  CHECK(format("a.geojson", "") == Format::json_fg);
  CHECK(format("a.json", "{\"type") == Format::city_json);
  CHECK(format("a.json", "{\"type\":\"Feat") == Format::city_json);
}

}  // namespace
}  // namespace watertight::test_json_fg
