// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "curved_texts.h"
#include "formats/document.h"
#include "validate/certify.h"

namespace watertight {
namespace {

constexpr double kPi = std::numbers::pi;

Result<Document> read(const std::string& text, double chord = 0.001) {
  const auto format = formats::detect_format("", as_bytes(text));
  REQUIRE(format);
  formats::ReadOptions options;
  options.curved.chord = chord;
  return formats::read_document(as_bytes(text), *format, options);
}

geometry::Measures measures_of(const SubmittedSolid& solid) {
  CertifyOptions options;
  options.proof = Proof::boundary;
  const auto report = certify(solid.solid, nullptr, options).report;
  CHECK(report.verdict == Verdict::valid);
  REQUIRE(report.measures);
  return *report.measures;
}

/// The error of the only solid of a text.
Error solid_error(const std::string& text) {
  const auto document = read(text);
  if (!document) return document.error();
  REQUIRE(document->features.size() == 1);
  REQUIRE(document->features[0].unreadable.size() == 1);
  return document->features[0].unreadable[0].error;
}

}  // namespace

TEST_CASE("STEP: a cylinder in millimetres is a valid solid in metres") {
  const auto document = read(test::step_cylinder());
  REQUIRE(document);
  CHECK(document->format == Format::step);
  REQUIRE(document->features.size() == 1);
  REQUIRE(document->features[0].solids.size() == 1);
  const SubmittedSolid& solid = document->features[0].solids[0];
  CHECK(solid.source.object_id == "#2");
  REQUIRE(solid.tessellation);
  CHECK(solid.tessellation->faces == 3);
  CHECK(solid.tessellation->edges == 3);
  CHECK(solid.tessellation->turned == 0);
  CHECK(solid.tessellation->chord_error <= 0.001);
  CHECK(solid.tessellation->left_out.empty());
  const auto measures = measures_of(solid);
  CHECK(std::abs(measures.volume - 0.04 * kPi) < 0.001 * 0.48 * kPi);
  // The finer the chord, the nearer the volume.
  const auto fine = read(test::step_cylinder(), 1e-5);
  REQUIRE(fine);
  const auto finer = measures_of(fine->features[0].solids[0]);
  CHECK(std::abs(finer.volume - 0.04 * kPi) < 1e-5 * 0.48 * kPi);
}

TEST_CASE("STEP: names may be omitted") {
  std::string text = test::step_cylinder();
  const std::string named = "('',";
  for (auto at = text.find("DATA;"); (at = text.find(named, at)) != std::string::npos; ++at) {
    if (text[at - 1] != 'T' || text.compare(at - 7, 7, "CONTEXT") != 0) {
      text.replace(at, named.size(), "($,");
    }
  }
  REQUIRE(text.find("CARTESIAN_POINT($,") != std::string::npos);
  const auto document = read(text);
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  REQUIRE(document->features[0].solids.size() == 1);
  CHECK(document->features[0].solids[0].tessellation->left_out.empty());
  const auto measures = measures_of(document->features[0].solids[0]);
  CHECK(std::abs(measures.volume - 0.04 * kPi) < 0.001 * 0.48 * kPi);
}

TEST_CASE("STEP: a part of an assembly is a feature for each of its places") {
  const auto document = read(test::step_assembly());
  REQUIRE(document);
  CHECK(document->notes.empty());
  struct Expected {
    std::string id;
    std::array<double, 3> low;
    std::array<double, 3> high;
  };
  const std::vector<Expected> expected{
      {"#2@#90@#94", {10.8, -0.2, 0}, {11.2, 0.2, 1}},
      {"#2@#90@#96", {-0.2, 0.8, 20}, {0.2, 1.2, 21}},
      {"#2@#92@#94", {10, 1.8, -0.2}, {11, 2.2, 0.2}},
      {"#2@#92@#96", {-2.2, 0, 19.8}, {-1.8, 1, 20.2}},
      {"#2@#101", {-5.2, -0.2, 0}, {-4.8, 0.2, 1}},
  };
  REQUIRE(document->features.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(expected[i].id);
    const formats::Feature& feature = document->features[i];
    CHECK(feature.id == expected[i].id);
    REQUIRE(feature.solids.size() == 1);
    CHECK(feature.solids[0].source.object_id == expected[i].id);
    const auto measures = measures_of(feature.solids[0]);
    CHECK(std::abs(measures.volume - 0.04 * kPi) < 0.001 * 0.48 * kPi);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CHECK(std::abs(measures.box_min[axis] - expected[i].low[axis]) <= 0.001);
      CHECK(std::abs(measures.box_max[axis] - expected[i].high[axis]) <= 0.001);
    }
  }
}

TEST_CASE("STEP: placements that cannot be read leave a part where it was drawn, with a note") {
  const auto document =
      read(test::replaced(test::step_assembly(), "#91=ITEM_DEFINED_TRANSFORMATION('','',#80,#81);",
                          "#91=ITEM_DEFINED_TRANSFORMATION('','',#80,#110);"));
  REQUIRE(document);
  CHECK(document->features.size() == 5);
  REQUIRE(document->notes.size() == 1);
  CHECK(document->notes[0] ==
        "the placement #90 of a part is not applied: #110 (CARTESIANPOINT): a placement should "
        "stand here");
}

TEST_CASE("STEP: assemblies that contain themselves are malformed") {
  const auto document = read(test::replaced(test::step_assembly(), "'',#72,#73)", "'',#72,#70)"));
  REQUIRE_FALSE(document);
  CHECK(document.error().code == ErrorCode::malformed);
  CHECK(document.error().message.find("assemblies in assemblies without end") != std::string::npos);
}

TEST_CASE("STEP: parts that are repeated without measure meet the limit") {
  std::string text = test::step_assembly();
  // Each of 40 more wholes has the one before twice.
  std::string more = "#301=SHAPE_REPRESENTATION('',(#83,#84),#64);\n";
  for (int i = 0; i < 40; ++i) {
    const std::string whole = std::to_string(301 + i);
    const std::string part = i == 0 ? "73" : std::to_string(300 + i);
    if (i > 0) more += "#" + whole + "=SHAPE_REPRESENTATION('',(#83),#64);\n";
    for (const int copy : {1, 2}) {
      more += "#" + std::to_string(400 + 2 * i + copy) + "=(REPRESENTATION_RELATIONSHIP('','',#" +
              part + ",#" + whole +
              ") REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#95) "
              "SHAPE_REPRESENTATION_RELATIONSHIP());\n";
    }
  }
  text = test::replaced(text, "ENDSEC;\nEND-ISO", more + "ENDSEC;\nEND-ISO");
  const auto document = read(text);
  REQUIRE_FALSE(document);
  CHECK(document.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("IFC: a product is a feature where its placements put it, other bodies are counted") {
  const auto document = read(test::ifc_cylinder());
  REQUIRE(document);
  CHECK(document->format == Format::ifc);
  REQUIRE(document->features.size() == 1);
  CHECK(document->features[0].id == "wall-1");
  CHECK(document->features[0].type == "IFCWALL");
  REQUIRE(document->features[0].solids.size() == 1);
  const auto measures = measures_of(document->features[0].solids[0]);
  CHECK(std::abs(measures.volume - 0.04 * kPi) < 0.001 * 0.48 * kPi);
  CHECK(std::abs(measures.box_min[0] - 9.8) < 1e-4);
  CHECK(std::abs(measures.box_max[2] - 1) < 1e-4);
  REQUIRE(document->notes.size() == 1);
  CHECK(document->notes[0] == "1 body of the kind IFCEXTRUDEDAREASOLID left out");
}

TEST_CASE("IFC: mapped items are placed, scaled and mirrored, and stay turned outwards") {
  const auto document = read(test::ifc_mapped_tetrahedron());
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  REQUIRE(document->features[0].solids.size() == 2);
  const auto plain = measures_of(document->features[0].solids[0]);
  CHECK(std::abs(plain.volume - 1.0 / 6) < 1e-12);
  const auto mirrored = measures_of(document->features[0].solids[1]);
  CHECK(std::abs(mirrored.volume - 8.0 / 6) < 1e-12);
  CHECK(mirrored.box_min[0] == 5);
  CHECK(mirrored.box_min[1] == -2);
}

TEST_CASE("IFC: sets of faces are solids") {
  const auto document = read(test::ifc_face_sets());
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  REQUIRE(document->features[0].solids.size() == 2);
  const auto ring = measures_of(document->features[0].solids[0]);
  CHECK(ring.volume == 6);
  CHECK(ring.genus == 1);
  CHECK(std::abs(measures_of(document->features[0].solids[1]).volume - 1.0 / 6) < 1e-12);
}

TEST_CASE("a face that cannot be read is named, and the solid has a hole there") {
  const auto document = read(test::replaced(
      test::step_cylinder(), "CYLINDRICAL_SURFACE('',#33,200.)", "OFFSET_SURFACE()"));
  REQUIRE(document);
  const SubmittedSolid& solid = document->features[0].solids[0];
  REQUIRE(solid.tessellation);
  REQUIRE(solid.tessellation->left_out.size() == 1);
  CHECK(solid.tessellation->left_out[0].face == "#6");
  CHECK(certify(solid.solid, nullptr, {}).report.verdict == Verdict::invalid);
}

TEST_CASE("hostile references and numbers are errors of their solid, with a place") {
  const std::string whole = test::step_cylinder();
  for (const auto& [part, by] :
       {std::pair("(#16)", "(#99)"), std::pair("(#16)", "(#13)"), std::pair("#25,#25", "#3,#3"),
        std::pair("(200.,0.,0.)", "(200.)"), std::pair("(200.,0.,0.)", "(200.,'a',0.)"),
        std::pair("#33,200.);\n#41", "#33,-200.);\n#41"), std::pair("(0.,0.,1.)", "(0.,0.,0.)"),
        std::pair("(#18,#19,#20,#21)", "(#18,#19,#20)"), std::pair("(#4,#5,#6)", "#4"),
        std::pair("SURFACE_CURVE('',#43", "SURFACE_CURVE('',#41")}) {
    CAPTURE(part, by);
    const Error error = solid_error(test::replaced(whole, part, by));
    CHECK_FALSE(error.message.empty());
  }
  CHECK(solid_error(test::replaced(whole, "(#61,#62)", "(#61,#62,#64)")).message.size() > 1);
  const std::string contradicting =
      test::replaced(test::replaced(whole, "(#61,#62)", "(#61,#62,#64)"),
                     "#62=", "#64=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.));\n#62=");
  CHECK(solid_error(contradicting).message.find("contradict") != std::string::npos);
}

TEST_CASE("placements and mapped items that go round in circles are errors") {
  const std::string placed =
      test::replaced(test::ifc_cylinder(), "#7=IFCLOCALPLACEMENT($,", "#7=IFCLOCALPLACEMENT(#8,");
  CHECK_FALSE(read(placed));
  const std::string mapped =
      test::replaced(test::ifc_mapped_tetrahedron(), "'Brep',(#21)", "'Brep',(#14,#15)");
  CHECK_FALSE(read(mapped));
}

TEST_CASE("a document of curved solids is written as a city model and as OBJ") {
  const auto document = read(test::ifc_face_sets());
  REQUIRE(document);
  for (const Format format : {Format::city_json, Format::city_json_seq, Format::wkt}) {
    CHECK(formats::write_document(*document, format));
  }
  CHECK_FALSE(formats::write_document(*document, Format::ifc));
  CHECK_FALSE(formats::write_document(*document, Format::step));
}

}  // namespace watertight
