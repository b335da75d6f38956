// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests instances of geometry templates through validation, encoding and storing.
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "pipeline/container.h"
#include "pipeline/instances.h"
#include "pipeline/validate_stream.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_instances {
namespace {

const std::string kCube =
    R"({"type":"Solid","lod":"2","boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],)"
    R"([[2,3,7,6]],[[3,0,4,7]]]]})";
/// A box with one corner raised by a tenth of its size, which is 25 mm off the plane of the top.
const std::string kBent =
    R"({"type":"Solid","lod":"2","boundaries":[[[[0,3,2,1]],[[4,5,8,7]],[[0,1,5,4]],[[1,2,8,5]],)"
    R"([[2,3,7,8]],[[3,0,4,7]]]]})";
const std::string kVertices =
    "[[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1],[1,1,1.1]]";
const std::string kSame = "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1";
const std::string kTurned = "0.6,-0.8,0,7,0.8,0.6,0,8,0,0,1,9,0,0,0,1";
const std::string kTenfold = "10,0,0,0,0,10,0,0,0,0,10,0,0,0,0,1";
const std::string kTenth = "0.1,0,0,0,0,0.1,0,0,0,0,0.1,0,0,0,0,1";
const std::string kMirror = "-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1";
const std::string kFlat = "1,0,0,0,0,1,0,0,0,0,0,0,0,0,0,1";

struct Use {
  int number;
  std::string matrix;
};

/// A document with the two templates; each of the objects o0, o1, ... has one instance.
std::string city(const std::vector<Use>& uses) {
  std::string objects;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (i > 0) objects += ',';
    objects += "\"o" + std::to_string(i) +
               R"(":{"type":"CityFurniture","geometry":[{"type":"GeometryInstance","template":)" +
               std::to_string(uses[i].number) + R"(,"boundaries":[0],"transformationMatrix":[)" +
               uses[i].matrix + "]}]}";
  }
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],)"
         R"("translate":[100,200,0]},"CityObjects":{)" +
         objects + R"(},"vertices":[[1000,0,0]],"geometry-templates":{"templates":[)" + kCube +
         ',' + kBent + R"(],"vertices-templates":)" + kVertices + "}}";
}

Document read(const std::string& text, bool is_split) {
  formats::ReadOptions options;
  options.split_features = is_split;
  options.keep_text = !is_split;
  auto document = formats::read_document(as_bytes(text), Format::city_json, options);
  REQUIRE(document);
  return *std::move(document);
}

struct Seen {
  std::string id;
  std::vector<std::string> solids;  // for each solid, its type, verdict and codes of errors
};

std::string line_of(const pipeline::InspectedSolid& solid) {
  std::string line = solid.source.geometry_type + ' ';
  line += validate::to_string(solid.inspection.report.verdict);
  for (const Finding& finding : solid.inspection.report.findings) {
    if (finding.severity == Severity::error) line += ' ' + std::to_string(finding.code);
  }
  return line;
}

std::vector<Seen> stream(const std::string& text, std::size_t threads = 1) {
  formats::FeatureReader reader = formats::FeatureReader::of(read(text, true));
  pipeline::StreamOptions options;
  options.threads = threads;
  std::vector<Seen> all;
  const auto outcome = pipeline::validate_stream(
      reader, nullptr, options,
      [&](pipeline::ValidatedFeature&& feature) -> Status {
        CHECK(feature.number == all.size());
        Seen seen{feature.inspected.feature.id, {}};
        CHECK(feature.inspected.solids.size() == feature.inspected.feature.solids.size());
        for (const auto& solid : feature.inspected.solids) seen.solids.push_back(line_of(solid));
        all.push_back(std::move(seen));
        return Done{};
      },
      [](const Error&) -> Status { return Done{}; });
  REQUIRE(outcome);
  return all;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("valid instances share their template's solid, which comes last in the document") {
  const auto seen = stream(city({{0, kSame}, {0, kTurned}, {0, kTenfold}}));
  REQUIRE(seen.size() == 4);
  for (std::size_t i = 0; i < 3; ++i) CHECK(seen[i].solids.empty());
  CHECK(seen[3].id == "geometry-templates");
  // No instance uses the second template: it is judged on its own lattice.
  CHECK(seen[3].solids == Lines{"Solid valid", "Solid invalid 203"});
}

TEST_CASE("instances that are not valid are solids of their features") {
  const auto seen = stream(city({{0, kMirror}, {0, kFlat}, {1, kTurned}, {1, kTenth}}));
  REQUIRE(seen.size() == 5);
  CHECK(seen[0].solids == Lines{"GeometryInstance invalid 405"});
  CHECK(seen[1].solids == Lines{"GeometryInstance invalid 306"});
  CHECK(seen[2].solids == Lines{"GeometryInstance invalid 203"});
  CHECK(seen[3].solids.empty());
  // No valid instance uses the first template; the second one is valid where the last instance puts
  // it.
  CHECK(seen[4].solids == Lines{"Solid valid"});
  for (const std::size_t threads : {std::size_t{2}, std::size_t{4}}) {
    const auto again = stream(city({{0, kMirror}, {0, kFlat}, {1, kTurned}, {1, kTenth}}), threads);
    REQUIRE(again.size() == 5);
    for (std::size_t i = 0; i < 5; ++i) CHECK(again[i].solids == seen[i].solids);
  }
}

TEST_CASE("templates that place too many solids in a feature are one finding") {
  std::string text = city({{0, kSame}, {0, kSame}});
  CertifyOptions options;
  options.limits.placed_solids = 0;  // and four for each instance
  const auto judge = [&](const std::string& document) {
    Document found = read(document, true);
    pipeline::TemplateInspector templates(found.templates, nullptr, options, {});
    return pipeline::inspect(found.features[0], nullptr, options, {}, &templates);
  };
  CHECK(judge(text).verdict() == Verdict::valid);
  const std::size_t begin = kCube.find("[[[[");
  const std::string solid = kCube.substr(begin, kCube.size() - 1 - begin);
  std::string five = R"({"type":"MultiSolid","lod":"2","boundaries":[)" + solid;
  for (int i = 1; i < 5; ++i) five += ',' + solid;
  text.replace(text.find(kCube), kCube.size(), five + "]}");
  const pipeline::InspectedFeature refused = judge(text);
  REQUIRE(refused.solids.size() == 1);
  const Report& report = refused.solids[0].inspection.report;
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].code == 901);
  CHECK(report.findings[0].detail.find("place 5 solids") != std::string::npos);
}

TEST_CASE("a template whose instances are all invalid does not count") {
  const auto seen = stream(city({{0, kFlat}, {1, kTenfold}}));
  REQUIRE(seen.size() == 2);
  CHECK(seen[1].solids == Lines{"GeometryInstance invalid 203"});
}

TEST_CASE("findings of an instance name it and its template, and lie in the world") {
  formats::FeatureReader reader = formats::FeatureReader::of(read(city({{1, kTurned}}), true));
  std::vector<pipeline::InspectedFeature> features;
  const auto outcome = pipeline::validate_stream(
      reader, nullptr, {},
      [&](pipeline::ValidatedFeature&& feature) -> Status {
        features.push_back(std::move(feature.inspected));
        return Done{};
      },
      [](const Error&) -> Status { return Done{}; });
  REQUIRE(outcome);
  CHECK(outcome->verdict == Verdict::invalid);
  REQUIRE_FALSE(features.empty());
  REQUIRE(features[0].solids.size() == 1);
  const pipeline::InspectedSolid& solid = features[0].solids[0];
  CHECK(solid.source.object_id == "o0");
  CHECK(solid.source.lod == "2");
  CHECK(solid.source.pointer == "/geometry-templates/templates/1/boundaries");
  const Finding& finding = solid.inspection.report.findings.at(0);
  CHECK(finding.detail.find("template 1 as placed by /CityObjects/o0/geometry/0") !=
        std::string::npos);
  REQUIRE(finding.witness);
  const auto& witness = *finding.witness;
  CHECK((witness[0] > 107 && witness[0] < 109.5));
  CHECK((witness[1] > 207 && witness[1] < 210));
  CHECK((witness[2] >= 9 && witness[2] < 10.2));
  CHECK(features[0].feature.solids[0].solid.world(0) == std::array<double, 3>{108, 208, 9});
}

TEST_CASE("instances that belong to no feature are judged with the templates") {
  Document document = read(city({{0, kSame}}), true);
  formats::TemplateInstance mirrored = document.features.at(0).instances.at(0);
  mirrored.placement.linear[0][0] = GridNumber{-1, 0};
  mirrored.source = {"tree", "ImplicitGeometry", {}, 0, 0, {}};
  document.instances.push_back(mirrored);
  document.features.clear();
  formats::FeatureReader reader = formats::FeatureReader::of(std::move(document));
  std::vector<std::string> solids;
  std::string detail;
  const auto outcome = pipeline::validate_stream(
      reader, nullptr, {},
      [&](pipeline::ValidatedFeature&& feature) -> Status {
        for (const auto& solid : feature.inspected.solids) solids.push_back(line_of(solid));
        detail = feature.inspected.solids.at(0).inspection.report.findings.at(0).detail;
        return Done{};
      },
      [](const Error&) -> Status { return Done{}; });
  REQUIRE(outcome);
  CHECK(solids == Lines{"ImplicitGeometry invalid 405", "Solid invalid 203"});
  CHECK(detail.find("(template 0, mirrored and placed by 'tree')") != std::string::npos);
}

TEST_CASE(
    "a document with an invalid instance is not encoded, other documents come back byte for byte") {
  const std::string good = city({{0, kSame}, {0, kTenfold}, {1, kTenth}});
  const auto encoded = pipeline::encode_document(read(good, false), nullptr, {});
  REQUIRE(encoded);
  CHECK(encoded->outcome.verdict == Verdict::valid);
  const auto container = pipeline::write_container(encoded->document);
  REQUIRE(container);
  const auto documents = pipeline::decode_container(*container);
  REQUIRE(documents);
  const auto written = formats::write_document(documents->at(0), Format::city_json);
  REQUIRE(written);
  CHECK(std::string(as_text(*written)) == good);

  for (const std::string& matrix : {kMirror, kFlat}) {
    const auto refused =
        pipeline::encode_document(read(city({{0, kSame}, {0, matrix}}), false), nullptr, {});
    REQUIRE(refused);
    CHECK(refused->outcome.verdict == Verdict::invalid);
    CHECK(refused->document.features.empty());
    REQUIRE(refused->outcome.features.at(0).solids.size() == 1);
    CHECK(refused->outcome.features[0].solids[0].source.object_id == "o1");
  }
}

TEST_CASE("ingest skips the features whose instances are not valid") {
  samples::MemoryStore store;
  pipeline::IngestOptions options;
  options.collection = "c";
  options.policy = store::Policy::skip;
  const auto outcome = pipeline::ingest(read(city({{0, kSame}, {0, kMirror}, {1, kTenth}}), true),
                                        store, nullptr, options);
  REQUIRE(outcome);
  CHECK(outcome->verdict == Verdict::invalid);
  CHECK(outcome->stored == 2);
  CHECK_FALSE(outcome->features.at(1).is_stored);
}

}  // namespace watertight::test_instances
