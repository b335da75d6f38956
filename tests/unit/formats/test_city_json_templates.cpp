// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests geometry templates, and city models that lack optional members.
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "formats/city_json/city_json.h"
#include "formats/document.h"
#include "samples.h"

namespace watertight::test_city_json_templates {
namespace {

using test::part_of;
using test::read;

const std::string kTetrahedron = "[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]]";
const std::string kVertices = "[[0.5,0.0,0.0],[1.0,0.0,0.0],[0.5,1.25,0.0],[0.5,0.0,1e0]]";

std::string model(const std::string& section, const std::string& instance) {
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],)"
         R"("translate":[0,0,0]},)" +
         section + R"("CityObjects":{"tree":{"type":"SolitaryVegetationObject","geometry":[)" +
         instance + R"(]}},"vertices":[[7,8,9]]})";
}

std::string section(const std::string& templates, const std::string& vertices = kVertices) {
  return R"("geometry-templates":{"templates":[)" + templates + R"(],"vertices-templates":)" +
         vertices + "},";
}

std::string geometry(const std::string& type, const std::string& boundaries) {
  return R"({"type":")" + type + R"(","lod":"3","boundaries":)" + boundaries + "}";
}

std::string instance(const std::string& number, const std::string& boundaries = "[0]",
                     const std::string& matrix = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]") {
  return R"({"type":"GeometryInstance","template":)" + number + R"(,"boundaries":)" + boundaries +
         R"(,"transformationMatrix":)" + matrix + "}";
}

/// The note about a template that cannot be read; there is a solid without facets in its place.
std::string note_of(const std::string& text) {
  const auto document = read(text, Format::city_json);
  REQUIRE(document);
  REQUIRE(document->templates.size() == 1);
  CHECK(document->templates[0].solid.facet_count() == 0);
  REQUIRE(document->notes.size() == 1);
  return document->notes.front();
}

Error template_error(const std::string& text) {
  const auto document = read(text, Format::city_json);
  REQUIRE_FALSE(document);
  CHECK_FALSE(document.error().message.empty());
  return document.error();
}

TEST_CASE("templates of solids are read once, on lattices of their own, and written as they were") {
  const std::string text = model(
      section(geometry("MultiSurface", "[[[0,1,2]]]") + ',' + geometry("Solid", kTetrahedron) +
              ',' + geometry("MultiSolid", '[' + kTetrahedron + ',' + kTetrahedron + ']')),
      instance("1") + ',' + instance("2"));
  for (const bool is_split : {true, false}) {
    const auto document = read(text, Format::city_json, is_split);
    REQUIRE(document);
    REQUIRE(document->features.size() == 1);
    CHECK(document->features[0].solids.empty());
    REQUIRE(document->templates.size() == 3);
    const SubmittedSolid& solid = document->templates[0];
    CHECK(solid.source.geometry_type == "Solid");
    CHECK(solid.source.geometry == 1);
    CHECK(solid.source.lod == "3");
    CHECK(solid.source.pointer == "/geometry-templates/templates/1/boundaries");
    CHECK(solid.solid.srid() == 0);
    CHECK(solid.solid.facet_count() == 4);
    CHECK(solid.solid.world(1) == std::array<double, 3>{0.5, 1.25, 0});
    CHECK(document->templates[2].source.pointer == "/geometry-templates/templates/2/boundaries/1");
    const auto written = formats::write_document(*document, Format::city_json);
    REQUIRE(written);
    CHECK(std::string(as_text(*written)).find(kVertices) != std::string::npos);
  }
}

TEST_CASE("the header of a sequence gives its templates") {
  const std::string text = model(section(geometry("Solid", kTetrahedron)), instance("0"));
  const auto document = read(text, Format::city_json);
  REQUIRE(document);
  const auto header = formats::read_city_json_header(document->header);
  REQUIRE(header);
  CHECK(header->template_count == 1);
  const auto templates = formats::read_geometry_templates(*header);
  REQUIRE(templates);
  REQUIRE(templates->solids.size() == 1);
  CHECK(templates->solids[0].solid == document->templates[0].solid);
  const auto sequence = formats::write_document(*document, Format::city_json_seq);
  REQUIRE(sequence);
  const auto again = read(std::string(as_text(*sequence)), Format::city_json_seq);
  REQUIRE(again);
  CHECK(again->templates.size() == 1);
  const std::string feature =
      R"({"type":"CityJSONFeature","id":"t","CityObjects":{"t":{"type":"Tree","geometry":[)" +
      instance("1") + R"(]}},"vertices":[[0,0,0]]})";
  const auto read_feature = formats::read_city_json_feature(*header, feature);
  REQUIRE(read_feature);
  REQUIRE(read_feature->unreadable.size() == 1);
  CHECK(read_feature->unreadable.front().error.pointer == "/CityObjects/t/geometry/0/template");
}

TEST_CASE("errors in templates name the place") {
  const std::string good = instance("0");
  const std::string base = "/geometry-templates/templates";
  CHECK(note_of(model(section(geometry("Solid", "[[[[0,2,4]]]]")), good))
            .ends_with(" at " + base + "/0/boundaries/0/0/0/2"));
  CHECK(note_of(model(section(geometry("Solid", "[[[0,2,1]]]")), good))
            .ends_with(" at " + base + "/0/boundaries/0/0/0"));
  CHECK(note_of(model(section(geometry("MultiSurface", "[[[0,1,4]]]")), good))
            .ends_with(" at " + base + "/0/boundaries/0/0/2"));
  CHECK(note_of(model(section(geometry("Solid", "[[[[0,-2,1]]]]")), good))
            .ends_with(" at " + base + "/0/boundaries/0/0/0/1"));
  CHECK(note_of(model(section(geometry("Solid", "5")), good)).ends_with(" at " + base + "/0"));
  CHECK(note_of(model(section("5"), good)).ends_with(" at " + base + "/0"));
  CHECK(note_of(model(section("{}"), good)).ends_with(" at " + base + "/0"));
  CHECK(template_error(model(R"("geometry-templates":{},)", good)).pointer == base);
  CHECK(template_error(model(R"("geometry-templates":{"templates":[{}]},)", good)).pointer ==
        "/geometry-templates/vertices-templates");
  CHECK(template_error(model(section(geometry("Solid", "[]"), "[[0,0]]"), good)).pointer ==
        "/geometry-templates/vertices-templates/0");
  CHECK(template_error(model(section(geometry("Solid", "[]"), "[[0,0,\"1\"]]"), good)).pointer ==
        "/geometry-templates/vertices-templates/0/2");
}

TEST_CASE("errors in geometry instances name the place") {
  const std::string templates = section(geometry("Solid", kTetrahedron));
  const std::string base = "/CityObjects/tree/geometry/0";
  CHECK(part_of(model(templates, instance("1"))).pointer == base + "/template");
  CHECK(part_of(model(templates, instance("-1"))).pointer == base + "/template");
  CHECK(part_of(model(templates, instance("\"0\""))).pointer == base + "/template");
  CHECK(part_of(model("", instance("0"))).message.find("0 templates") != std::string::npos);
  CHECK(part_of(model(templates, instance("0", "[1]"))).pointer == base + "/boundaries/0");
  CHECK(part_of(model(templates, instance("0", "[0]", "[1,2,3]"))).pointer ==
        base + "/transformationMatrix");
  CHECK(part_of(model(templates, R"({"type":"GeometryInstance","template":0})")).pointer ==
        base + "/boundaries");
  CHECK(part_of(model(templates, instance("0", "[]"))).pointer == base + "/boundaries");
  CHECK(part_of(model(templates, instance("0", "[0]", "[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1]")))
            .pointer == base + "/transformationMatrix");
  CHECK(part_of(model(templates, instance("0", "[0]", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]")))
            .pointer == base + "/transformationMatrix");
  CHECK_FALSE(read(model(templates, instance("0", "[0]", "[1e400,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]")),
                   Format::city_json));
}

TEST_CASE(
    "instances have their template, exact matrix and reference point, in whole and split "
    "documents") {
  const std::string text =
      model(section(geometry("Solid", kTetrahedron)),
            instance("0", "[0]", "[0.10,0,0,1.5,0,2e0,0,-2,0,0,3,0.25,0,0,0.0,1.0]"));
  for (const bool is_split : {true, false}) {
    const auto document = read(text, Format::city_json, is_split);
    REQUIRE(document);
    REQUIRE(document->features.size() == 1);
    REQUIRE(document->features[0].instances.size() == 1);
    const formats::TemplateInstance& found = document->features[0].instances[0];
    CHECK(found.source.object_id == "tree");
    CHECK(found.source.pointer == "/CityObjects/tree/geometry/0");
    CHECK(found.template_number == 0);
    CHECK(found.placement.linear[0][0] == GridNumber{1, -1});
    CHECK(found.placement.linear[1][1] == GridNumber{2, 0});
    CHECK(geometry::shift_of(found.placement) == std::array<double, 3>{8.5, 6, 9.25});
  }
}

TEST_CASE("a child that the document does not hold is an error") {
  const auto with_children = [](const std::string& children) {
    return R"({"type":"CityJSON","version":"1.1","transform":{"scale":[1,1,1],)"
           R"("translate":[0,0,0]},"CityObjects":{"a":{"type":"Building","children":)" +
           children + R"(},"b":{"type":"BuildingPart","parents":["a"]}},"vertices":[]})";
  };
  CHECK(read(with_children("[\"b\"]"), Format::city_json));
  CHECK(part_of(with_children("[\"b\",\"c\"]")).pointer == "/CityObjects/a/children/1");
  CHECK(part_of(with_children("[7]")).pointer == "/CityObjects/a/children/0");
  CHECK(part_of(with_children("{}")).pointer == "/CityObjects/a/children");
}

TEST_CASE("empty boundaries and a missing lod are read without an error") {
  for (const std::string boundaries : {"[]", "[[]]", "[[[]]]", "[[[[]]]]", "[[[[0]]]]"}) {
    const auto document =
        read(model("", R"({"type":"Solid","boundaries":)" + boundaries + "}"), Format::city_json);
    REQUIRE(document);
    REQUIRE(document->features[0].solids.size() == 1);
    CHECK(document->features[0].solids[0].source.lod.empty());
  }
  CHECK(read(model("", R"({"type":"MultiSolid","boundaries":[]})"), Format::city_json)
            ->features[0]
            .solids.empty());
}

TEST_CASE("a lone CityJSONFeature has solids only with a transform of its own") {
  const std::string start = R"({"type":"CityJSONFeature",)";
  const std::string rest =
      R"("id":"a","CityObjects":{"a":{"type":"Building","geometry":[{"type":"Solid","lod":"1",)"
      R"("boundaries":[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]]}]}},)"
      R"("vertices":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]})";
  const auto without = read(start + rest, Format::city_json);
  REQUIRE(without);
  REQUIRE(without->features.size() == 1);
  CHECK(without->features[0].id == "a");
  CHECK(without->features[0].solids.empty());
  REQUIRE(without->features[0].unreadable.size() == 1);
  const Error& error = without->features[0].unreadable[0].error;
  CHECK(error.message.find("has no transform") != std::string::npos);
  CHECK(error.pointer == "/CityObjects/a/geometry/0/boundaries");
  const std::string transform = R"("transform":{"scale":[0.5,0.5,0.5],"translate":[0,0,0]},)";
  const auto with = read(start + transform + rest, Format::city_json);
  REQUIRE(with);
  REQUIRE(with->features[0].solids.size() == 1);
  CHECK(with->features[0].unreadable.empty());
  const Solid& solid = with->features[0].solids[0].solid;
  CHECK(solid.lattice().world_text(solid.vertices()[1][1], 1) == "0.5");
  // An id that is not that of an object is a fault of the feature.
  const auto other = read(start + R"("id":"b","CityObjects":{},"vertices":[]})", Format::city_json);
  REQUIRE(other);
  REQUIRE(other->features[0].unreadable.size() == 1);
  CHECK(other->features[0].unreadable[0].error.pointer == "/id");
  // It is its own text, whatever the name of the file.
  formats::ReadOptions exact;
  exact.split_features = false;
  exact.keep_text = true;
  const std::string text = start + transform + rest;
  const auto whole = formats::read_document(as_bytes(text), Format::city_json, exact);
  REQUIRE(whole);
  for (const Format format : {Format::city_json, Format::city_json_seq}) {
    const auto again = formats::write_document(*whole, format);
    REQUIRE(again);
    CHECK(as_text(*again) == text);
  }
}

}  // namespace
}  // namespace watertight::test_city_json_templates
