// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/repaired/repair_document.h"

#include <optional>
#include <span>
#include <utility>

#include "formats/city_json/city_json.h"
#include "geometry/parallel.h"
#include "repair/summary_json.h"

namespace watertight::pipeline {
namespace {

using repair::Repaired;

/// Repairs a solid; nothing if it is valid as it was read.
std::optional<Repaired> repaired(const SubmittedSolid& submitted, delaunay::EngineWorkers* workers,
                                 const repair::RepairOptions& options) {
  repair::RepairOptions own = options;
  own.certify.unclosed_rings = submitted.unclosed_rings;
  own.certify.unreadable = submitted.unreadable;
  Repaired result = repair::repair(submitted.solid, workers, own);
  if (result.outcome == Repaired::Outcome::valid_as_read) return std::nullopt;
  return result;
}

/// Puts repaired solids into their feature, and appends what became of each that is not valid.
/// `results` has an entry for each solid of the feature.
Status apply(Feature& feature, std::span<const std::optional<Repaired>> results,
             std::vector<SolidRepair>& repairs) {
  std::vector<formats::SolidEdit> edits;
  std::vector<std::pair<std::size_t, std::string>> texts;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results[i]) continue;
    const SubmittedSolid& submitted = feature.solids[i];
    repairs.push_back(
        {submitted.source, feature.id, repair::summary_of(submitted.solid, *results[i])});
    if (!results[i]->edits) continue;
    auto solid = repair::on_submitted_vertices(submitted.solid, *results[i]->edits);
    if (!solid) return std::move(solid).error();
    edits.push_back({i, std::move(solid->solid), std::move(solid->facet_source)});
    texts.emplace_back(i, repair::summary_json(repairs.back().summary));
  }
  if (edits.empty()) return Done{};
  if (const Status replaced = formats::replace_solids(feature, std::move(edits)); !replaced) {
    return replaced;
  }
  for (const auto& [solid, text] : texts) feature.solids[solid].repair = text;
  return Done{};
}

}  // namespace

Result<std::vector<SolidRepair>> repair_feature(Feature& feature, delaunay::EngineWorkers* workers,
                                                const repair::RepairOptions& options) {
  std::vector<std::optional<Repaired>> results;
  for (const SubmittedSolid& submitted : feature.solids) {
    results.push_back(repaired(submitted, workers, options));
  }
  std::vector<SolidRepair> repairs;
  if (const Status applied = apply(feature, results, repairs); !applied) return applied.error();
  return repairs;
}

Result<DocumentRepair> repair_document(Document& document, delaunay::EngineWorkers* workers,
                                       const repair::RepairOptions& options, unsigned threads) {
  std::vector<const SubmittedSolid*> solids;
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& submitted : feature.solids) solids.push_back(&submitted);
  }
  std::vector<std::optional<Repaired>> results(solids.size());
  geometry::for_each_piece(solids.size(), threads, [&](std::size_t i, bool) {
    results[i] = repaired(*solids[i], workers, options);
  });
  DocumentRepair outcome;
  outcome.features = document.features.size();
  outcome.solids = solids.size();
  std::size_t begin = 0;
  for (Feature& feature : document.features) {
    const auto own = std::span(results).subspan(begin, feature.solids.size());
    begin += own.size();
    const Status applied = apply(feature, own, outcome.repairs);
    if (!applied) return applied.error();
  }
  outcome.valid_as_read = outcome.solids - outcome.repairs.size();
  return outcome;
}

}  // namespace watertight::pipeline
