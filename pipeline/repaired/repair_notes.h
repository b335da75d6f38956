// SPDX-License-Identifier: GPL-3.0-or-later
//
// What became of the solids of a document in a repair, for the report on the repaired document.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// Finds solids by object, geometry and number in it; these are the same in the document as it was
/// read and as it is written. Keeps references to `repairs`.
class RepairNotes {
 public:
  explicit RepairNotes(std::span<const SolidRepair> repairs);

  /// Adds to the solids of a feature of the repaired document what became of them. Cost: O(log n)
  /// for each solid.
  void add_to(InspectedFeature& feature) const;

 private:
  struct SolidKey {
    std::string object_id;
    std::uint32_t geometry = 0;
    std::uint32_t ordinal = 0;
    auto operator<=>(const SolidKey&) const = default;
  };
  static SolidKey key_of(const SolidSource& source, const std::string& feature);
  std::map<SolidKey, const repair::RepairSummary*> summaries_;
};

/// What was done to a solid, or what is wrong with it: "repaired: fill (1 facet of 80.000 m2
/// added)".
std::string account_of(const repair::RepairSummary& summary);

}  // namespace watertight::pipeline
