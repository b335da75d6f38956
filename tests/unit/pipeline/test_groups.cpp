// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "pipeline/groups.h"
#include "pipeline/outcome_json.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_groups {
namespace {

/// The vertices of boxes from x to x + 1000; box i has vertices 8 i to 8 i + 7.
std::string vertices_of(const std::vector<int>& positions) {
  std::string text = "[";
  for (const int x : positions) {
    for (const auto& [dx, y, z] : std::vector<std::array<int, 3>>{{0, 0, 0},
                                                                  {1000, 0, 0},
                                                                  {1000, 1000, 0},
                                                                  {0, 1000, 0},
                                                                  {0, 0, 2500},
                                                                  {1000, 0, 2500},
                                                                  {1000, 1000, 2500},
                                                                  {0, 1000, 2500}}) {
      if (text.size() > 1) text += ',';
      text +=
          '[' + std::to_string(x + dx) + ',' + std::to_string(y) + ',' + std::to_string(z) + ']';
    }
  }
  return text + ']';
}

/// The shells of box i, over vertices 8 i to 8 i + 7.
std::string shells(int i, bool is_open = false) {
  std::string text = "[[";
  const auto facet = [&](int a, int b, int c, int d) {
    if (text.size() > 2) text += ',';
    text += "[[";
    for (const int corner : {a, b, c, d}) {
      if (text.back() != '[') text += ',';
      text += std::to_string(8 * i + corner);
    }
    text += "]]";
  };
  facet(0, 3, 2, 1);
  if (!is_open) facet(4, 5, 6, 7);
  facet(0, 1, 5, 4);
  facet(1, 2, 6, 5);
  facet(2, 3, 7, 6);
  facet(3, 0, 4, 7);
  return text + "]]";
}

/// The boundaries of two solids, each of them a box.
std::string both(int first, int second) {
  std::string text(1, '[');
  text += shells(first);
  text += ',';
  text += shells(second);
  text += ']';
  return text;
}

std::string geometry(const std::string& type, const std::string& lod,
                     const std::string& boundaries) {
  return R"({"type":")" + type + R"(","lod":")" + lod + R"(","boundaries":)" + boundaries + "}";
}

std::string object(const std::string& id, const std::string& type, const std::string& family,
                   const std::string& geometries) {
  std::string text(1, '"');
  return text + id + R"(":{"type":")" + type + '"' + family + R"(,"geometry":[)" + geometries +
         "]}";
}

pipeline::InspectedFeature inspected(const std::string& objects,
                                     const std::vector<int>& positions) {
  const std::string text = std::string(samples::kHeader) +
                           "\n{\"type\":\"CityJSONFeature\",\"id\":\"a\",\"CityObjects\":{" +
                           objects + "},\"vertices\":" + vertices_of(positions) + "}\n";
  auto document = formats::read_document(as_bytes(text), Format::city_json_seq);
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  return pipeline::inspect(std::move(document->features[0]), nullptr, {});
}

/// A building with one part for each geometry.
std::string building(const std::vector<std::string>& part_geometries, const std::string& own = "",
                     const std::string& part_type = "BuildingPart") {
  std::string children;
  std::string parts;
  for (std::size_t i = 0; i < part_geometries.size(); ++i) {
    std::string id(1, 'p');
    id += std::to_string(i);
    children += (i == 0 ? "\"" : ",\"") + id + '"';
    parts += ',' + object(id, part_type, R"(,"parents":["a"])", part_geometries[i]);
  }
  return object("a", "Building", R"(,"children":[)" + children + ']', own) + parts;
}

TEST_CASE("overlapping parts of a building make the feature invalid, its solids stay valid") {
  const pipeline::InspectedFeature feature = inspected(
      building({geometry("Solid", "2", shells(0)), geometry("Solid", "2", shells(1))}), {0, 900});
  REQUIRE(feature.groups.size() == 1);
  const pipeline::InspectedGroup& group = feature.groups[0];
  CHECK(group.kind == validate::GroupKind::building_parts);
  CHECK(group.object_id == "a");
  CHECK(group.lod == "2");
  CHECK(group.members == std::vector<std::size_t>{0, 1});
  REQUIRE(group.report.findings.size() == 1);
  CHECK(group.report.findings[0].code == 601);
  CHECK(feature.verdict() == Verdict::invalid);
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    CHECK(solid.inspection.report.verdict == Verdict::valid);
  }
}

TEST_CASE("parts that share a wall, or are of different levels of detail, do not overlap") {
  const std::string first = geometry("Solid", "2", shells(0));
  CHECK(inspected(building({first, geometry("Solid", "2", shells(1))}), {0, 1000}).verdict() ==
        Verdict::valid);
  const pipeline::InspectedFeature lods =
      inspected(building({first, geometry("Solid", "1", shells(1))}), {0, 900});
  CHECK(lods.groups.empty());
  CHECK(lods.verdict() == Verdict::valid);
}

TEST_CASE("the building's own solid counts as a part, an installation does not") {
  const std::string own = geometry("Solid", "2", shells(0));
  const std::string part = geometry("Solid", "2", shells(1));
  CHECK(inspected(building({part}, own), {0, 900}).verdict() == Verdict::invalid);
  CHECK(inspected(building({part}, own, "BuildingInstallation"), {0, 900}).groups.empty());
}

TEST_CASE("solids of one MultiSolid are not compared with each other") {
  const std::string members = both(0, 1);
  const std::string multi = geometry("MultiSolid", "2", members);
  CHECK(inspected(building({multi}), {0, 900}).groups.empty());
  // With another part the two solids are in one group, and only pairs with that part are compared.
  const pipeline::InspectedFeature feature =
      inspected(building({multi, geometry("Solid", "2", shells(2))}), {0, 900, 1800});
  REQUIRE(feature.groups.size() == 1);
  REQUIRE(feature.groups[0].report.findings.size() == 1);
  CHECK(feature.groups[0].report.findings[0].place.solid == 1);
  CHECK(feature.groups[0].report.findings[0].other->solid == 2);
}

TEST_CASE("members of a composite solid are compared once, whatever the object") {
  const std::string members = both(0, 1);
  const std::string composite = geometry("CompositeSolid", "2", members);
  for (const std::string type : {"Building", "GenericCityObject"}) {
    const pipeline::InspectedFeature overlap =
        inspected(object("a", type, "", composite), {0, 900});
    REQUIRE(overlap.groups.size() == 1);
    CHECK(overlap.groups[0].kind == validate::GroupKind::composite_solid);
    REQUIRE(overlap.groups[0].report.findings.size() == 1);
    CHECK(overlap.groups[0].report.findings[0].code == 501);
    CHECK(inspected(object("a", type, "", composite), {0, 1000}).verdict() == Verdict::valid);
    const pipeline::InspectedFeature apart = inspected(object("a", type, "", composite), {0, 1001});
    REQUIRE(apart.groups[0].report.findings.size() == 1);
    CHECK(apart.groups[0].report.findings[0].code == 503);
  }
}

TEST_CASE("two composite solids of one object are two groups") {
  const std::string first = geometry("CompositeSolid", "1", both(0, 1));
  const std::string second = geometry("CompositeSolid", "1", both(2, 3));
  const pipeline::InspectedFeature feature =
      inspected(object("a", "Building", "", first + "," + second), {0, 1000, 5000, 6000});
  std::size_t composites = 0;
  for (const pipeline::InspectedGroup& group : feature.groups) {
    composites += group.kind == validate::GroupKind::composite_solid ? 1 : 0;
  }
  CHECK(composites == 2);
  CHECK(feature.verdict() == Verdict::valid);
}

TEST_CASE("a part that is not valid is named and not compared") {
  const pipeline::InspectedFeature feature = inspected(
      building({geometry("Solid", "2", shells(0)), geometry("Solid", "2", shells(1, true))}),
      {0, 900});
  REQUIRE(feature.groups.size() == 1);
  CHECK(feature.groups[0].report.findings.empty());
  CHECK(feature.groups[0].report.not_run.size() == 1);
  CHECK(feature.verdict() == Verdict::invalid);
}

TEST_CASE("the outcome's JSON lists groups") {
  const std::string text =
      std::string(samples::kHeader) +
      "\n{\"type\":\"CityJSONFeature\",\"id\":\"a\",\"CityObjects\":{" +
      building({geometry("Solid", "2", shells(0)), geometry("Solid", "2", shells(1))}) +
      "},\"vertices\":" + vertices_of({0, 900}) + "}\n";
  auto document = formats::read_document(as_bytes(text), Format::city_json_seq);
  REQUIRE(document);
  const auto encoded = pipeline::encode_document(*std::move(document), nullptr, {});
  REQUIRE(encoded);
  CHECK(encoded->document.features.empty());
  CHECK(encoded->outcome.verdict == Verdict::invalid);
  const std::string json = pipeline::outcome_json(encoded->outcome);
  CHECK(json.find(R"("groups":[{"kind":"building_parts","object":"a","lod":"2","solids":[0,1])") !=
        std::string::npos);
  CHECK(json.find(R"("code":601,"name":"BUILDINGPARTS_OVERLAP")") != std::string::npos);
}

}  // namespace
}  // namespace watertight::test_groups
