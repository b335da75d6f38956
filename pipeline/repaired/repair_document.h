// SPDX-License-Identifier: GPL-3.0-or-later
//
// Repairs the solids of a document, and puts the repaired ones into it.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "formats/document.h"
#include "repair/summary.h"

namespace watertight::pipeline {

/// What became of a solid that is not valid as it was read.
struct SolidRepair {
  SolidSource source;
  std::string feature;
  repair::RepairSummary summary;

  bool is_repaired() const { return summary.outcome == repair::Repaired::Outcome::repaired; }
};

struct DocumentRepair {
  std::uint64_t features = 0;
  std::uint64_t solids = 0;
  std::uint64_t valid_as_read = 0;
  std::vector<SolidRepair> repairs;  // in document order

  bool is_all_valid() const { return std::ranges::all_of(repairs, &SolidRepair::is_repaired); }
};

/// Repairs the solids of a document on `threads` threads. Solids that are valid, and those that no
/// remedy mends, stay as they are, and so do the bytes of features without a repaired solid.
/// Errors: those of formats::replace_solids(). Cost: that of repair::repair().
Result<DocumentRepair> repair_document(Document& document, delaunay::EngineWorkers* workers,
                                       const repair::RepairOptions& options, unsigned threads);

/// The outcome as UTF-8 JSON (docs/report.md, "Repairs"). Deterministic.
std::string repair_report_json(const DocumentRepair& outcome);

}  // namespace watertight::pipeline
