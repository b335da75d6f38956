// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>

#include "formats/city_json/city_json.h"
#include "geometry/parallel.h"
#include "pipeline/groups.h"
#include "pipeline/indoor/cells.h"
#include "pipeline/instances.h"
#include "pipeline/streaming/process.h"
#include "pipeline/streaming/stage_times.h"
#include "validate/report_json.h"

namespace watertight::pipeline {
namespace {

using formats::GeometryPlace;

constexpr std::size_t kVertexBytes = 24;  // three doubles
constexpr std::size_t kCornerBytes = 4;   // one index

validate::SourceElements elements_of(const SubmittedSolid& submitted) {
  return {submitted.source.line, submitted.facet_ids, submitted.ring_ids, submitted.facet_lines,
          submitted.ring_lines};
}

std::size_t plain_bytes(const Solid& solid) {
  return solid.vertex_count() * kVertexBytes + solid.arrays().ring_vertices.size() * kCornerBytes;
}

bool is_cancelled(const IngestOptions& options) {
  return options.is_cancelled && options.is_cancelled();
}

Error cancelled() {
  return Error{ErrorCode::cancelled, "stopped before all features were validated"};
}

/// Names the elements of the findings about a group.
void name_members(const InspectedFeature& inspected, InspectedGroup& group) {
  const auto element = [&](const Place& place) {
    if (place.solid >= group.members.size()) return validate::SourceElement{};
    const SubmittedSolid& member = inspected.feature.solids[group.members[place.solid]];
    return validate::element_at(place, member.solid, elements_of(member));
  };
  for (Finding& finding : group.report.findings) {
    if (finding.source.line == 0) finding.source = element(finding.place);
    if (finding.other) finding.other_source = element(*finding.other);
  }
}

/// The outcome of a solid; `encoded` is the solid after encoding, or null.
SolidOutcome outcome_of(InspectedSolid& inspected, const Solid& solid, const StoredSolid* encoded) {
  SolidOutcome outcome;
  outcome.source = std::move(inspected.source);
  outcome.report = std::move(inspected.inspection.report);
  outcome.source_bytes = plain_bytes(solid);
  if (encoded != nullptr) {
    outcome.report_json = encoded->report;
    outcome.blob_bytes = encoded->blob.size();
    return outcome;
  }
  validate::ReportJsonOptions json;
  json.pointer_prefix = outcome.source.pointer;
  json.has_shells = !formats::is_surface(outcome.source);
  json.include_times = false;
  outcome.report_json = validate::report_json(outcome.report, solid, json);
  return outcome;
}

Result<std::vector<ProcessedFeature>> process_all(Document& document, const SharedPart& shared,
                                                  delaunay::EngineWorkers* workers,
                                                  const IngestOptions& options) {
  std::vector<Feature>& features = document.features;
  std::vector<std::optional<Result<ProcessedFeature>>> processed(features.size());
  TemplateInspector templates(document.templates, workers, options.certify,
                              group_options(options.groups, options.certify));
  CellInspector cells(document, workers, options.certify, options.groups, options.threads,
                      options.is_cancelled);
  std::size_t done = 0;
  std::mutex mutex;
  geometry::for_each_piece(
      features.size(), static_cast<unsigned>(options.threads), [&](std::size_t i, bool) {
        if (is_cancelled(options)) return;
        processed[i] = process(std::move(features[i]), shared, workers, options, templates, cells);
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(done, features.size());
      });
  if (done < features.size()) return cancelled();
  std::vector<ProcessedFeature> all;
  for (auto& feature : processed) {
    if (!*feature) return std::move(*feature).error();
    all.push_back(**std::move(feature));
  }
  return all;
}

bool is_city_model(Format format) {
  return format == Format::city_json || format == Format::city_json_seq;
}

GeometryPlace place_of(const SolidSource& source) { return {source.object_id, source.geometry}; }

/// True for a part of a city object that is no geometry, such as a child that is missing.
bool is_no_geometry(const SolidSource& source) {
  return source.geometry_type.empty() && !source.pointer.empty();
}

/// The geometries that are not proven, and those that a defect of a group names.
std::set<GeometryPlace> unproven_geometries(const InspectedFeature& feature) {
  std::set<GeometryPlace> places;
  for (const InspectedSolid& solid : feature.solids) {
    if (is_no_geometry(solid.source)) continue;
    if (solid.inspection.report.verdict != Verdict::valid) places.insert(place_of(solid.source));
  }
  for (const InspectedGroup& group : feature.groups) {
    if (group.report.verdict == Verdict::valid) continue;
    const auto choose = [&](const Place& place) {
      if (place.solid >= group.members.size()) return;
      places.insert(place_of(feature.solids[group.members[place.solid]].source));
    };
    if (group.report.findings.empty()) {  // undecided: any member may be at fault
      for (const std::size_t member : group.members) {
        places.insert(place_of(feature.solids[member].source));
      }
    }
    for (const Finding& finding : group.report.findings) {
      if (finding.severity == Severity::warning) continue;
      choose(finding.place);
      if (finding.other) choose(*finding.other);
    }
  }
  return places;
}

/// Reads the text of a feature under a header, or of a whole CityJSON.
Result<Feature> read_again(const std::string& text, const formats::CityHeader& header,
                           bool is_whole, formats::Surfaces surfaces) {
  const formats::ReadOptions reading{kOwnText, false, false, surfaces};
  if (!is_whole) return formats::read_city_json_feature(header, text, reading);
  auto document = formats::read_city_json(text, reading);
  if (!document) return std::move(document).error();
  return std::move(document->features.front());
}

/// Whether the only defects are parts that cannot be read and are no geometry, such as a child that
/// is missing: they cannot be left out.
bool is_proven_but_for_unreadable(const InspectedFeature& feature) {
  for (std::size_t i = 0; i < feature.solids.size(); ++i) {
    const InspectedSolid& solid = feature.solids[i];
    const bool is_kept = i >= feature.own && is_no_geometry(solid.source);
    if (!is_kept && solid.inspection.report.verdict != Verdict::valid) return false;
  }
  return std::all_of(feature.groups.begin(), feature.groups.end(), [](const InspectedGroup& group) {
    return group.report.verdict == Verdict::valid;
  });
}

/// Encodes the feature without the geometries that are not proven, and notes these in the outcome.
/// nullopt when no geometry is left, or when the rest is not valid either: then all is left out.
Result<std::optional<EncodedFeature>> encode_rest(
    const InspectedFeature& feature, const SharedPart& shared, delaunay::EngineWorkers* workers,
    const IngestOptions& options, TemplateInspector& templates, FeatureOutcome& outcome) {
  if (!shared.city) return std::optional<EncodedFeature>();
  const bool is_whole = feature.feature.id.empty();
  Feature own = feature.feature;  // without the solids of instances
  own.solids.erase(own.solids.begin() + static_cast<std::ptrdiff_t>(feature.own), own.solids.end());
  own.layout = {};
  auto text = formats::write_city_json_feature(*shared.city, own);
  if (!text) return std::move(text).error();
  const std::set<GeometryPlace> places = unproven_geometries(feature);
  auto divided = formats::divide_city_model(*text, places, kOwnText);
  if (!divided) return std::move(divided).error();
  outcome.left_out.assign(places.begin(), places.end());
  outcome.rejected = std::move(divided->chosen);
  if (divided->geometries_left == 0) return std::optional<EncodedFeature>();
  auto rest = read_again(divided->rest, *shared.city, is_whole, options.surfaces);
  if (!rest) return std::move(rest).error();
  std::size_t next = 0;
  for (std::size_t i = 0; i < feature.own && next < rest->solids.size(); ++i) {
    const SubmittedSolid& submitted = feature.feature.solids[i];
    if (!places.contains(place_of(submitted.source))) {
      rest->solids[next++].repair = submitted.repair;
    }
  }
  const InspectedFeature inspected =
      inspect(*std::move(rest), workers, options.certify, options.groups, &templates);
  if (!is_proven_but_for_unreadable(inspected)) {
    outcome.rejected = *std::move(text);
    return std::optional<EncodedFeature>();
  }
  auto encoded = encode_feature(inspected, shared.document, options);
  if (!encoded) return std::move(encoded).error();
  return std::optional(*std::move(encoded));
}

}  // namespace

namespace {

/// Notes the bytes of the blobs of `rest`, whose geometries have new numbers since some were left
/// out, for the first `own` solids of the outcome.
void add_blob_bytes(const EncodedFeature& rest, std::size_t own, FeatureOutcome& outcome) {
  std::map<std::tuple<std::string_view, std::uint32_t, std::uint32_t>, std::size_t> bytes;
  for (const StoredSolid& solid : rest.solids) {
    bytes[{solid.object_id, solid.geometry, solid.ordinal}] = solid.blob.size();
  }
  const std::set<GeometryPlace> left_out(outcome.left_out.begin(), outcome.left_out.end());
  for (std::size_t i = 0; i < own; ++i) {
    SolidOutcome& solid = outcome.solids[i];
    const auto place = left_out.lower_bound(place_of(solid.source));
    if (place != left_out.end() && *place == place_of(solid.source)) continue;
    const auto before = std::distance(left_out.lower_bound({solid.source.object_id, 0}), place);
    const auto number = solid.source.geometry - static_cast<std::uint32_t>(before);
    const auto found = bytes.find({solid.source.object_id, number, solid.source.ordinal});
    if (found != bytes.end()) solid.blob_bytes = found->second;
  }
}

}  // namespace

Result<Policy> policy_named(const std::string& name) {
  if (name == "refuse") return Policy::refuse;
  if (name == "skip") return Policy::skip;
  if (name == "keep") return Policy::keep;
  return Error{ErrorCode::invalid_argument,
               "the policy for invalid features is refuse, skip or keep"};
}

formats::CurvedReading curved_reading(double chord) {
  return {chord, {}, false, validate::has_crossing_facets};
}

Result<int> lattice_exponent_of(std::string_view step) {
  constexpr std::array kSteps{1e-9, 1e-8, 1e-7, 1e-6, 1e-5,  1e-4,  1e-3,
                              0.01, 0.1,  1.0,  10.0, 100.0, 1000.0};
  double metres = 0;
  const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), metres);
  const auto* const found = std::find(kSteps.begin(), kSteps.end(), metres);
  if (error != std::errc() || end != step.data() + step.size() || found == kSteps.end()) {
    return Error{
        ErrorCode::invalid_argument,
        "the lattice is a power of ten from 1e-9 to 1000 metres, not '" + std::string(step) + "'"};
  }
  return static_cast<int>(found - kSteps.begin()) - 9;
}

Result<SurfaceRule> surface_rule_named(const std::string& name) {
  if (name == "ignore") return SurfaceRule{formats::Surfaces::ignore, Severity::warning};
  if (name == "check") return SurfaceRule{formats::Surfaces::read, Severity::warning};
  if (name == "judge") return SurfaceRule{formats::Surfaces::read, Severity::error};
  if (name == "as-solids") return SurfaceRule{formats::Surfaces::as_solids, Severity::warning};
  return Error{ErrorCode::invalid_argument,
               "the rule for surfaces is ignore, check, judge or as-solids"};
}

std::string_view to_string(Policy policy) {
  if (policy == Policy::refuse) return "refuse";
  return policy == Policy::skip ? "skip" : "keep";
}

Verdict worse(Verdict a, Verdict b) {
  if (a == Verdict::invalid || b == Verdict::invalid) return Verdict::invalid;
  if (a == Verdict::undecided || b == Verdict::undecided) return Verdict::undecided;
  return Verdict::valid;
}

Verdict InspectedFeature::verdict() const {
  Verdict verdict = Verdict::valid;
  for (const InspectedSolid& solid : solids) {
    verdict = worse(verdict, solid.inspection.report.verdict);
  }
  for (const InspectedGroup& group : groups) verdict = worse(verdict, group.report.verdict);
  return verdict;
}

namespace {

/// Adds the comparison of a cell with others, after the groups that begin with its first solid.
void add_cell(validate::GroupReport report, InspectedFeature& inspected) {
  InspectedGroup group{validate::GroupKind::indoor_cells, inspected.feature.id, {}, {}, {}};
  for (std::size_t i = 0; i < inspected.own; ++i) group.members.push_back(i);
  group.report = std::move(report);
  const auto place =
      std::find_if(inspected.groups.begin(), inspected.groups.end(),
                   [](const InspectedGroup& other) { return other.members.front() > 0; });
  inspected.groups.insert(place, std::move(group));
}

}  // namespace

void add_surfaces(InspectedFeature& inspected, const CertifyOptions& options) {
  for (SubmittedSolid& surface : inspected.feature.surfaces) {
    auto found = validate::inspect_surface(surface.solid, options_for(surface, options));
    const bool has_findings = !found.report.findings.empty();
    const bool is_closed = found.facts.closure.is_closed;
    inspected.surfaces.add(found);
    if (!has_findings && !is_closed && found.report.verdict == Verdict::valid) continue;
    if (surface.unreadable.empty()) {
      found.report.notes.push_back(validate::surface_words(found.facts));
    }
    inspected.solids.push_back(
        {surface.source, {std::move(found.report), {}, {}}, std::move(found.facts)});
    inspected.feature.solids.push_back(std::move(surface));
  }
  inspected.feature.surfaces.clear();
}

void SurfaceCounts::add(const validate::SurfaceInspection& surface) {
  ++checked;
  if (!surface.report.findings.empty()) ++with_findings;
  if (!surface.facts.closure.is_closed) return;
  ++closed;
  if (surface.facts.as_solid == Verdict::valid) ++closed_valid;
}

void SurfaceCounts::add(const SurfaceCounts& other) {
  checked += other.checked;
  with_findings += other.with_findings;
  closed += other.closed;
  closed_valid += other.closed_valid;
}

InspectedFeature inspect(Feature feature, delaunay::EngineWorkers* workers,
                         const CertifyOptions& options, const validate::GroupOptions& groups,
                         TemplateInspector* templates, CellInspector* cells) {
  InspectedFeature inspected;
  inspected.solids.reserve(feature.solids.size());
  InspectedCell cell = cells != nullptr ? cells->take(feature) : InspectedCell{};
  for (std::size_t i = 0; i < feature.solids.size(); ++i) {
    const SubmittedSolid& submitted = feature.solids[i];
    inspected.solids.push_back(
        {submitted.source,
         cell.is_ready ? std::move(cell.inspections[i])
                       : certify(submitted.solid, workers, options_for(submitted, options)),
         {},
         {},
         submitted.tessellation});
  }
  inspected.feature = std::move(feature);
  inspected.own = inspected.solids.size();
  if (templates != nullptr) {
    add_groups(templates->inspect(inspected.feature.instances), *templates,
               group_options(groups, options), inspected);
  } else {
    inspected.groups = inspect_groups(group_candidates(inspected), group_options(groups, options));
  }
  if (cell.is_ready) add_cell(std::move(cell.report), inspected);
  for (InspectedGroup& group : inspected.groups) name_members(inspected, group);
  add_unreadable(inspected, options);
  add_surfaces(inspected, options);
  return inspected;
}

validate::GroupOptions group_options(const validate::GroupOptions& groups,
                                     const CertifyOptions& options) {
  validate::GroupOptions own = groups;
  own.limits.findings = std::min(own.limits.findings, options.limits.findings);
  if (!own.cancel) own.cancel = options.ladder.cancel;
  return own;
}

CertifyOptions options_for(const SubmittedSolid& submitted, const CertifyOptions& options) {
  CertifyOptions own = options;
  own.rounded = submitted.rounded;
  own.is_origin_rounded = submitted.is_origin_rounded;
  own.unclosed_rings = submitted.unclosed_rings;
  own.unused = submitted.unused;
  own.unreadable = submitted.unreadable;
  own.elements = elements_of(submitted);
  return own;
}

void IngestCounts::add(const IngestCounts& other) {
  total += other.total;
  invalid += other.invalid;
  undecided += other.undecided;
  stored += other.stored;
  unproven += other.unproven;
  unproven_features += other.unproven_features;
  twins += other.twins;
  verdict = worse(verdict, other.verdict);
}

void IngestCounts::add(Verdict of_feature) {
  ++total;
  if (of_feature == Verdict::invalid) ++invalid;
  if (of_feature == Verdict::undecided) ++undecided;
  verdict = worse(verdict, of_feature);
}

Result<SharedPart> shared_part(const Document& document, formats::Contract contract) {
  SharedPart shared;
  shared.document.format = document.format;
  shared.document.header = document.header;
  if (contract == formats::Contract::exact) shared.document.framing = document.framing;
  if (contract == formats::Contract::boundary && !document.header.empty()) {
    auto header = formats::boundary_header(document.header);
    if (!header) return std::move(header).error();
    shared.document.header = *std::move(header);
  }
  if (is_city_model(document.format)) {
    auto header = formats::read_city_json_header(shared.document.header.str(), kOwnText);
    if (!header) return std::move(header).error();
    shared.city = *std::move(header);
  }
  return shared;
}

Result<ProcessedFeature> process(Feature feature, const SharedPart& shared,
                                 delaunay::EngineWorkers* workers, const IngestOptions& options,
                                 TemplateInspector& templates, CellInspector& cells) {
  ProcessedFeature processed;
  feature.surfaces.clear();  // they stay in the skeleton; validate_stream() reports on them
  InspectedFeature inspected = [&] {
    const StageTimer timer(options.stages, Stage::judging);
    return inspect(std::move(feature), workers, options.certify, options.groups, &templates,
                   &cells);
  }();
  const StageTimer timer(options.stages, Stage::encoding);
  processed.outcome.id = inspected.feature.id;
  processed.outcome.verdict = inspected.verdict();
  const bool is_valid = processed.outcome.verdict == Verdict::valid;
  if (is_valid || options.policy == Policy::keep) {
    auto encoded = encode_feature(inspected, shared.document, options);
    if (!encoded) return std::move(encoded).error();
    processed.encoded = *std::move(encoded);
  }
  std::optional<EncodedFeature> rest;
  if (!is_valid && options.policy == Policy::skip) {
    auto encoded = encode_rest(inspected, shared, workers, options, templates, processed.outcome);
    if (!encoded) return std::move(encoded).error();
    rest = *std::move(encoded);
  }
  for (std::size_t i = 0; i < inspected.solids.size(); ++i) {
    processed.outcome.solids.push_back(outcome_of(
        inspected.solids[i], inspected.feature.solids[i].solid,
        processed.encoded && i < inspected.own ? &processed.encoded->solids[i] : nullptr));
  }
  processed.outcome.groups = std::move(inspected.groups);
  if (rest) {
    add_blob_bytes(*rest, inspected.own, processed.outcome);
    processed.encoded = std::move(rest);
  }
  processed.outcome.is_stored = processed.encoded.has_value();
  return processed;
}

Result<EncodeOutcome> encode_document(Document document, delaunay::EngineWorkers* workers,
                                      const IngestOptions& options) {
  auto shared = shared_part(document, options.contract);
  if (!shared) return std::move(shared).error();
  auto processed = process_all(document, *shared, workers, options);
  if (!processed) return std::move(processed).error();
  EncodeOutcome encoded;
  encoded.document.format = std::string(formats::to_string(shared->document.format));
  encoded.document.header = std::move(shared->document.header);
  encoded.document.framing = std::move(shared->document.framing);
  for (ProcessedFeature& feature : *processed) {
    encoded.outcome.add(feature.outcome.verdict);
    if (feature.encoded) {
      encoded.outcome.unproven += feature.encoded->unproven();
      encoded.outcome.unproven_features += feature.encoded->is_proven() ? 0 : 1;
      encoded.document.features.push_back(*std::move(feature.encoded));
    }
    encoded.outcome.features.push_back(std::move(feature.outcome));
  }
  // The kept text of another format is that of all features.
  if (encoded.document.features.size() < encoded.outcome.features.size() &&
      !is_city_model(shared->document.format)) {
    encoded.document.framing.clear();
  }
  const bool is_refused = options.policy.value_or(Policy::refuse) == Policy::refuse;
  if (encoded.outcome.verdict != Verdict::valid && is_refused) encoded.document.features.clear();
  return encoded;
}

}  // namespace watertight::pipeline
