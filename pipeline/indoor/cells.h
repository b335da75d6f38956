// SPDX-License-Identifier: GPL-3.0-or-later
//
// The cells of an indoor model, validated together before the features of their document, because
// each is a feature of its own. For validate_stream(), encode_document() and ingest().
#pragma once

#include <vector>

#include "base/cancel.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The results of one cell.
struct InspectedCell {
  bool is_ready = false;                // false: the work was cancelled before
  std::vector<Inspection> inspections;  // one for each solid of the cell's feature
  validate::GroupReport report;         // Place::solid is an index of these solids
};

/// Validates the cells of an indoor model and its graph (rules 701 to 704). Findings that name no
/// cell with solids are in the report of the first cell with solids. Memory: the results of all
/// cells, until they are taken.
class CellInspector {
 public:
  /// Requires a document with all its features. Does nothing for one without cells. Cost: that of
  /// certify() for each cell, on `threads` threads, and of validate::check_indoor_model().
  CellInspector(const Document& document, delaunay::EngineWorkers* workers,
                const CertifyOptions& options, const validate::GroupOptions& groups,
                std::size_t threads, const CancelPoll& is_cancelled = {});

  /// The results for a feature that is a cell; call it once for each. Not ready for others.
  /// Thread-safe for different cells.
  InspectedCell take(const Feature& feature);

 private:
  std::vector<InspectedCell> cells_;
};

}  // namespace watertight::pipeline
