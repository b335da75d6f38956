// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <mutex>
#include <optional>
#include <set>

#include "formats/city_json/city_json.h"
#include "geometry/parallel.h"
#include "pipeline/groups.h"
#include "pipeline/instances.h"
#include "pipeline/pipeline.h"
#include "validate/report_json.h"

namespace watertight::pipeline {
namespace {

constexpr std::size_t kVertexBytes = 24;  // three doubles
constexpr std::size_t kCornerBytes = 4;   // one index

std::size_t plain_bytes(const Solid& solid) {
  return solid.vertex_count() * kVertexBytes + solid.arrays().ring_vertices.size() * kCornerBytes;
}

bool is_cancelled(const IngestOptions& options) {
  return options.is_cancelled && options.is_cancelled();
}

Error cancelled() {
  return Error{ErrorCode::cancelled, "stopped before all features were validated"};
}

/// A feature that was validated, and encoded if it is valid.
struct Processed {
  FeatureOutcome outcome;
  std::optional<EncodedFeature> encoded;
  std::optional<Error> error;
};

Processed process(Feature feature, const Document& document, delaunay::EngineWorkers* workers,
                  const IngestOptions& options, TemplateInspector& templates) {
  Processed processed;
  InspectedFeature inspected =
      inspect(std::move(feature), workers, options.certify, options.groups, &templates);
  processed.outcome.id = inspected.feature.id;
  processed.outcome.verdict = inspected.verdict();
  if (processed.outcome.verdict == Verdict::valid) {
    auto encoded = encode_feature(inspected, document, options);
    if (encoded) {
      processed.encoded = *std::move(encoded);
    } else {
      processed.error = std::move(encoded).error();
    }
  }
  for (std::size_t i = 0; i < inspected.solids.size(); ++i) {
    SolidOutcome outcome;
    outcome.source = std::move(inspected.solids[i].source);
    outcome.report = std::move(inspected.solids[i].inspection.report);
    validate::ReportJsonOptions json;
    json.pointer_prefix = outcome.source.pointer;
    json.include_times = false;
    outcome.report_json =
        validate::report_json(outcome.report, inspected.feature.solids[i].solid, json);
    outcome.source_bytes = plain_bytes(inspected.feature.solids[i].solid);
    if (processed.encoded) outcome.blob_bytes = processed.encoded->solids[i].blob.size();
    processed.outcome.solids.push_back(std::move(outcome));
  }
  processed.outcome.groups = std::move(inspected.groups);
  return processed;
}

Result<std::vector<Processed>> process_all(Document& document, delaunay::EngineWorkers* workers,
                                           const IngestOptions& options) {
  std::vector<Feature> features = std::move(document.features);
  std::vector<Processed> processed(features.size());
  TemplateInspector templates(document.templates, workers, options.certify,
                              group_options(options.groups, options.certify));
  std::size_t done = 0;
  std::mutex mutex;
  geometry::for_each_piece(
      features.size(), static_cast<unsigned>(options.threads), [&](std::size_t i, bool) {
        if (is_cancelled(options)) return;
        processed[i] = process(std::move(features[i]), document, workers, options, templates);
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(done, features.size());
      });
  if (done < features.size()) return cancelled();
  return processed;
}

IngestOutcome summarize(std::vector<Processed>& processed) {
  IngestOutcome outcome;
  for (Processed& feature : processed) {
    outcome.verdict = worse(outcome.verdict, feature.outcome.verdict);
    outcome.features.push_back(std::move(feature.outcome));
  }
  return outcome;
}

Status check_ids(const Document& document) {
  std::set<std::string_view> ids;
  for (const Feature& feature : document.features) {
    if (feature.id.empty()) return Error{ErrorCode::malformed, "a feature has no id"};
    if (!ids.insert(feature.id).second) {
      return Error{ErrorCode::malformed, "two features have the id '" + feature.id + "'"};
    }
  }
  return Done{};
}

/// Checks that the document and the collection have one CRS.
Status check_crs(const Document& document, SolidStore& store, const std::string& collection) {
  if (document.features.empty()) return Done{};
  auto existing = store.collection(collection);
  if (!existing && existing.error().code != ErrorCode::not_found) return existing.error();
  const std::uint32_t srid = existing ? existing->srid : document.features.front().srid;
  for (const Feature& feature : document.features) {
    if (feature.srid == srid) continue;
    return Error{ErrorCode::conflict, "feature '" + feature.id + "' is in CRS " +
                                          std::to_string(feature.srid) + ", the collection in " +
                                          std::to_string(srid)};
  }
  return Done{};
}

/// Reduces header and framing, which the features share, to what the contract promises.
Status reduce_to(formats::Contract contract, Document& document) {
  if (contract == formats::Contract::exact) return Done{};
  document.framing.clear();
  if (contract == formats::Contract::lattice || document.header.empty()) return Done{};
  auto header = formats::boundary_header(document.header);
  if (!header) return std::move(header).error();
  document.header = *std::move(header);
  return Done{};
}

/// Stores the encoded features. `outcome` has a feature per entry of `processed`.
Status store_all(std::vector<Processed>& processed, SolidStore& store, IngestOutcome& outcome) {
  std::vector<StoredFeature> features;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < processed.size(); ++i) {
    if (!processed[i].encoded) continue;
    auto packed = pack(*std::move(processed[i].encoded));
    if (!packed) return std::move(packed).error();
    features.push_back(*std::move(packed));
    places.push_back(i);
  }
  if (features.empty()) return Done{};
  auto versions = store.put(features);
  if (!versions) return std::move(versions).error();
  for (std::size_t i = 0; i < places.size() && i < versions->size(); ++i) {
    outcome.features[places[i]].is_stored = true;
    outcome.features[places[i]].version = (*versions)[i];
  }
  outcome.stored = places.size();
  return Done{};
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
  return own;
}

Result<EncodeOutcome> encode_document(Document document, delaunay::EngineWorkers* workers,
                                      const IngestOptions& options) {
  Status status = reduce_to(options.contract, document);
  if (!status) return std::move(status).error();
  auto processed = process_all(document, workers, options);
  if (!processed) return std::move(processed).error();
  EncodeOutcome encoded;
  encoded.document.format = std::string(formats::to_string(document.format));
  encoded.document.header = std::move(document.header);
  encoded.document.framing = std::move(document.framing);
  for (Processed& feature : *processed) {
    if (feature.error) return *std::move(feature.error);
    if (feature.encoded) encoded.document.features.push_back(*std::move(feature.encoded));
  }
  encoded.outcome = summarize(*processed);
  if (encoded.outcome.verdict != Verdict::valid) encoded.document.features.clear();
  return encoded;
}

Result<IngestOutcome> ingest(Document document, SolidStore& store, delaunay::EngineWorkers* workers,
                             const IngestOptions& options) {
  Status status = check_ids(document);
  if (status) status = check_crs(document, store, options.collection);
  if (status) status = reduce_to(options.contract, document);
  if (!status) return std::move(status).error();
  auto processed = process_all(document, workers, options);
  if (!processed) return std::move(processed).error();
  for (Processed& feature : *processed) {
    if (feature.error) return *std::move(feature.error);
  }
  IngestOutcome outcome = summarize(*processed);
  const bool stores =
      outcome.verdict == Verdict::valid || options.invalid_features == InvalidFeatures::skip;
  if (!stores || is_cancelled(options)) {
    if (stores) return cancelled();
    return outcome;
  }
  status = store_all(*processed, store, outcome);
  if (!status) return std::move(status).error();
  return outcome;
}

}  // namespace watertight::pipeline
