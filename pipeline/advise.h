// SPDX-License-Identifier: GPL-3.0-or-later
//
// Advice about decimals: how far the coordinates of solids can be rounded before one breaks.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The solids with coordinates rounded to some decimals.
struct RoundedSolids {
  int decimals = 0;         // 3: millimetres, for coordinates in metres; negative: tens and more
  std::uint64_t valid = 0;  // of the solids that are valid as they are
  std::uint64_t broken = 0;
  std::uint64_t blob_bytes = 0;  // of the valid ones
  /// The first in the document that breaks, and the first error of it; absent while none does.
  std::optional<std::pair<SolidSource, int>> first_broken;
};

struct Advice {
  std::uint64_t solids = 0;    // all that were looked at
  std::uint64_t valid = 0;     // those that are valid as they are; only these are rounded
  std::uint64_t off_grid = 0;  // valid ones whose coordinates are on no decimal grid, not rounded
  std::vector<RoundedSolids> levels;  // from the decimals as they are to fewer ones
};

struct AdviceOptions {
  CertifyOptions certify;
  std::size_t threads = 1;
  int fewest = 0;  // the last number of decimals that is tried
};

/// Rounds the valid solids to fewer and fewer decimals, half away from zero, and validates them
/// each time; ends after the first number of decimals at which none is left, or at
/// options.fewest. Equal input gives equal advice. Errors: cancelled; those of encode(). Cost: that
/// of validating and encoding the solids for each number of decimals.
Result<Advice> advise(std::span<const SubmittedSolid> solids, delaunay::EngineWorkers* workers,
                      const AdviceOptions& options);

}  // namespace watertight::pipeline
