// SPDX-License-Identifier: GPL-3.0-or-later
//
// The properties that a mode must keep of every solid. For the unit test's slice, bench/codec and
// the fuzzing harness.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "codec/blob.h"
#include "tests/generated/generated_solids.h"

namespace watertight::generated {

class RoundTrips {
 public:
  /// A solid or a page made from `seed`; returns how many solids. Every 16th seed makes a page;
  /// of the others every 8th is tried in all modes, the rest in automatic mode or one other.
  std::uint64_t check_generated(std::uint64_t seed, Index largest);

  /// In every mode with and without order, and that the order leaves no trace in the latter.
  void check_all_modes(const std::string& name, const OrientedBoundary& boundary,
                       const Acceptance& acceptance);

  /// How often what happened: encoded in a mode, or why not.
  const std::map<std::string, std::uint64_t>& counts() const { return counts_; }
  /// Solids that did not come back, whatever encode() said about them.
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
