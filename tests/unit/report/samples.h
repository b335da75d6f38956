// SPDX-License-Identifier: GPL-3.0-or-later
//
// Validated features for tests of reports, made without a reader or a rule.
#pragma once

#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>

#include "report/feature_report.h"

namespace watertight::test {

/// A box with two triangles on each side, which begins at `x`, on a decimal lattice of millimetres
/// far from the origin.
inline Solid box_at(double x, std::uint32_t srid = 7415) {
  SolidArrays arrays;
  for (int i = 0; i < 8; ++i) {
    arrays.vertices.push_back(
        {x + (i & 1 ? 4000.0 : 0.0), i & 2 ? 3000.0 : 0.0, i & 4 ? 2000.0 : 0.0});
  }
  const std::vector<std::vector<Index>> facets{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& facet : facets) {
    arrays.ring_vertices.insert(arrays.ring_vertices.end(), facet.begin(), facet.end());
    arrays.end_ring();
    arrays.end_facet();
  }
  arrays.end_shell();
  Lattice lattice;
  lattice.step.fill(GridNumber{1, -3});
  lattice.origin = {GridNumber{84616, 0}, GridNumber{447422, 0}, GridNumber{2, 0}};
  auto solid = Solid::make(std::move(arrays), lattice, srid);
  REQUIRE(solid);
  return *solid;
}

inline Finding finding_of(int code, Index facet, std::optional<Index> other = {}) {
  Finding finding;
  finding.code = code;
  finding.severity = code / 100 == 8 ? Severity::warning : Severity::error;
  finding.place.shell = 0;
  finding.place.facet = facet;
  if (other) finding.other = Place{0, *other, kNone, kNone, kNone};
  finding.detail = "a detail";
  return finding;
}

/// A feature of one solid with the given findings.
inline pipeline::ValidatedFeature feature_of(const std::string& id, std::vector<Finding> findings,
                                             std::uint32_t srid = 7415) {
  SubmittedSolid submitted{box_at(0, srid),
                           {id, "Solid", "2.2", 0, 0, "/CityObjects/b/geometry/0"}};
  pipeline::InspectedSolid solid{submitted.source, {}};
  Report& report = solid.inspection.report;
  report.verdict = Verdict::valid;
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::error) {
      report.verdict = Verdict::invalid;
      report.first_level = {finding.code};
    }
  }
  report.findings = std::move(findings);
  pipeline::ValidatedFeature feature;
  feature.inspected.feature.id = id;
  feature.inspected.feature.type = "Building";
  feature.inspected.feature.srid = srid;
  feature.inspected.feature.solids.push_back(std::move(submitted));
  feature.inspected.solids.push_back(std::move(solid));
  return feature;
}

/// A building with two parts that overlap.
inline pipeline::ValidatedFeature overlapping_parts() {
  pipeline::ValidatedFeature feature = feature_of("part-1", {});
  SubmittedSolid second{box_at(2000),
                        {"part-2", "Solid", "2.2", 0, 0, "/CityObjects/c/geometry/0"}};
  pipeline::InspectedSolid inspected{second.source, {}};
  inspected.inspection.report.verdict = Verdict::valid;
  feature.inspected.feature.id = "building";
  feature.inspected.feature.solids.push_back(std::move(second));
  feature.inspected.solids.push_back(std::move(inspected));
  pipeline::InspectedGroup group;
  group.kind = validate::GroupKind::building_parts;
  group.object_id = "building";
  group.lod = "2.2";
  group.members = {0, 1};
  group.report.verdict = Verdict::invalid;
  Finding finding;
  finding.code = 601;
  finding.place.solid = 0;
  finding.other = Place{kNone, kNone, kNone, kNone, 1};
  finding.witness = std::array<double, 3>{84619, 447423, 3};
  group.report.findings.push_back(finding);
  feature.inspected.groups.push_back(std::move(group));
  return feature;
}

/// The text of a report, and the number and the largest size of its pieces.
struct Written {
  std::string text;
  std::size_t largest_piece = 0;
  report::TextSink sink() {
    return [this](std::string_view piece) -> Status {
      text += piece;
      largest_piece = std::max(largest_piece, piece.size());
      return Done{};
    };
  }
};

inline report::ReportHead head_without_times() {
  report::ReportHead head;
  head.program_version = "1.2.3";
  return head;
}

inline void write_document(report::FeatureReport& report, const std::string& name,
                           const std::vector<pipeline::ValidatedFeature>& features) {
  REQUIRE(report.begin_document({name, Format::city_json}));
  for (const pipeline::ValidatedFeature& feature : features) REQUIRE(report.add(feature));
  REQUIRE(report.end_document({{"a note"}, 1.5}));
}

}  // namespace watertight::test
