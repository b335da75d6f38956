// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/indoor/cells.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "geometry/parallel.h"
#include "validate/indoor/indoor_model.h"

namespace watertight::pipeline {
namespace {

/// Adds what a report says that has no feature of its own.
void adopt(validate::GroupReport& report, validate::GroupReport& other) {
  report.verdict = worse(report.verdict, other.verdict);
  report.findings_omitted += other.findings_omitted;
  for (Finding& finding : other.findings) {
    finding.place.solid = kNone;
    report.findings.push_back(std::move(finding));
  }
  std::stable_sort(report.findings.begin(), report.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.code < b.code; });
  report.not_run.insert(report.not_run.end(), std::make_move_iterator(other.not_run.begin()),
                        std::make_move_iterator(other.not_run.end()));
}

}  // namespace

CellInspector::CellInspector(const Document& document, delaunay::EngineWorkers* workers,
                             const CertifyOptions& options, const validate::GroupOptions& groups,
                             std::size_t threads, const CancelPoll& is_cancelled)
    : cells_(document.graph.cells.size()) {
  std::vector<const Feature*> features;
  for (const Feature& feature : document.features) {
    if (feature.cell < cells_.size()) features.push_back(&feature);
  }
  if (features.empty()) return;
  const auto must_stop = [&] { return is_cancelled && is_cancelled(); };
  geometry::for_each_piece(
      features.size(), static_cast<unsigned>(std::clamp<std::size_t>(threads, 1, 256)),
      [&](std::size_t i, bool) {
        InspectedCell& cell = cells_[features[i]->cell];
        for (const SubmittedSolid& solid : features[i]->solids) {
          if (must_stop()) return;
          cell.inspections.push_back(certify(solid.solid, workers, options_for(solid, options)));
        }
        cell.is_ready = true;
      });
  const bool are_ready = std::all_of(features.begin(), features.end(), [&](const Feature* feature) {
    return cells_[feature->cell].is_ready;
  });
  if (!are_ready) return;
  std::vector<validate::CellSolids> solids(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    for (const Inspection& inspection : cells_[i].inspections) {
      solids[i].push_back(inspection.certified ? &inspection.certified->solid : nullptr);
    }
  }
  auto reports =
      validate::check_indoor_model(document.graph, solids, group_options(groups, options));
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (!solids[i].empty()) cells_[i].report = std::move(reports[i]);
  }
  validate::GroupReport& first = cells_[features.front()->cell].report;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    if (i == cells_.size() || solids[i].empty()) adopt(first, reports[i]);
  }
}

InspectedCell CellInspector::take(const Feature& feature) {
  if (feature.cell >= cells_.size()) return {};
  return std::exchange(cells_[feature.cell], {});
}

}  // namespace watertight::pipeline
