// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/outcome_json.h"

#include <cstdint>

#include "pipeline/stored/solid_lines.h"
#include "repair/summary_json.h"
#include "validate/report_json.h"

namespace watertight::pipeline {
namespace {

void write_solid(JsonText& json, const SolidOutcome& solid) {
  const SolidSource& source = solid.source;
  json.open('{').key("object").value(source.object_id);
  json.key("geometryType").value(source.geometry_type);
  if (!source.lod.empty()) json.key("lod").value(source.lod);
  json.key("geometry").value(source.geometry).key("ordinal").value(source.ordinal);
  if (!source.pointer.empty()) json.key("pointer").value(source.pointer);
  if (solid.blob_bytes > 0) json.key("blobBytes").value(std::uint64_t{solid.blob_bytes});
  json.key("report").raw(solid.report_json).close('}');
}

void write_repair(JsonText& json, const SolidRepair& repair) {
  const SolidSource& source = repair.source;
  json.open('{').key("object").value(source.object_id);
  if (!source.lod.empty()) json.key("lod").value(source.lod);
  json.key("geometry").value(source.geometry).key("ordinal").value(source.ordinal);
  json.key("repair").raw(repair::summary_json(repair.summary)).close('}');
}

void write_place(JsonText& json, const InspectedGroup& group, const Place& place) {
  json.open('{');
  if (place.solid < group.members.size()) {
    json.key("solid").value(std::uint64_t{group.members[place.solid]});
  }
  if (place.facet != kNone) json.key("facet").value(place.facet);
  json.close('}');
}

void write_finding(JsonText& json, const InspectedGroup& group, const Finding& finding) {
  json.open('{').key("code").value(std::int64_t{finding.code});
  json.key("name").value(validate::finding_name(finding.code));
  json.key("severity").value(validate::to_string(finding.severity)).key("place");
  write_place(json, group, finding.place);
  if (finding.other) {
    json.key("other");
    write_place(json, group, *finding.other);
  }
  if (finding.witness) json.key("witness").value(*finding.witness);
  if (finding.measured) json.key("measured").value(*finding.measured);
  if (finding.limit) json.key("limit").value(*finding.limit);
  if (!finding.unit.empty()) json.key("unit").value(finding.unit);
  json.key("detail").value(finding.detail).close('}');
}

void write_group(JsonText& json, const InspectedGroup& group) {
  json.open('{').key("kind").value(validate::to_string(group.kind));
  json.key("object").value(group.object_id);
  if (!group.lod.empty()) json.key("lod").value(group.lod);
  json.key("solids").open('[');
  for (const std::size_t member : group.members) json.value(std::uint64_t{member});
  json.close(']').key("verdict").value(validate::to_string(group.report.verdict));
  json.key("findings").open('[');
  for (const Finding& finding : group.report.findings) write_finding(json, group, finding);
  json.close(']').key("findingsOmitted").value(group.report.findings_omitted);
  json.key("notRun").open('[');
  for (const validate::SkippedRule& rule : group.report.not_run) {
    json.open('{').key("codes").open('[');
    for (const int code : rule.codes) json.value(std::int64_t{code});
    json.close(']').key("reason").value(rule.reason).close('}');
  }
  json.close(']').close('}');
}

/// The solids, geometries and groups of a feature, as members of an object.
void write_parts(JsonText& json, const FeatureOutcome& feature) {
  json.key("solids").open('[');
  for (const SolidOutcome& solid : feature.solids) write_solid(json, solid);
  json.close(']');
  if (!feature.repairs.empty()) {
    json.key("repairs").open('[');
    for (const SolidRepair& repair : feature.repairs) write_repair(json, repair);
    json.close(']');
  }
  if (!feature.left_out.empty()) {
    json.key("leftOut").open('[');
    for (const formats::GeometryPlace& place : feature.left_out) {
      json.open('{').key("object").value(place.object_id);
      json.key("geometry").value(place.geometry).close('}');
    }
    json.close(']');
  }
  if (!feature.groups.empty()) {
    json.key("groups").open('[');
    for (const InspectedGroup& group : feature.groups) write_group(json, group);
    json.close(']');
  }
}

}  // namespace

std::string feature_line(const FeatureOutcome& feature) {
  JsonText json;
  json.open('{');
  if (feature.line > 0) json.key("line").value(feature.line);
  json.key("id").value(feature.id).key("verdict").value(validate::to_string(feature.verdict));
  if (feature.verdict != Verdict::valid) write_parts(json, feature);
  json.close('}');
  return json.take();
}

std::string feature_findings_json(const InspectedFeature& feature) {
  JsonText json;
  bool has_findings = false;
  json.open('[');
  for (const InspectedGroup& group : feature.groups) {
    if (group.report.verdict == Verdict::valid) continue;
    has_findings = true;
    write_group(json, group);
  }
  for (std::size_t i = feature.own; i < feature.solids.size(); ++i) {
    const InspectedSolid& instance = feature.solids[i];
    if (instance.inspection.report.verdict == Verdict::valid) continue;
    has_findings = true;
    SolidOutcome outcome;
    outcome.source = instance.source;
    validate::ReportJsonOptions options;
    options.pointer_prefix = instance.source.pointer;
    options.include_times = false;
    outcome.report_json =
        validate::report_json(instance.inspection.report, feature.feature.solids[i].solid, options);
    write_solid(json, outcome);
  }
  json.close(']');
  return has_findings ? json.take() : std::string();
}

std::string proof_json(const EncodedFeature& feature) {
  JsonText json;
  json.open('{').key("id").value(feature.id).key("proven").value(feature.is_proven());
  json.key("solids").open('[');
  std::string_view skeleton = feature.skeleton;
  const auto lines = take_solid_lines(skeleton, feature.solids.size());
  for (std::size_t i = 0; i < feature.solids.size(); ++i) {
    const StoredSolid& solid = feature.solids[i];
    json.open('{').key("object").value(solid.object_id);
    if (!solid.lod.empty()) json.key("lod").value(solid.lod);
    json.key("geometry").value(solid.geometry).key("ordinal").value(solid.ordinal);
    json.key("proven").value(solid.is_proven);
    if (!solid.measures.empty()) json.key("measures").raw(solid.measures);
    if (!solid.report.empty()) json.key("report").raw(solid.report);
    if (lines && !(*lines)[i].repaired.empty()) json.key("repair").raw((*lines)[i].repaired);
    json.close('}');
  }
  json.close(']');
  if (!feature.findings.empty()) json.key("findings").raw(feature.findings);
  if (const auto others = other_geometries(feature); !others.empty()) {
    json.key("otherGeometries").open('{');
    for (const auto& [type, count] : others) json.key(type).value(count);
    json.close('}');
  }
  json.close('}');
  return json.take();
}

std::string measures_json(const geometry::Measures& measures) {
  JsonText json;
  json.open('{').key("volume").value(measures.volume).key("area").value(measures.area);
  json.key("boxMin").value(measures.box_min).key("boxMax").value(measures.box_max);
  json.key("genus").value(measures.genus).key("vertices").value(measures.vertices);
  json.key("facets").value(measures.facets).key("rings").value(measures.rings);
  json.key("shells").value(measures.shells).close('}');
  return json.take();
}

std::string outcome_json(const IngestOutcome& outcome) {
  JsonText json;
  json.open('{').key("verdict").value(validate::to_string(outcome.verdict));
  json.key("stored").value(outcome.stored);
  json.key("unproven").open('{').key("features").value(outcome.unproven_features);
  json.key("solids").value(outcome.unproven).close('}');
  json.key("counts").open('{').key("features").value(outcome.total);
  json.key("valid").value(outcome.total - outcome.invalid - outcome.undecided);
  json.key("invalid").value(outcome.invalid).key("undecided").value(outcome.undecided).close('}');
  if (outcome.twins > 0) {
    json.key("duplicates").open('{').key("count").value(outcome.twins).key("first").open('[');
    for (const store::Twins& twins : outcome.first_twins) {
      json.open('{').key("id").value(twins.id).key("sameBoxAs").value(twins.other).close('}');
    }
    json.close(']').close('}');
  }
  json.key("featuresOmitted").value(outcome.total - outcome.features.size());
  json.key("features").open('[');
  for (const FeatureOutcome& feature : outcome.features) {
    json.open('{').key("id").value(feature.id);
    json.key("verdict").value(validate::to_string(feature.verdict));
    json.key("stored").value(feature.is_stored);
    write_parts(json, feature);
    json.close('}');
  }
  json.close(']').close('}');
  return json.take();
}

}  // namespace watertight::pipeline
