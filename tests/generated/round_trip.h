// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checks the properties that each mode must have for every solid. Used by the unit tests,
// bench/codec and the fuzzing harness.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "codec/blob.h"
#include "tests/generated/generated_solids.h"

namespace watertight::generated {

class RoundTrips {
 public:
  /// Checks a solid or a page made from `seed`; returns the number of solids. Every 16th seed makes
  /// a page; every 8th of the others is checked in all modes, the rest in automatic mode or in one
  /// other.
  std::uint64_t check_generated(std::uint64_t seed, Index largest);

  /// Checks a solid in every mode with and without source order, and that a blob without it does
  /// not depend on the order.
  void check_all_modes(const std::string& name, const OrientedBoundary& boundary,
                       const Acceptance& acceptance);

  /// For each outcome, how often it happened: encoded in a mode, or the reason for a refusal.
  const std::map<std::string, std::uint64_t>& counts() const { return counts_; }
  /// The solids that did not come back, whatever encode() reported about them.
  const std::vector<std::string>& failures() const { return failures_; }

 private:
  void check(const std::string& name, const OrientedBoundary& boundary,
             const Acceptance& acceptance, const EncodeOptions& options);
  void check_page(const std::string& name, std::span<const NamedBoundary> solids,
                  const Acceptance& acceptance, const EncodeOptions& options);
  bool note(const std::string& name, const Result<Bytes>& bytes, const EncodeOptions& options);
  void fail(const std::string& name, Mode mode, const std::string& what);

  std::map<std::string, std::uint64_t> counts_;
  std::vector<std::string> failures_;
};

}  // namespace watertight::generated
