// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of curved solids in the HTML report: what tessellation made of them. Internal to
// report/.
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/pipeline.h"

namespace watertight::report {

/// Collects a row for each curved solid, and keeps the first of them.
class CurvedRows {
 public:
  void add(const pipeline::InspectedFeature& feature);
  /// The table with its heading; "" without rows.
  std::string html() const;

 private:
  std::string rows_;
  std::uint64_t count_ = 0;
  std::uint64_t left_out_ = 0;  // faces
};

}  // namespace watertight::report
