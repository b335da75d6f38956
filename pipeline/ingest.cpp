// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <mutex>
#include <optional>

#include "formats/city_json/city_json.h"
#include "geometry/parallel.h"
#include "pipeline/groups.h"
#include "pipeline/instances.h"
#include "pipeline/streaming/process.h"
#include "validate/report_json.h"

namespace watertight::pipeline {
namespace {

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
    finding.source = element(finding.place);
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
  json.include_times = false;
  outcome.report_json = validate::report_json(outcome.report, solid, json);
  return outcome;
}

Result<std::vector<ProcessedFeature>> process_all(std::vector<Feature> features,
                                                  std::span<const SubmittedSolid> template_solids,
                                                  const Document& shared,
                                                  delaunay::EngineWorkers* workers,
                                                  const IngestOptions& options) {
  std::vector<std::optional<Result<ProcessedFeature>>> processed(features.size());
  TemplateInspector templates(template_solids, workers, options.certify,
                              group_options(options.groups, options.certify));
  std::size_t done = 0;
  std::mutex mutex;
  geometry::for_each_piece(
      features.size(), static_cast<unsigned>(options.threads), [&](std::size_t i, bool) {
        if (is_cancelled(options)) return;
        processed[i] = process(std::move(features[i]), shared, workers, options, templates);
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

}  // namespace

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

InspectedFeature inspect(Feature feature, delaunay::EngineWorkers* workers,
                         const CertifyOptions& options, const validate::GroupOptions& groups,
                         TemplateInspector* templates) {
  InspectedFeature inspected;
  inspected.solids.reserve(feature.solids.size());
  for (const SubmittedSolid& submitted : feature.solids) {
    inspected.solids.push_back(
        {submitted.source, certify(submitted.solid, workers, options_for(submitted, options))});
  }
  inspected.feature = std::move(feature);
  if (templates != nullptr) {
    add_groups(templates->inspect(inspected.feature.instances), *templates,
               group_options(groups, options), inspected);
  } else {
    inspected.groups = inspect_groups(group_candidates(inspected), group_options(groups, options));
  }
  for (InspectedGroup& group : inspected.groups) name_members(inspected, group);
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

void IngestCounts::add(Verdict of_feature) {
  ++total;
  if (of_feature == Verdict::invalid) ++invalid;
  if (of_feature == Verdict::undecided) ++undecided;
  verdict = worse(verdict, of_feature);
}

Result<Document> shared_part(const Document& document, formats::Contract contract) {
  Document shared;
  shared.format = document.format;
  shared.header = document.header;
  if (contract == formats::Contract::exact) shared.framing = document.framing;
  if (contract != formats::Contract::boundary || document.header.empty()) return shared;
  auto header = formats::boundary_header(document.header);
  if (!header) return std::move(header).error();
  shared.header = *std::move(header);
  return shared;
}

Result<ProcessedFeature> process(Feature feature, const Document& shared,
                                 delaunay::EngineWorkers* workers, const IngestOptions& options,
                                 TemplateInspector& templates) {
  ProcessedFeature processed;
  InspectedFeature inspected =
      inspect(std::move(feature), workers, options.certify, options.groups, &templates);
  processed.outcome.id = inspected.feature.id;
  processed.outcome.verdict = inspected.verdict();
  if (processed.outcome.verdict == Verdict::valid) {
    auto encoded = encode_feature(inspected, shared, options);
    if (!encoded) return std::move(encoded).error();
    processed.encoded = *std::move(encoded);
  }
  for (std::size_t i = 0; i < inspected.solids.size(); ++i) {
    processed.outcome.solids.push_back(
        outcome_of(inspected.solids[i], inspected.feature.solids[i].solid,
                   processed.encoded ? &processed.encoded->solids[i] : nullptr));
  }
  processed.outcome.groups = std::move(inspected.groups);
  return processed;
}

Result<EncodeOutcome> encode_document(Document document, delaunay::EngineWorkers* workers,
                                      const IngestOptions& options) {
  auto shared = shared_part(document, options.contract);
  if (!shared) return std::move(shared).error();
  auto processed =
      process_all(std::move(document.features), document.templates, *shared, workers, options);
  if (!processed) return std::move(processed).error();
  EncodeOutcome encoded;
  encoded.document.format = std::string(formats::to_string(shared->format));
  encoded.document.header = std::move(shared->header);
  encoded.document.framing = std::move(shared->framing);
  for (ProcessedFeature& feature : *processed) {
    encoded.outcome.add(feature.outcome.verdict);
    if (feature.encoded) encoded.document.features.push_back(*std::move(feature.encoded));
    encoded.outcome.features.push_back(std::move(feature.outcome));
  }
  if (encoded.outcome.verdict != Verdict::valid) encoded.document.features.clear();
  return encoded;
}

}  // namespace watertight::pipeline
