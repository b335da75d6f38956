// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.h"
#include "repair/summary_json.h"
#include "report/feature_report.h"
#include "report/place.h"
#include "report/tally.h"

namespace watertight::report {
namespace {

/// The most errors of reading that are listed; more errors are only counted.
constexpr std::size_t kMostErrors = 1000;

constexpr std::string_view kNumbering =
    "solids, shells, facets, rings and vertices count from 0; lines count from 1; a ring counts "
    "within its facet, the others over the whole solid";

template <class Codes>
void write_codes(JsonText& json, std::string_view name, const Codes& codes) {
  json.key(name).open('[');
  for (const int code : codes) json.value(code);
  json.close(']');
}

void write_not_run(JsonText& json, const std::vector<validate::SkippedRule>& rules) {
  json.key("not_run").open('[');
  for (const validate::SkippedRule& rule : rules) {
    json.open('{');
    write_codes(json, "codes", rule.codes);
    json.key("reason").value(rule.reason).close('}');
  }
  json.close(']');
}

void write_strings(JsonText& json, std::string_view name, const std::vector<std::string>& texts) {
  json.key(name).open('[');
  for (const std::string& text : texts) json.value(text);
  json.close(']');
}

void write_overview(JsonText& json, std::string_view name,
                    const std::map<std::string, VerdictCount>& types) {
  json.key(name).open('[');
  for (const auto& [type, verdicts] : types) {
    json.open('{').key("type").value(type).key("total").value(verdicts.total());
    json.key("valid").value(verdicts.valid).key("invalid").value(verdicts.invalid);
    json.key("undecided").value(verdicts.undecided).close('}');
  }
  json.close(']');
}

void write_ladder(JsonText& json, const Report& report, bool has_times) {
  json.key("rung").value(delaunay::to_string(report.rung));
  if (!report.refilled_facets.empty()) {
    json.key("refilled_facets").open('[');
    for (const Index facet : report.refilled_facets) json.value(facet);
    json.close(']');
  }
  json.key("attempts").open('[');
  for (const delaunay::RungAttempt& attempt : report.attempts) {
    json.open('{').key("rung").value(delaunay::to_string(attempt.rung));
    json.key("outcome").value(attempt.outcome);
    if (has_times) json.key("seconds").value(attempt.seconds);
    json.close('}');
  }
  json.close(']');
}

void write_surface(JsonText& json, const validate::SurfaceFacts& facts) {
  json.key("surface").open('{').key("closed").value(facts.closure.is_closed);
  json.key("open_edges").value(std::uint64_t{facts.closure.open_edges});
  json.key("parts").value(std::uint64_t{facts.closure.parts});
  if (facts.as_solid) {
    json.key("as_solid").value(validate::to_string(*facts.as_solid));
    write_codes(json, "solid_codes", facts.solid_codes);
  }
  json.close('}');
}

void write_surface_counts(JsonText& json, const pipeline::SurfaceCounts& surfaces) {
  if (surfaces.checked == 0) return;
  json.key("surfaces").open('{').key("checked").value(surfaces.checked);
  json.key("closed").value(surfaces.closed).key("closed_valid").value(surfaces.closed_valid);
  json.key("with_findings").value(surfaces.with_findings).close('}');
}

void write_remedies(JsonText& json, const repair::RepairOptions& options) {
  std::string remedies;
  for (const repair::Remedy remedy : options.remedies) {
    remedies.append(remedies.empty() ? "" : ",").append(repair::to_string(remedy));
  }
  json.key("remedies").value(remedies).key("weld_tol").value(options.weld_metres);
  json.key("islands").value(std::uint64_t{options.most_islands});
  if (std::ranges::find(options.remedies, repair::Remedy::smooth) == options.remedies.end()) return;
  const repair::SmoothOptions& smooth = options.smooth;
  json.key("density").value(smooth.density).key("regularity").value(smooth.regularity);
  json.key("collar").value(std::int64_t{smooth.collar.rings});
  json.key("crease").value(smooth.collar.crease_degrees);
  if (smooth.chord_metres > 0) json.key("smooth_chord").value(smooth.chord_metres);
}

void write_tessellation(JsonText& json, const formats::Tessellation& made) {
  json.key("tessellation").open('{');
  json.key("faces").value(made.faces).key("edges").value(made.edges);
  json.key("samples").value(made.samples).key("triangles").value(made.triangles);
  json.key("chord").value(made.chord).key("chord_error").value(made.chord_error);
  json.key("gap").value(made.gap).key("rounds").value(made.rounds);
  json.key("turned").value(made.turned).key("halvings").value(made.halvings);
  json.key("strips").value(made.strips).key("indices").value(made.indices);
  json.key("mean_least_angle").value(made.mean_least_angle);
  json.key("worst_least_angle").value(made.worst_least_angle);
  json.key("left_out").open('[');
  for (const formats::Tessellation::LeftOut& face : made.left_out) {
    json.open('{').key("face").value(face.face).key("reason").value(face.reason).close('}');
  }
  json.close(']').close('}');
}

void write_primitive(JsonText& json, const pipeline::InspectedSolid& solid, bool has_times) {
  const Report& report = solid.inspection.report;
  json.open('{').key("id").value(solid_id(solid.source));
  json.key("type").value(solid.source.geometry_type);
  json.key("object").value(solid.source.object_id);
  if (!solid.source.lod.empty()) json.key("lod").value(solid.source.lod);
  if (!solid.source.pointer.empty()) json.key("pointer").value(solid.source.pointer);
  json.key("validity").value(report.verdict == Verdict::valid);
  json.key("verdict").value(validate::to_string(report.verdict));
  if (!report.undecided_reason.empty()) {
    json.key("undecided_reason").value(report.undecided_reason);
  }
  write_codes(json, "first_level", report.first_level);
  if (report.tolerant) {
    json.key("tolerant")
        .open('{')
        .key("verdict")
        .value(validate::to_string(report.tolerant->verdict));
    write_codes(json, "first_level", report.tolerant->first_level);
    json.close('}');
  }
  json.key("findings_omitted").value(report.findings_omitted);
  write_not_run(json, report.not_run);
  write_strings(json, "notes", report.notes);
  write_ladder(json, report, has_times);
  if (solid.surface) write_surface(json, *solid.surface);
  if (report.measures) json.key("measures").raw(validate::report_measures_json(*report.measures));
  if (solid.tessellation) write_tessellation(json, *solid.tessellation);
  if (solid.repair) json.key("repair").raw(repair::summary_json(*solid.repair));
  if (has_times) json.key("seconds").value(report.seconds);
  json.close('}');
}

void write_group(JsonText& json, const pipeline::InspectedGroup& group) {
  json.open('{').key("kind").value(validate::to_string(group.kind));
  json.key("object").value(group.object_id);
  if (!group.lod.empty()) json.key("lod").value(group.lod);
  json.key("solids").open('[');
  for (const std::size_t member : group.members) json.value(std::uint64_t{member});
  json.close(']');
  json.key("validity").value(group.report.verdict == Verdict::valid);
  json.key("verdict").value(validate::to_string(group.report.verdict));
  json.key("findings_omitted").value(group.report.findings_omitted);
  write_not_run(json, group.report.not_run);
  json.close('}');
}

/// Writes the findings of one severity. `options` has one entry per solid.
void write_findings(JsonText& json, const pipeline::InspectedFeature& feature, Severity severity,
                    const std::vector<validate::ReportJsonOptions>& options) {
  for (const PlacedFinding& placed : findings_of(feature)) {
    if (placed.finding->severity != severity) continue;
    const Solid* here = submitted_solid(feature, placed.solid);
    const Solid* there = submitted_solid(feature, placed.other_solid);
    if (here == nullptr) continue;
    const validate::PlacedSolid first{here, &options[placed.solid]};
    const bool has_other = there != nullptr;
    const validate::PlacedSolid second{has_other ? there : here,
                                       &options[has_other ? placed.other_solid : placed.solid]};
    json.raw(validate::finding_json(*placed.finding, first, second));
  }
}

std::string feature_json(const pipeline::InspectedFeature& feature, bool has_times) {
  std::vector<validate::ReportJsonOptions> options;
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    options.push_back(json_options_of(solid.source, static_cast<Index>(options.size())));
  }
  const Verdict verdict = feature.verdict();
  JsonText json;
  json.open('{').key("id").value(feature.feature.id).key("type").value(feature.feature.type);
  json.key("validity").value(verdict == Verdict::valid);
  json.key("verdict").value(validate::to_string(verdict));
  json.key("errors").open('[');
  write_findings(json, feature, Severity::error, options);
  json.close(']').key("warnings").open('[');
  write_findings(json, feature, Severity::warning, options);
  json.close(']').key("primitives").open('[');
  for (const pipeline::InspectedSolid& solid : feature.solids)
    write_primitive(json, solid, has_times);
  json.close(']').key("groups").open('[');
  for (const pipeline::InspectedGroup& group : feature.groups) write_group(json, group);
  json.close(']');
  write_surface_counts(json, feature.surfaces);
  json.close('}');
  return json.take();
}

class JsonReport final : public FeatureReport {
 public:
  JsonReport(TextSink sink, ReportHead head) : sink_(std::move(sink)), head_(std::move(head)) {}

  Status begin_document(const DocumentHead& document) override {
    tally_ = {};
    errors_.clear();
    is_first_ = true;
    JsonText json;
    json.open('{')
        .key("type")
        .value("val3dity_report")
        .key("schema")
        .value(validate::kReportSchema);
    json.key("program").open('{').key("name").value("watertight");
    json.key("version").value(head_.program_version).close('}');
    json.key("val3dity_version").value("watertight " + head_.program_version);
    if (!head_.time.empty()) json.key("time").value(head_.time);
    json.key("input_file").value(document.file);
    json.key("input_file_type").value(document.format ? format_name(*document.format) : "unknown");
    write_parameters(json);
    json.key("numbering").value(kNumbering);
    json.key("features").open('[');
    return sink_(json.take());
  }

  Status add(const pipeline::ValidatedFeature& feature) override {
    tally_.add(feature.inspected);
    std::string text = is_first_ ? "" : ",";
    is_first_ = false;
    text += feature_json(feature.inspected, !head_.time.empty());
    return sink_(text);
  }

  Status add_error(const Error& error) override {
    tally_.add_error(code_of(error));
    if (errors_.size() < kMostErrors) errors_.push_back(error);
    return Done{};
  }

  Status end_document(const DocumentEnd& end) override {
    std::string text = "]";
    text += tail(end);
    text += "}\n";
    return sink_(text);
  }

  Status finish() override { return Done{}; }

 private:
  void write_parameters(JsonText& json) const {
    const Tolerances& tolerances = head_.acceptance.tolerances;
    const bool is_boundary = head_.acceptance.proof == Proof::boundary;
    json.key("parameters").open('{').key("overlap_tol").value(head_.overlap_metres);
    json.key("planarity_d2p_tol").value(tolerances.planarity_metres);
    json.key("planarity_n_tol").value(tolerances.planarity_degrees);
    json.key("snap_tol").value(tolerances.snap_metres);
    json.key("proof").value(is_boundary ? "boundary" : "tetrahedralization");
    json.key("strict").value(head_.is_strict).key("tolerant").value(head_.also_tolerant);
    if (head_.also_tolerant) json.key("tolerant_snap_tol").value(head_.tolerant_snap_metres);
    if (!head_.surfaces.empty()) json.key("surfaces").value(head_.surfaces);
    json.key("rule_set").value(int{head_.acceptance.rule_set});
    if (head_.repair) write_remedies(json, *head_.repair);
    json.close('}');
  }

  /// The members after the features, with a leading comma.
  std::string tail(const DocumentEnd& end) const {
    JsonText json;
    json.open('{').key("dataset_errors").open('[');
    for (const Error& error : errors_) write_error(json, error);
    json.close(']').key("dataset_errors_omitted");
    json.value(tally_.unreadable() - std::uint64_t{errors_.size()});
    write_overview(json, "features_overview", tally_.features());
    write_overview(json, "primitives_overview", tally_.solids());
    write_codes(json, "all_errors", tally_.errors());
    write_codes(json, "all_warnings", tally_.warnings());
    json.key("finding_counts").open('{');
    for (const auto& [code, count] : tally_.findings()) json.key(std::to_string(code)).value(count);
    json.close('}').key("findings_omitted").value(tally_.omitted());
    write_codes(json, "first_level", tally_.first_level());
    write_surface_counts(json, tally_.surfaces());
    if (head_.repair) {
      json.key("repairs").open('{').key("repaired").value(tally_.repairs().repaired);
      json.key("left").value(tally_.repairs().left).close('}');
    }
    write_strings(json, "notes", end.notes);
    if (!head_.time.empty()) json.key("seconds").value(end.seconds);
    json.key("validity").value(tally_.is_valid());
    json.key("verdict").value(validate::to_string(tally_.verdict()));
    std::string text = json.take();
    text.front() = ',';
    return text;
  }

  static void write_error(JsonText& json, const Error& error) {
    const int code = code_of(error);
    json.open('{').key("code").value(code).key("description").value(name_of(code));
    json.key("id").value(error.pointer).key("info").value(error.message);
    json.key("kind").value(to_string(error.code));
    if (error.byte_offset) json.key("byte_offset").value(*error.byte_offset);
    if (!error.pointer.empty()) json.key("pointer").value(error.pointer);
    json.close('}');
  }

  TextSink sink_;
  ReportHead head_;
  Tally tally_;
  std::vector<Error> errors_;
  bool is_first_ = true;
};

}  // namespace

std::unique_ptr<FeatureReport> json_report(TextSink sink, ReportHead head) {
  return std::make_unique<JsonReport>(std::move(sink), std::move(head));
}

}  // namespace watertight::report
