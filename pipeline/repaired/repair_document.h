// SPDX-License-Identifier: GPL-3.0-or-later
//
// Repairs the solids of a document, and puts the repaired ones into it.
#pragma once

#include <algorithm>
#include <vector>

#include "pipeline/repaired/solid_repair.h"

namespace watertight::pipeline {

struct DocumentRepair {
  std::uint64_t features = 0;
  std::uint64_t solids = 0;
  std::uint64_t valid_as_read = 0;
  std::vector<SolidRepair> repairs;  // in document order

  bool is_all_valid() const { return std::ranges::all_of(repairs, &SolidRepair::is_repaired); }
};

/// Repairs the solids of a feature, one after the other. Solids that are valid, and those that no
/// remedy mends, stay as they are; without a repair so does the feature. Returns what became of the
/// solids that are not valid. Errors and cost: those of repair_document().
Result<std::vector<SolidRepair>> repair_feature(Feature& feature, delaunay::EngineWorkers* workers,
                                                const repair::RepairOptions& options);

/// Repairs the solids of a document on `threads` threads. Solids that are valid, and those that no
/// remedy mends, stay as they are, and so do the bytes of features without a repaired solid.
/// Errors: those of formats::replace_solids(). Cost: that of repair::repair().
Result<DocumentRepair> repair_document(Document& document, delaunay::EngineWorkers* workers,
                                       const repair::RepairOptions& options, unsigned threads);

/// A document after its repair.
struct RepairedText {
  Document document;
  DocumentRepair outcome;
};

/// Reads a document that is to be written as `to`, and repairs it as repair_document() does. GML
/// that is to be written as GML is changed as a text (formats/gml/edits/edit_gml.h): the document
/// has notes about repaired solids that its text cannot have; these count as not repaired. Errors:
/// those of read_to_convert(), repair_document() and edit_gml(). Cost: that of reading, for GML of
/// reading four times, and of repair::repair().
Result<RepairedText> repair_text(ByteView text, Format from, Format to,
                                 formats::ReadOptions reading, delaunay::EngineWorkers* workers,
                                 const repair::RepairOptions& options, unsigned threads);

}  // namespace watertight::pipeline
