// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "formats/document.h"
#include "tests/unit/curved/curved_texts.h"
#include "validate/certify.h"

namespace watertight {
namespace {

Result<Document> read_as(Format format, const std::string& text, double chord = 0.001) {
  formats::ReadOptions options;
  options.curved.chord = chord;
  options.curved.keeps_strips = true;
  return formats::read_document(as_bytes(text), format, options);
}

// The verdict, and the measures of a valid solid.
Report report_of(const SubmittedSolid& solid) {
  CertifyOptions options;
  options.proof = Proof::boundary;
  return certify(solid.solid, nullptr, options).report;
}

double volume_of(const Result<Document>& document) {
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  if (!document->features[0].unreadable.empty()) {
    FAIL(document->features[0].unreadable[0].error.message);
  }
  REQUIRE(document->features[0].solids.size() == 1);
  const Report report = report_of(document->features[0].solids[0]);
  CHECK(report.verdict == Verdict::valid);
  REQUIRE(report.measures);
  return report.measures->volume;
}

// Two circles of radius 1 in the planes z = 0 and z = 2, with a face on each, and one more.
std::string between_circles(const std::string& side, const std::string& top_radius = "1") {
  return R"({"type":"BRep","solids":[{"id":"a","vertices":[[1,0,0],[)" + top_radius + R"(,0,2]],
    "edges":[{"vertices":[0,0],"curve":{"type":"circle","radius":1}},
             {"vertices":[1,1],"curve":{"type":"circle","origin":[0,0,2],"radius":)" +
         top_radius +
         R"(}}],
    "faces":[{"loops":[[-1]]},{"loops":[[1]]},{"surface":)" +
         side + R"(,"loops":[[0],[-2]]}]}]})";
}

Error brep_error(const std::string& text) {
  const auto document = read_as(Format::brep, text);
  if (!document) return document.error();
  REQUIRE(document->features.size() == 1);
  REQUIRE(document->features[0].unreadable.size() == 1);
  return document->features[0].unreadable[0].error;
}

// The six sides of a cube of 1 m as bilinear patches, or as bicubic ones.
std::string cube_patches(bool is_cubic, std::size_t patches = 6) {
  const double corners[6][4][3] = {
      {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
      {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}}, {{1, 0, 0}, {1, 1, 0}, {1, 0, 1}, {1, 1, 1}},
      {{1, 1, 0}, {0, 1, 0}, {1, 1, 1}, {0, 1, 1}}, {{0, 1, 0}, {0, 0, 0}, {0, 1, 1}, {0, 0, 1}}};
  const std::size_t degree = is_cubic ? 3 : 1;
  std::string text = std::to_string(patches) + "\n";
  for (std::size_t p = 0; p < patches; ++p) {
    text += std::to_string(degree) + " " + std::to_string(degree) + "\n";
    for (std::size_t k = 0; k <= degree; ++k) {
      for (std::size_t i = 0; i <= degree; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double u = static_cast<double>(i) / static_cast<double>(degree);
          const double v = static_cast<double>(k) / static_cast<double>(degree);
          const double place = (corners[p][0][axis] * (1 - u) + corners[p][1][axis] * u) * (1 - v) +
                               (corners[p][2][axis] * (1 - u) + corners[p][3][axis] * u) * v;
          // Sixths of a hundredth, so that sides of neighbours have the same digits.
          text += std::to_string(std::round(place * 600) / 600) + " ";
        }
        text += "\n";
      }
    }
  }
  return text;
}

}  // namespace

TEST_CASE("BRep: every surface that JSON names bounds a valid solid") {
  const double cylinder = 2 * std::numbers::pi;
  const double cone = std::numbers::pi * 2 / 3 * (1 + 2 + 4);
  for (
      const auto& [side, radius, volume] :
      {std::tuple(R"({"type":"cylinder","radius":1})", "1", cylinder),
       std::tuple(
           R"({"type":"extrusion","curve":{"type":"circle","radius":1},"direction":[0,0,2]})", "1",
           cylinder),
       std::tuple(R"({"type":"cone","radius":1,"slope":0.5})", "2", cone),
       std::tuple(R"({"type":"revolution","curve":{"type":"polyline","points":[[1,0,0],[2,0,2]]}})",
                  "2", cone),
       std::tuple(
           R"({"type":"revolution","curve":{"type":"bspline","points":[[1,0,0],[1.5,0,1],[2,0,2]]}})",
           "2", cone),
       std::tuple(R"({"type":"sphere","origin":[0,0,1],"radius":1.4142135623730951})", "1",
                  std::numbers::pi * (4 - 2.0 / 3))}) {
    CAPTURE(side);
    const double found = volume_of(read_as(Format::brep, between_circles(side, radius)));
    CHECK(std::abs(found - volume) < 0.001 * 40);  // chord times area
  }
}

TEST_CASE("BRep: B-splines with weights make a quarter of a disc, units and systems hold") {
  const std::string text = R"({"type":"BRep","unit":0.001,"srid":7415,"solids":[{"id":"quarter",
    "vertices":[[0,0,0],[1000,0,0],[0,1000,0],[0,0,500],[1000,0,500],[0,1000,500]],
    "edges":[{"vertices":[0,1]},
      {"vertices":[2,1],"reversed":true,"curve":{"type":"bspline","degree":2,"knots":[0,0,0,1,1,1],
        "points":[[1000,0,0],[1000,1000,0],[0,1000,0]],"weights":[1,0.7071067811865476,1]}},
      {"vertices":[2,0]},{"vertices":[3,4]},
      {"vertices":[4,5],"curve":{"type":"ellipse","origin":[0,0,500],"radii":[1000,1000]}},
      {"vertices":[5,3]},{"vertices":[0,3]},{"vertices":[1,4]},{"vertices":[2,5]}],
    "faces":[{"loops":[[-3,1,-1]]},{"loops":[[3,4,5]]},{"loops":[[0,7,-4,-7]]},
      {"loops":[[2,6,-6,-9]]},
      {"loops":[[-2,8,-5,-8]],"surface":{"type":"bspline",
        "points":[[[1000,0,0],[1000,1000,0],[0,1000,0]],[[1000,0,500],[1000,1000,500],[0,1000,500]]],
        "weights":[[1,0.7071067811865476,1],[1,0.7071067811865476,1]]}}],
    "shells":[[0,1,2,3,4]]}]})";
  const auto document = read_as(Format::brep, text);
  CHECK(std::abs(volume_of(document) - std::numbers::pi / 8) < 0.003);
  CHECK(document->features[0].id == "quarter");
  CHECK(document->features[0].srid == 7415);
  CHECK(document->features[0].solids[0].solid.srid() == 7415);
  CHECK(document->features[0].solids[0].source.pointer == "/solids/0");
  const auto& strips = document->features[0].solids[0].tessellation->face_strips;
  REQUIRE(strips.size() == 1);
  CHECK(strips[0].face == "face 4");
}

TEST_CASE("BRep: wrong values are errors with their JSON Pointer") {
  const std::string whole = between_circles(R"({"type":"cylinder","radius":1})");
  for (const auto& [part, by, pointer] :
       {std::tuple("\"vertices\":[0,0]", "\"vertices\":[0,2]", "/solids/0/edges/0/vertices/1"),
        std::tuple("\"vertices\":[0,0]", "\"vertices\":[0]", "/solids/0/edges/0/vertices"),
        std::tuple("[[1,0,0]", "[[1,0]", "/solids/0/vertices/0"),
        std::tuple("[[1,0,0]", "[[1,0,\"a\"]", "/solids/0/vertices/0/2"),
        std::tuple("\"radius\":1}},", "\"radius\":0}},", "/solids/0/edges/0/curve/radius"),
        std::tuple("\"type\":\"circle\",\"radius\"", "\"type\":\"spiral\",\"radius\"",
                   "/solids/0/edges/0/curve"),
        std::tuple("[[0],[-2]]", "[[0],[-3]]", "/solids/0/faces/2/loops/1/0"),
        std::tuple("[[0],[-2]]", "[[0,1],[-2]]", "/solids/0/faces/2/loops/0/0"),
        std::tuple("[[0],[-2]]", "[[]]", "/solids/0/faces/2/loops/0"),
        std::tuple("[[0],[-2]]}]", "[[0],[-2]]}],\"shells\":[[0,1],[1]]", "/solids/0/shells/1/0"),
        std::tuple("[[0],[-2]]}]", "[[0],[-2]]}],\"tolerance\":-1", "/solids/0/tolerance"),
        std::tuple("\"BRep\"", "\"Soup\"", ""),
        std::tuple("\"BRep\",", "\"BRep\",\"unit\":0,", "/unit"),
        std::tuple("\"solids\"", "\"solid\"", "")}) {
    CAPTURE(part, by);
    const Error error = brep_error(test::replaced(whole, part, by));
    CHECK(error.pointer == pointer);
    CHECK_FALSE(error.message.empty());
  }
  const std::string knots = R"({"type":"bspline","degree":2,"knots":[0,0,0,2,1,1,1],
    "points":[[1,0,0],[2,0,1],[1,0,1.5],[1,0,2]]})";
  CHECK(brep_error(between_circles(R"({"type":"revolution","curve":)" + knots + "}")).pointer ==
        "/solids/0/faces/2/surface/curve");
}

TEST_CASE("BRep: a surface of an unknown kind leaves its face out, by name") {
  const auto document = read_as(Format::brep, between_circles(R"({"type":"helicoid"})"));
  REQUIRE(document);
  const auto& left_out = document->features[0].solids[0].tessellation->left_out;
  REQUIRE(left_out.size() == 1);
  CHECK(left_out[0].face == "face 2");
  CHECK(left_out[0].reason.find("helicoid") != std::string::npos);
}

TEST_CASE("BPT: patches meet in equal sides, of any degree") {
  for (const bool is_cubic : {false, true}) {
    const auto document = read_as(Format::bpt, cube_patches(is_cubic));
    CHECK(std::abs(volume_of(document) - 1) < 1e-9);
    CHECK(document->features[0].solids[0].tessellation->edges == 12);
    CHECK(document->features[0].solids[0].tessellation->chord_error < 1e-9);
  }
}

TEST_CASE("BPT: open sides are borders, and nothing cracks between the others") {
  const auto document = read_as(Format::bpt, cube_patches(true, 5));
  REQUIRE(document);
  const Report report = report_of(document->features[0].solids[0]);
  CHECK(report.verdict == Verdict::invalid);
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].code == 302);
  CHECK(report.findings[0].measured == 4);
}

TEST_CASE("BPT: a side that is one point is a pole, a patch of no size is left out") {
  // An octant of nothing in particular: the upper side is one point.
  const std::string text =
      "2\n2 2\n1 0 0\n1 1 0\n0 1 0\n1 0 1\n1 1 1\n0 1 1\n0 0 1\n0 0 1\n0 0 1\n1 1\n"
      "5 5 5\n5 5 5\n5 5 5\n5 5 5\n";
  const auto document = read_as(Format::bpt, text, 0.01);
  REQUIRE(document);
  const auto& made = *document->features[0].solids[0].tessellation;
  CHECK(made.edges == 3);
  CHECK(made.triangles > 8);
  REQUIRE(made.left_out.size() == 1);
  CHECK(made.left_out[0].face == "patch 1");
  const auto report = report_of(document->features[0].solids[0]);
  for (const auto& finding : report.findings) CHECK(finding.code != 203);
}

TEST_CASE("BPT: wrong texts are errors with their byte") {
  const std::string whole = cube_patches(false, 1);
  for (const auto& [part, by] :
       {std::pair("1\n1 1\n", "1\n1\n"), std::pair("1\n1 1\n", "1\n0 1\n"),
        std::pair("1\n1 1\n", "1\n1 31\n"), std::pair("1\n1 1\n", "x\n1 1\n"),
        std::pair("1\n1 1\n", "7\n1 1\n"), std::pair("1.000000 1.000000 0.000000", "1 1"),
        std::pair("1.000000 1.000000 0.000000", "1 1 nan")}) {
    CAPTURE(part, by);
    const auto document = read_as(Format::bpt, test::replaced(whole, part, by));
    REQUIRE_FALSE(document);
    CHECK(document.error().code == ErrorCode::malformed);
    CHECK(document.error().byte_offset);
  }
}

TEST_CASE("formats of curved solids are known by name and content") {
  CHECK(*formats::detect_format("a.brep.json", {}) == Format::brep);
  CHECK(*formats::detect_format("a.bpt", {}) == Format::bpt);
  const std::string text = between_circles(R"({"type":"cylinder","radius":1})");
  CHECK(*formats::detect_format("a.json", as_bytes(text)) == Format::brep);
  CHECK(*formats::detect_format("", as_bytes(text)) == Format::brep);
}

TEST_CASE("a solid whose facets cross is tessellated at a smaller chord") {
  formats::ReadOptions options;
  options.curved.chord = 0.2;
  int asked = 0;
  static int* counter = nullptr;
  counter = &asked;
  options.curved.has_crossing = [](const Solid&) { return ++*counter < 3; };
  const std::string text = between_circles(R"({"type":"cylinder","radius":1})");
  const auto document = formats::read_document(as_bytes(text), Format::brep, options);
  REQUIRE(document);
  CHECK(asked == 3);
  CHECK(document->features[0].solids[0].tessellation->halvings == 2);
  CHECK(document->features[0].solids[0].tessellation->chord == 0.05);
  options.curved.has_crossing = [](const Solid&) { return ++*counter > 0; };
  const auto hopeless = formats::read_document(as_bytes(text), Format::brep, options);
  REQUIRE(hopeless);
  CHECK(asked == 8);
  CHECK(hopeless->features[0].solids[0].tessellation->halvings == 0);
  CHECK(hopeless->features[0].solids[0].tessellation->chord == 0.2);
}

}  // namespace watertight
