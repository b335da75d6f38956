// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surfaces of GML and of sequences of CityJSON, beside the solids of their features.
#include "formats/feature_reader.h"
#include "gml_samples.h"

namespace watertight::test_surfaces {
namespace {

using formats::Surfaces;
using test::kBase;
using test::kSides;
using test::member;
using test::member_of;
using test::polygon;

Document read_with(const std::string& text, Surfaces surfaces) {
  formats::ReadOptions options;
  options.surfaces = surfaces;
  auto document = formats::read_document(as_bytes(text), Format::gml, options);
  if (!document) FAIL(to_string(document.error()));
  return std::move(*document);
}

std::string surface_building(const std::string& surface, const std::string& id = "b") {
  return "<cityObjectMember><Building g:id=\"" + id + "\"><lod2MultiSurface>" + surface +
         "</lod2MultiSurface></Building></cityObjectMember>";
}

std::string multi_surface(const std::string& members) {
  return "<g:MultiSurface>" + members + "</g:MultiSurface>";
}

const std::string kClosed = multi_surface(member(kBase) + kSides);

TEST_CASE("surfaces of GML are read where they are asked for") {
  const std::string text = test::model(surface_building(kClosed));
  CHECK(read_with(text, Surfaces::ignore).features.empty());
  const Document document = read_with(text, Surfaces::read);
  REQUIRE(document.features.size() == 1);
  const Feature& feature = document.features[0];
  CHECK(feature.id == "b");
  CHECK(feature.solids.empty());
  REQUIRE(feature.surfaces.size() == 1);
  const SubmittedSolid& surface = feature.surfaces[0];
  CHECK(surface.source.geometry_type == "MultiSurface");
  CHECK(surface.source.lod == "2");
  CHECK(surface.source.object_id == "b");
  CHECK(surface.solid.shell_count() == 1);
  CHECK(surface.solid.facet_count() == 4);
  CHECK(surface.solid.vertex_count() == 4);
  CHECK(surface.facet_lines == std::vector<std::uint64_t>{1, 1, 1, 1});
}

TEST_CASE("closed surfaces of GML are solids where that is asked for") {
  const std::string open = multi_surface(kSides);
  const Document document = read_with(
      test::model(surface_building(kClosed) + surface_building(open, "o")), Surfaces::as_solids);
  REQUIRE(document.features.size() == 2);
  CHECK(document.features[0].solids.size() == 1);
  CHECK(document.features[0].surfaces.empty());
  CHECK(test::is_closed(document.features[0].solids[0].solid));
  CHECK(document.features[1].solids.empty());
  CHECK(document.features[1].surfaces.size() == 1);
}

TEST_CASE("a surface of polygons that a solid refers to is not read twice") {
  const std::string wall = polygon("0 0 0 0 1 0 1 0 0 0 0 0", " g:id=\"base\"");
  const std::string solid = test::solid_of(member_of("base") + kSides);
  const std::string building =
      "<cityObjectMember><Building g:id=\"b\"><lod2Solid>" + solid +
      "</lod2Solid><boundedBy><GroundSurface g:id=\"s\"><lod2MultiSurface>" +
      multi_surface(member(wall)) +
      "</lod2MultiSurface></GroundSurface></boundedBy></Building></cityObjectMember>";
  const Document document = read_with(test::model(building), Surfaces::read);
  REQUIRE(document.features.size() == 1);
  CHECK(document.features[0].solids.size() == 1);
  CHECK(document.features[0].surfaces.empty());
}

TEST_CASE("a surface that cannot be read says why, and the solids stay") {
  const std::string bad = multi_surface(member_of("nowhere"));
  const std::string building = "<cityObjectMember><Building g:id=\"b\"><lod2Solid>" +
                               test::kTetrahedron + "</lod2Solid><lod2MultiSurface>" + bad +
                               "</lod2MultiSurface></Building></cityObjectMember>";
  const Document document = read_with(test::model(building), Surfaces::read);
  REQUIRE(document.features.size() == 1);
  CHECK(document.features[0].solids.size() == 1);
  REQUIRE(document.features[0].surfaces.size() == 1);
  CHECK(document.features[0].surfaces[0].unreadable.find("nowhere") != std::string::npos);
}

TEST_CASE("the solids are the same whether surfaces are read or not") {
  const std::string text =
      test::model(test::building(test::kTetrahedron, "a") +
                  surface_building(multi_surface(member(polygon("0.5 0 0 0 1 0 1 0 0 0.5 0 0")))));
  const Document without = read_with(text, Surfaces::ignore);
  const Document with = read_with(text, Surfaces::read);
  REQUIRE(without.features.size() == 1);
  REQUIRE(with.features.size() == 2);
  CHECK(without.features[0].solids[0].solid == with.features[0].solids[0].solid);
}

TEST_CASE("a feature of a sequence has its surfaces, on a lattice of their own") {
  const std::string header =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
      R"("CityObjects":{},"vertices":[]})";
  const std::string line =
      R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building","geometry":[)"
      R"({"type":"CompositeSurface","lod":"1","boundaries":[[[0,1,2]],[[0,2,3]]]},)"
      R"({"type":"MultiSurface","lod":"1","boundaries":[]}]}},)"
      R"("vertices":[[0,0,0],[2,0,0],[2,2,0],[0,2,0]]})";
  const auto parsed = formats::read_city_json_header(header);
  REQUIRE(parsed);
  formats::ReadOptions options;
  options.surfaces = Surfaces::read;
  const auto feature = formats::read_city_json_feature(*parsed, line, options);
  REQUIRE(feature);
  REQUIRE(feature->surfaces.size() == 2);
  CHECK(feature->surfaces[0].solid.facet_count() == 2);
  CHECK(feature->surfaces[0].source.pointer == "/CityObjects/a/geometry/0/boundaries");
  CHECK(feature->surfaces[1].solid.facet_count() == 0);
  CHECK(formats::is_surface(feature->surfaces[0].source));
  CHECK(*formats::write_city_json_feature(*parsed, *feature) == line);
}

}  // namespace
}  // namespace watertight::test_surfaces
