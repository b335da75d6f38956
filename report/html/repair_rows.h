// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of repaired solids in the HTML report. Internal to report/.
#pragma once

#include <string>

#include "pipeline/pipeline.h"
#include "report/tally.h"

namespace watertight::report {

/// Collects a row for each solid that was not valid as it was read, and keeps the first of them.
class RepairRows {
 public:
  void add(const pipeline::InspectedFeature& feature);
  /// The table with its heading; "" without rows. `count` is that of all rows.
  std::string html(const RepairCount& count) const;

 private:
  std::string rows_;
  std::uint64_t row_count_ = 0;
};

/// The remedies that were allowed, with the largest move of weld: "rings, weld (0.01 m)".
std::string remedies_text(const repair::RepairOptions& options);

}  // namespace watertight::report
