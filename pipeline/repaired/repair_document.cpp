// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/repaired/repair_document.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "formats/city_json/city_json.h"
#include "geometry/parallel.h"

namespace watertight::pipeline {
namespace {

using repair::Repaired;

/// A solid of the document, by numbers.
struct SolidPlace {
  std::size_t feature = 0;
  std::size_t solid = 0;
};

}  // namespace

Result<DocumentRepair> repair_document(Document& document, delaunay::EngineWorkers* workers,
                                       const repair::RepairOptions& options, unsigned threads) {
  std::vector<SolidPlace> places;
  for (std::size_t feature = 0; feature < document.features.size(); ++feature) {
    for (std::size_t i = 0; i < document.features[feature].solids.size(); ++i) {
      places.push_back({feature, i});
    }
  }
  std::vector<std::optional<Repaired>> results(places.size());
  geometry::for_each_piece(places.size(), threads, [&](std::size_t i, bool) {
    const SubmittedSolid& submitted = document.features[places[i].feature].solids[places[i].solid];
    repair::RepairOptions own = options;
    own.certify.unclosed_rings = submitted.unclosed_rings;
    own.certify.unreadable = submitted.unreadable;
    Repaired repaired = repair::repair(submitted.solid, workers, own);
    if (repaired.outcome != Repaired::Outcome::valid_as_read) results[i] = std::move(repaired);
  });
  DocumentRepair outcome;
  outcome.features = document.features.size();
  outcome.solids = places.size();
  std::vector<std::vector<formats::SolidEdit>> edits(document.features.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!results[i]) {
      ++outcome.valid_as_read;
      continue;
    }
    const Feature& feature = document.features[places[i].feature];
    const SubmittedSolid& submitted = feature.solids[places[i].solid];
    SolidRepair repair{submitted.source, feature.id,
                       repair::summary_of(submitted.solid, *results[i])};
    if (repair.is_repaired()) {
      auto solid = repair::on_submitted_vertices(submitted.solid, *results[i]->edits);
      if (!solid) return std::move(solid).error();
      edits[places[i].feature].push_back(
          {places[i].solid, std::move(solid->solid), std::move(solid->facet_source)});
    }
    outcome.repairs.push_back(std::move(repair));
  }
  for (std::size_t i = 0; i < edits.size(); ++i) {
    if (edits[i].empty()) continue;
    const Status replaced = formats::replace_solids(document.features[i], std::move(edits[i]));
    if (!replaced) return replaced.error();
  }
  return outcome;
}

}  // namespace watertight::pipeline
