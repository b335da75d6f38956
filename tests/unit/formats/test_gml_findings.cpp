// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the defects of the OGC's quality experiment (QIE), written as GML of our own: the solids
// that the reader gives must have the code of each defect. The gml:id of a building is "b-CODE",
// "b-CODE-remark" or "b-valid-remark"; the code is that of the first level.
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <utility>
#include <vector>

#include "gml_samples.h"
#include "pipeline/groups.h"
#include "pipeline/pipeline.h"
#include "samples.h"
#include "validate/certify.h"
#include "validate/report_json.h"

namespace watertight::test_gml_findings {
namespace {

std::vector<int> expected_codes(const std::string& id) {
  const std::string code = id.substr(2, id.find('-', 2) - 2);
  if (code == "valid") return {};
  return {std::stoi(code)};
}

TEST_CASE("GML: every defect of the quality experiment is found under its code") {
  const auto document = test::read(test::file_text("gml/defects.gml"), Format::gml);
  REQUIRE(document);
  CHECK(document->features.size() == 27);
  for (const Feature& feature : document->features) {
    CAPTURE(feature.id);
    REQUIRE(feature.solids.size() == 1);
    const SubmittedSolid& submitted = feature.solids[0];
    CertifyOptions options;
    options.proof = Proof::boundary;
    options.unclosed_rings = submitted.unclosed_rings;
    const Report report = certify(submitted.solid, nullptr, options).report;
    const std::vector<int> expected = expected_codes(feature.id);
    CHECK(report.first_level == expected);
    CHECK(report.verdict == (expected.empty() ? Verdict::valid : Verdict::invalid));
  }
}

/// The facets of the box from (x, y, 0) to (x + 2, y + 3, 4), outward in right-handed axes.
std::string box(int x, int y, bool is_latitude_first) {
  std::string members;
  for (const std::string facet : {"0462", "1375", "0154", "2673", "0231", "4576"}) {
    std::string positions;
    for (const char digit : facet + facet[0]) {
      const int corner = digit - '0';
      std::string first = std::to_string(x + (corner & 1) * 2);
      std::string second = std::to_string(y + (corner >> 1 & 1) * 3);
      if (is_latitude_first) std::swap(first, second);
      positions.append(first).append(" ").append(second).append(" ");
      positions.append(std::to_string((corner >> 2) * 4)).append(" ");
    }
    members += test::member(test::polygon(positions));
  }
  return test::solid_of(members);
}

TEST_CASE("GML: outward facets are outward whatever the order of axes that the srsName means") {
  const auto first_level = [](const std::string& system, bool is_latitude_first) {
    const Document document = test::gml_of(
        test::model("<g:boundedBy><g:Envelope srsName=\"" + system + "\"/></g:boundedBy>" +
                    test::building(box(4, 50, is_latitude_first))));
    CertifyOptions options;
    options.proof = Proof::boundary;
    return certify(document.features.at(0).solids.at(0).solid, nullptr, options).report.first_level;
  };
  CHECK(first_level("urn:ogc:def:crs:EPSG::4979", true).empty());
  CHECK(first_level("urn:ogc:def:crs:EPSG::4979", false) == std::vector<int>{405});
  CHECK(first_level("EPSG:4979", false).empty());
}

TEST_CASE("GML: overlapping parts of a building are finding 601") {
  const auto part = [](int x) {
    return "<part><BuildingPart><lod1Solid>" + box(x, 0, false) +
           "</lod1Solid></BuildingPart></part>";
  };
  const auto codes = [&](int second) {
    Document document = test::gml_of(
        test::model("<m><Building g:id=\"b\">" + part(0) + part(second) + "</Building></m>"));
    CertifyOptions options;
    options.proof = Proof::boundary;
    const pipeline::InspectedFeature feature =
        pipeline::inspect(std::move(document.features.at(0)), nullptr, options);
    std::vector<int> all;
    for (const pipeline::InspectedGroup& group : feature.groups) {
      for (const Finding& finding : group.report.findings) all.push_back(finding.code);
    }
    return all;
  };
  CHECK(codes(1) == std::vector<int>{601});
  CHECK(codes(2).empty());
}

/// What is found in the first feature of a document.
pipeline::InspectedFeature inspected(const std::string& text) {
  Document document = test::gml_of(text);
  CertifyOptions options;
  options.proof = Proof::boundary;
  return pipeline::inspect(std::move(document.features.at(0)), nullptr, options);
}

TEST_CASE("GML: a finding names polygon, ring and line") {
  const std::string base =
      "\n<g:Polygon g:id=\"base\"><g:exterior>\n<g:LinearRing g:id=\"edge\">"
      "<g:posList>0 0 0 0 1 0 1 0 0</g:posList></g:LinearRing></g:exterior>"
      "</g:Polygon>";
  const auto feature =
      inspected(test::model(test::building(test::solid_of(test::member(base) + test::kSides))));
  const Report& report = feature.solids.at(0).inspection.report;
  REQUIRE(report.findings.size() == 1);
  const Finding& finding = report.findings[0];
  CHECK(finding.code == 103);
  CHECK(finding.source == validate::SourceElement{"base", "edge", 3});
  CHECK(validate::finding_text(finding).starts_with(
      "error 103 RING_NOT_CLOSED at shell 0 facet 0 ring 0 vertex 0 (polygon 'base', ring 'edge', "
      "line 3): "));
  const std::string json = validate::report_json(report, feature.feature.solids[0].solid);
  CHECK(json.find(R"("source":{"polygon":"base","ring":"edge","line":3})") != std::string::npos);
}

TEST_CASE("GML: a pair of facets names both, a finding about a shell the line of the solid") {
  std::string pair = test::member(test::kBase);
  pair.append("\n").append(test::member(test::kBase)).append(test::kSides);
  const auto twice = inspected(test::model(test::building(test::solid_of(pair))));
  bool has_pair = false;
  for (const Finding& finding : twice.solids.at(0).inspection.report.findings) {
    if (!finding.other) continue;
    has_pair = true;
    CHECK(finding.source.line == 1);
    CHECK(finding.other_source.line == 2);
  }
  CHECK(has_pair);
  std::string one = "\n\n";
  one += test::solid_of(test::member(test::kBase));
  const auto few = inspected(test::model(test::building(one)));
  const Report& report = few.solids.at(0).inspection.report;
  REQUIRE_FALSE(report.findings.empty());
  CHECK(report.findings[0].place.facet == kNone);
  CHECK(report.findings[0].source == validate::SourceElement{"", "", 3});
}

TEST_CASE("GML: a solid that cannot be read is 901 with its place, and is not valid") {
  const auto feature = inspected(test::model(test::building(
      test::solid_of(test::member(test::polygon("0 0 1 1", " g:id=\"p\"")) + test::kSides), "b")));
  CHECK(feature.verdict() == Verdict::invalid);
  const Report& report = feature.solids.at(0).inspection.report;
  CHECK(report.verdict == Verdict::invalid);
  CHECK(report.first_level == std::vector<int>{901});
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].code == 901);
  CHECK(report.findings[0].source.line == 1);
  CHECK(report.findings[0].detail.find("in Polygon 'p', of object 'b'") != std::string::npos);
}

}  // namespace
}  // namespace watertight::test_gml_findings
