// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surfaces in validation and coding: findings, facts, and closed surfaces as solids.
#include <catch2/catch_test_macros.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "pipeline/container.h"
#include "pipeline/validate_stream.h"
#include "tests/files.h"

namespace watertight::test_surfaces {
namespace {

using formats::Surfaces;
using pipeline::InspectedFeature;
using pipeline::InspectedSolid;

const std::string kFile = test::source_path("tests/data/cityjson/surfaces.city.json");

Document read(Surfaces surfaces, bool is_split = true) {
  formats::ReadOptions options;
  options.surfaces = surfaces;
  options.split_features = is_split;
  options.keep_text = !is_split;
  auto document = formats::read_document(test::read_bytes(kFile), Format::city_json, options);
  REQUIRE(document);
  return *std::move(document);
}

std::vector<InspectedFeature> inspect_all(Surfaces surfaces, Severity severity) {
  CertifyOptions options;
  options.severity_of_surfaces = severity;
  std::vector<InspectedFeature> features;
  for (Feature& feature : read(surfaces).features) {
    features.push_back(pipeline::inspect(std::move(feature), nullptr, options));
  }
  return features;
}

const InspectedFeature& named(const std::vector<InspectedFeature>& features,
                              const std::string& id) {
  for (const InspectedFeature& feature : features) {
    if (feature.feature.id == id) return feature;
  }
  FAIL("no feature " + id);
  return features.front();
}

std::string words_of(const InspectedSolid& solid) {
  REQUIRE(solid.surface);
  return validate::surface_words(*solid.surface);
}

std::set<int> codes_of(const InspectedSolid& solid) {
  std::set<int> codes;
  for (const Finding& finding : solid.inspection.report.findings) codes.insert(finding.code);
  return codes;
}

TEST_CASE("findings in surfaces are warnings, and leave the verdict as it is") {
  const auto features = inspect_all(Surfaces::read, Severity::warning);
  pipeline::SurfaceCounts counts;
  for (const InspectedFeature& feature : features) {
    CHECK(feature.verdict() == Verdict::valid);
    counts.add(feature.surfaces);
  }
  CHECK(counts.checked == 7);
  CHECK(counts.closed == 3);
  CHECK(counts.closed_valid == 1);
  CHECK(counts.with_findings == 2);

  const InspectedFeature& rings = named(features, "rings");
  REQUIRE(rings.solids.size() == 1);
  CHECK(rings.own == 0);
  CHECK(codes_of(rings.solids[0]) == std::set<int>{102, 203});
  const Finding& finding = rings.solids[0].inspection.report.findings[0];
  CHECK(finding.severity == Severity::warning);
  CHECK(finding.place.facet == 0);
  CHECK(codes_of(named(features, "empty").solids[0]) == std::set<int>{902});
}

TEST_CASE("surfaces of which there is nothing to say are only counted") {
  const auto features = inspect_all(Surfaces::read, Severity::warning);
  CHECK(named(features, "terrain").solids.empty());
  CHECK(named(features, "terrain").surfaces.checked == 1);
  const InspectedFeature& solid = named(features, "solid");
  CHECK(solid.solids.size() == 1);
  CHECK(solid.own == 1);
  CHECK_FALSE(solid.solids[0].surface);
}

TEST_CASE("a closed surface says which solid it would be") {
  const auto features = inspect_all(Surfaces::read, Severity::warning);
  CHECK(words_of(named(features, "closed").solids[0]) == "closed: would be a valid solid");
  CHECK(words_of(named(features, "turned").solids[0]) ==
        "closed, but would be an invalid solid: 307");
  CHECK(words_of(named(features, "two").solids[0]) ==
        "closed in 2 shells, which are offered as no solid");
  CHECK(words_of(named(features, "rings").solids[0]) ==
        "open: 8 edges that not exactly two facets share");
}

TEST_CASE("judged surfaces make their features invalid") {
  const auto features = inspect_all(Surfaces::read, Severity::error);
  CHECK(named(features, "rings").verdict() == Verdict::invalid);
  CHECK(named(features, "rings").solids[0].inspection.report.first_level ==
        std::vector<int>{102, 203});
  CHECK(named(features, "closed").verdict() == Verdict::valid);
  CHECK(named(features, "turned").verdict() == Verdict::valid);  // no ring or facet is wrong
}

TEST_CASE("closed surfaces are solids where that is asked for") {
  const auto features = inspect_all(Surfaces::as_solids, Severity::warning);
  const InspectedFeature& closed = named(features, "closed");
  REQUIRE(closed.own == 1);
  CHECK(closed.solids[0].inspection.certified);
  CHECK(closed.solids[0].source.geometry_type == "MultiSurface");
  const InspectedFeature& turned = named(features, "turned");
  CHECK(turned.verdict() == Verdict::invalid);
  CHECK(codes_of(turned.solids[0]) == std::set<int>{307});
  CHECK(named(features, "two").own == 0);
  CHECK(named(features, "two").verdict() == Verdict::valid);
}

TEST_CASE("closed surfaces are coded as blobs, and come back byte for byte") {
  const Bytes source = test::read_bytes(kFile);
  pipeline::IngestOptions options;
  options.policy = pipeline::Policy::keep;
  options.surfaces = Surfaces::as_solids;
  auto encoded = pipeline::encode_document(read(Surfaces::as_solids, false), nullptr, options);
  REQUIRE(encoded);
  REQUIRE(encoded->document.features.size() == 1);
  CHECK(encoded->document.features[0].solids.size() == 3);  // solid, closed, turned
  CHECK(encoded->document.features[0].unproven() == 1);
  const auto packed = pipeline::write_container(encoded->document, {});
  REQUIRE(packed);
  const auto info = pipeline::describe_container(*packed);
  REQUIRE(info);
  using Counts = std::map<std::string, std::uint64_t>;
  CHECK(info->other_geometries == Counts{{"CompositeSurface", 1}, {"MultiSurface", 4}});
  const auto decoded = pipeline::decode_container(*packed);
  REQUIRE(decoded);
  const auto written = formats::write_document(decoded->front(), Format::city_json);
  REQUIRE(written);
  CHECK(*written == source);
}

TEST_CASE("canonical contracts keep closed surfaces as surfaces, with semantics by facet") {
  for (const auto contract : {formats::Contract::lattice, formats::Contract::boundary}) {
    pipeline::IngestOptions options;
    options.policy = pipeline::Policy::keep;
    options.contract = contract;
    auto encoded = pipeline::encode_document(read(Surfaces::as_solids), nullptr, options);
    REQUIRE(encoded);
    for (const pipeline::EncodedFeature& feature : encoded->document.features) {
      if (feature.id != "closed") continue;
      const auto document = pipeline::decode_feature(feature);
      REQUIRE(document);
      const auto text = formats::write_feature(*document, document->features[0]);
      REQUIRE(text);
      const auto json = nlohmann::json::parse(*text);
      const auto& geometry = json["CityObjects"]["closed"]["geometry"][0];
      CHECK(geometry["type"] == "MultiSurface");
      CHECK(geometry["boundaries"].size() == 6);
      if (contract == formats::Contract::boundary) continue;
      // The ground is the facet whose vertices all have z = 0.
      const auto& values = geometry["semantics"]["values"];
      REQUIRE(values.size() == 6);
      for (std::size_t facet = 0; facet < 6; ++facet) {
        int height = 0;
        for (const std::size_t vertex : geometry["boundaries"][facet][0]) {
          height += json["vertices"][vertex][2].get<int>();
        }
        CHECK(values[facet] == (height == 0 ? 0 : height == 40 ? 1 : 2));
      }
    }
  }
}

TEST_CASE("a surface that becomes a solid gets a shell around its facets and their semantics") {
  Document document = read(Surfaces::as_solids);
  const auto turned = formats::turn_surfaces_into_solids(document);
  REQUIRE(turned);
  CHECK(*turned == 2);
  const auto text = formats::write_document(document, Format::city_json);
  REQUIRE(text);
  const auto json = nlohmann::json::parse(text->begin(), text->end());
  const auto& geometry = json["CityObjects"]["closed"]["geometry"][0];
  CHECK(geometry["type"] == "Solid");
  CHECK(geometry["boundaries"][0].size() == 6);
  CHECK(geometry["semantics"]["values"] == nlohmann::json::parse("[[0,1,2,2,2,2]]"));
  CHECK(json["CityObjects"]["two"]["geometry"][0]["type"] == "MultiSurface");
}

TEST_CASE("skip leaves out an invalid closed surface and codes the others") {
  pipeline::IngestOptions options;
  options.policy = pipeline::Policy::skip;
  options.surfaces = Surfaces::as_solids;
  auto encoded = pipeline::encode_document(read(Surfaces::as_solids, false), nullptr, options);
  REQUIRE(encoded);
  REQUIRE(encoded->document.features.size() == 1);
  CHECK(encoded->document.features[0].solids.size() == 2);
  CHECK(encoded->outcome.features[0].left_out.size() == 1);
}

TEST_CASE("a surface whose arrays are wrong is a warning of its feature") {
  const std::string text =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
      R"("CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2",)"
      R"("boundaries":[[0,1,2]]}]}},"vertices":[[0,0,0],[1,0,0],[0,1,0]]})";
  formats::ReadOptions reading;
  reading.surfaces = Surfaces::read;
  auto document = formats::read_document(as_bytes(text), Format::city_json, reading);
  REQUIRE(document);
  const auto inspected = pipeline::inspect(std::move(document->features[0]), nullptr, {});
  CHECK(inspected.verdict() == Verdict::valid);
  REQUIRE(inspected.solids.size() == 1);
  CHECK(codes_of(inspected.solids[0]) == std::set<int>{901});
}

TEST_CASE("the rules for surfaces have names") {
  CHECK(pipeline::surface_rule_named("judge")->severity == Severity::error);
  CHECK(pipeline::surface_rule_named("as-solids")->reading == Surfaces::as_solids);
  CHECK_FALSE(pipeline::surface_rule_named("solids"));
}

}  // namespace
}  // namespace watertight::test_surfaces
