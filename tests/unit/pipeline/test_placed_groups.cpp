// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests instances of geometry templates in groups: members of composite templates, and instances in
// a building with its parts.
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "pipeline/validate_stream.h"

namespace watertight::test_placed_groups {
namespace {

const std::string kPlacedSame = "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1";
const std::string kPlacedMirror = "-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1";
const std::string kDouble = "2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1";
const std::string kHalfTurn = "-1,0,0,2,0,-1,0,1,0,0,1,0,0,0,0,1";

/// The least x of each cube of 1 m; cube k has vertices 8 k to 8 k + 7.
constexpr double kStarts[] = {0, 0.5, 1, 3};

std::string listed(const std::vector<std::string>& parts) {
  std::string text("[");
  for (const std::string& part : parts) {
    if (text.size() > 1) text.push_back(',');
    text.append(part);
  }
  text.push_back(']');
  return text;
}

std::string cube_vertices() {
  std::vector<std::string> vertices;
  for (const double start : kStarts) {
    for (const auto& [x, y, z] : {std::array{0, 0, 0},
                                  {1, 0, 0},
                                  {1, 1, 0},
                                  {0, 1, 0},
                                  {0, 0, 1},
                                  {1, 0, 1},
                                  {1, 1, 1},
                                  {0, 1, 1}}) {
      vertices.push_back(listed({std::to_string(start + x), std::to_string(y), std::to_string(z)}));
    }
  }
  return listed(vertices);
}

/// The boundaries of cube k, turned inside out for an instance that mirrors it.
std::string cube(int k, bool is_inside_out = false) {
  std::vector<std::string> facets;
  for (const auto& ring : {std::array{0, 3, 2, 1},
                           {4, 5, 6, 7},
                           {0, 1, 5, 4},
                           {1, 2, 6, 5},
                           {2, 3, 7, 6},
                           {3, 0, 4, 7}}) {
    std::vector<std::string> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      corners.push_back(std::to_string(8 * k + ring[is_inside_out ? 3 - i : i]));
    }
    facets.push_back(listed({listed(corners)}));
  }
  return listed({listed(facets)});
}

std::string composite(const std::vector<std::string>& members) {
  return R"({"type":"CompositeSolid","lod":"2","boundaries":)" + listed(members) + "}";
}

std::string instance(const std::string& matrix, int vertex = 0) {
  return R"({"type":"GeometryInstance","template":0,"boundaries":[)" + std::to_string(vertex) +
         R"(],"transformationMatrix":[)" + matrix + "]}";
}

std::string placed_object(const std::string& id, const std::string& type,
                          const std::string& geometry, const std::string& family = "") {
  return '"' + id + R"(":{"type":")" + type + R"(",)" + family + R"("geometry":[)" + geometry +
         "]}";
}

/// A city model in which the document and the templates have the vertices of the cubes.
std::string city(const std::string& form, const std::string& objects) {
  return R"({"type":"CityJSON","version":"2.0","CityObjects":{)" + objects + R"(},"vertices":)" +
         cube_vertices() + R"(,"geometry-templates":{"templates":[)" + form +
         R"(],"vertices-templates":)" + cube_vertices() + "}}";
}

Document read(const std::string& text) {
  auto document = formats::read_document(as_bytes(text), Format::city_json, {});
  REQUIRE(document);
  return *std::move(document);
}

std::vector<pipeline::InspectedFeature> stream_placed(const std::string& text,
                                                      const validate::GroupOptions& groups = {}) {
  formats::FeatureReader reader = formats::FeatureReader::of(read(text));
  pipeline::StreamOptions options;
  options.groups = groups;
  std::vector<pipeline::InspectedFeature> features;
  const auto outcome = pipeline::validate_stream(
      reader, nullptr, options,
      [&](pipeline::ValidatedFeature&& feature) -> Status {
        features.push_back(std::move(feature.inspected));
        return Done{};
      },
      [](const Error&) -> Status { return Done{}; });
  REQUIRE(outcome);
  return features;
}

std::vector<int> codes(const pipeline::InspectedFeature& feature) {
  std::vector<int> all;
  for (const pipeline::InspectedGroup& group : feature.groups) {
    for (const Finding& finding : group.report.findings) all.push_back(finding.code);
  }
  return all;
}

using Codes = std::vector<int>;

Codes composite_codes(const std::string& form, const std::string& matrix) {
  return codes(
      stream_placed(city(form, placed_object("o", "CityFurniture", instance(matrix)))).at(0));
}

}  // namespace

TEST_CASE("members of a composite template are compared where an instance has them") {
  for (const std::string& matrix : {kPlacedSame, kDouble, kHalfTurn}) {
    CHECK(composite_codes(composite({cube(0), cube(2)}), matrix).empty());
    CHECK(composite_codes(composite({cube(0), cube(1)}), matrix) == Codes{501});
    CHECK(composite_codes(composite({cube(0), cube(0)}), matrix) == Codes{502});
    CHECK(composite_codes(composite({cube(0), cube(3)}), matrix) == Codes{503});
  }
  CHECK(composite_codes(composite({cube(0, true), cube(1, true)}), kPlacedMirror) == Codes{501});
  CHECK(composite_codes(composite({cube(0, true), cube(2, true)}), kPlacedMirror).empty());
}

TEST_CASE("a group of an instance states its instance, and the depth of the overlap in place") {
  const auto features = stream_placed(city(
      composite({cube(0), cube(1)}), placed_object("o", "CityFurniture", instance(kDouble, 24))));
  REQUIRE(features.size() == 2);
  const pipeline::InspectedFeature& feature = features[0];
  CHECK(feature.verdict() == Verdict::invalid);
  REQUIRE(feature.groups.size() == 1);
  CHECK(feature.groups[0].members == std::vector<std::size_t>{0, 1});
  REQUIRE(feature.solids.size() == 2);
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    CHECK(solid.inspection.report.verdict == Verdict::valid);
    CHECK(solid.source.object_id == "o");
    CHECK(solid.source.geometry_type == "GeometryInstance");
  }
  const Finding& finding = feature.groups[0].report.findings.at(0);
  CHECK(finding.measured == 1.0);
  REQUIRE(finding.witness);
  CHECK(((*finding.witness)[0] > 4 && (*finding.witness)[0] < 5));
  // The template counts as a template that valid instances share; its overlap is not reported
  // again.
  CHECK(features[1].solids.size() == 2);
  CHECK(features[1].groups.empty());
}

TEST_CASE("a tolerance of overlaps holds for instances in metres") {
  validate::GroupOptions options;
  options.overlap_metres = 0.75;
  const std::string form = composite({cube(0), cube(1)});
  const auto said = [&](const std::string& matrix) {
    return codes(
        stream_placed(city(form, placed_object("o", "Bench", instance(matrix))), options).at(0));
  };
  CHECK(said(kPlacedSame).empty());
  CHECK(said(kDouble) == Codes{501});
}

TEST_CASE("a composite template without instances is judged as it is") {
  const auto features = stream_placed(city(composite({cube(0), cube(1)}), ""));
  REQUIRE(features.size() == 1);
  CHECK(features[0].feature.id == "geometry-templates");
  CHECK(codes(features[0]) == Codes{501});
}

TEST_CASE("instances are compared with the solids of their building") {
  const std::string parts = R"("children":["p"],)";
  const std::string part_of = R"("parents":["b"],)";
  const auto said = [&](const std::string& own, const std::string& part) {
    return codes(stream_placed(city(R"({"type":"Solid","lod":"2","boundaries":)" + cube(0) + "}",
                                    placed_object("b", "Building", own, parts) + "," +
                                        placed_object("p", "BuildingPart", part, part_of)))
                     .at(0));
  };
  const auto solid = [](int k) {
    return R"({"type":"Solid","lod":"2","boundaries":)" + cube(k) + "}";
  };
  CHECK(said(solid(0), instance(kPlacedSame)) == Codes{601});
  CHECK(said(solid(0), instance(kPlacedSame, 8)) == Codes{601});  // the instance begins at x = 0.5
  CHECK(said(solid(0), instance(kPlacedSame, 16))
            .empty());  // the instance begins at x = 1: a party wall
  CHECK(said(instance(kPlacedSame), instance(kPlacedSame)) == Codes{601});
  CHECK(said(instance(kPlacedSame), instance(kHalfTurn))
            .empty());  // the instance goes from x = 2 to 1
  CHECK(said(instance(kPlacedSame), instance(kDouble, 8)) == Codes{601});
  // Solids of different levels of detail are not compared.
  CHECK(said(R"({"type":"Solid","lod":"1","boundaries":)" + cube(0) + "}", instance(kPlacedSame))
            .empty());
}

TEST_CASE("a building's instances are its solids where they overlap, and only there") {
  const std::string form = R"({"type":"Solid","lod":"2","boundaries":)" + cube(0) + "}";
  const auto building = [&](int vertex) {
    return stream_placed(
               city(form, placed_object("b", "Building", form, R"("children":["p"],)") + "," +
                              placed_object("p", "BuildingPart", instance(kPlacedSame, vertex),
                                            R"("parents":["b"],)")))
        .at(0);
  };
  const pipeline::InspectedFeature apart = building(16);
  CHECK(apart.verdict() == Verdict::valid);
  CHECK(apart.solids.size() == 1);
  const pipeline::InspectedFeature overlapping = building(8);
  CHECK(overlapping.verdict() == Verdict::invalid);
  REQUIRE(overlapping.solids.size() == 2);
  CHECK(overlapping.solids[1].source.object_id == "p");
  REQUIRE(overlapping.groups.size() == 1);
  CHECK(overlapping.groups[0].members == std::vector<std::size_t>{0, 1});
  CHECK(overlapping.groups[0].report.findings.at(0).measured == 0.5);
}

TEST_CASE("walls that differ from a contact only by the digits of a rotation do not overlap") {
  // The instances are turned by 45 degrees, in 18 digits: their vertices are rounded to a common
  // grid.
  const std::string sine = "0.707106781186547524";
  const std::string turn =
      sine + ",-" + sine + ",0,0," + sine + "," + sine + ",0,0,0,0,1,0,0,0,0,1";
  const auto shifted = [&](const std::string& x, const std::string& y) {
    return sine + ",-" + sine + ",0," + x + "," + sine + "," + sine + ",0," + y +
           ",0,0,1,0,0,0,0,1";
  };
  const std::string form = R"({"type":"Solid","lod":"2","boundaries":)" + cube(0) + "}";
  const auto said = [&](const std::string& matrix) {
    return codes(
        stream_placed(
            city(form,
                 placed_object("b", "Building", instance(turn), R"("children":["p"],)") + "," +
                     placed_object("p", "BuildingPart", instance(matrix), R"("parents":["b"],)")))
            .at(0));
  };
  CHECK(said(shifted(sine, sine)).empty());
  CHECK(said(shifted("0.7071067811865475", "0.7071067811865475")).empty());  // too near by 5e-17 m
  CHECK(said(shifted("0.7071067", "0.7071067")) == Codes{601});  // too near by 0.1 micrometres
}

TEST_CASE("the depth of an overlap is that in place, whichever instance comes first") {
  // Under a turn about a diagonal the overlap of two cubes is longer along the axes of the world.
  const std::string tilt = "0.6,-0.8,0,0,0.8,0.6,0,0,0,0,1,0,0,0,0,1";
  const std::string form = composite({cube(0), cube(1)});
  validate::GroupOptions options;
  options.overlap_metres = 0.5;
  const auto said = [&](const std::vector<std::string>& matrices) {
    std::string objects;
    for (std::size_t i = 0; i < matrices.size(); ++i) {
      if (i > 0) objects += ",";
      objects += placed_object(std::to_string(i), "Bench", instance(matrices[i]));
    }
    std::vector<Codes> all;
    for (const pipeline::InspectedFeature& feature : stream_placed(city(form, objects), options)) {
      all.push_back(codes(feature));
    }
    return all;
  };
  CHECK(said({kPlacedSame, kDouble}) == std::vector<Codes>{{}, {501}, {}});
  CHECK(said({kDouble, kPlacedSame}) == std::vector<Codes>{{501}, {}, {}});
  CHECK(said({kPlacedSame, tilt}).at(1) == said({tilt, kPlacedSame}).at(0));
}

TEST_CASE("features with instances that do not fit are refused") {
  const auto refused = pipeline::encode_document(
      read(city(composite({cube(0), cube(1)}),
                placed_object("o", "CityFurniture", instance(kPlacedSame)))),
      nullptr, {});
  REQUIRE(refused);
  CHECK(refused->outcome.verdict == Verdict::invalid);
  CHECK(refused->document.features.empty());
  const auto accepted = pipeline::encode_document(
      read(city(composite({cube(0), cube(2)}),
                placed_object("o", "CityFurniture", instance(kPlacedSame)))),
      nullptr, {});
  REQUIRE(accepted);
  CHECK(accepted->outcome.verdict == Verdict::valid);
  CHECK(accepted->document.features.size() == 1);
}

}  // namespace watertight::test_placed_groups
