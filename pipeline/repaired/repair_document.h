// SPDX-License-Identifier: GPL-3.0-or-later
//
// Repairs the solids of a document, and puts the repaired ones into it.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "formats/document.h"
#include "repair/changes.h"

namespace watertight::pipeline {

/// What became of a solid that is not valid as it was read.
struct SolidRepair {
  SolidSource source;
  std::string feature;
  bool is_repaired = false;
  bool is_undecided = false;             // the verdict on the solid as it was read
  std::set<int> codes;                   // the errors of the solid as it was read
  std::vector<repair::Remedy> remedies;  // those that changed something
  repair::Changes changes;
  repair::Moves moves;
  std::vector<repair::HoleFill> holes;
};

struct DocumentRepair {
  std::uint64_t features = 0;
  std::uint64_t solids = 0;
  std::uint64_t valid_as_read = 0;
  std::vector<SolidRepair> repairs;  // in document order
};

/// Repairs the solids of a document on `threads` threads. Solids that are valid, and those that no
/// remedy mends, stay as they are, and so do the bytes of features without a repaired solid.
/// Errors: those of formats::replace_solids(). Cost: that of repair::repair().
Result<DocumentRepair> repair_document(Document& document, delaunay::EngineWorkers* workers,
                                       const repair::RepairOptions& options, unsigned threads);

}  // namespace watertight::pipeline
