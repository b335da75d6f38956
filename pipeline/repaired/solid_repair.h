// SPDX-License-Identifier: GPL-3.0-or-later
//
// What became of the solids of a document in a repair.
#pragma once

#include <string>

#include "formats/document.h"
#include "repair/summary.h"

namespace watertight::pipeline {

/// What became of a solid that is not valid as it was read.
struct SolidRepair {
  SolidSource source;
  std::string feature;
  repair::RepairSummary summary;

  bool is_repaired() const { return repair::is_repaired(summary); }
};

}  // namespace watertight::pipeline
