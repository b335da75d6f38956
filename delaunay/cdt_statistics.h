// SPDX-License-Identifier: GPL-3.0-or-later
//
// Counts the outcomes of solids on the CDT ladder by rung and by class of outcome. A plain value
// that callers fill solid by solid and add up over threads; for summaries of CLI, jobs and benches.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "delaunay/rung.h"

namespace watertight::delaunay {

inline constexpr std::size_t kRungs = 6;  // Rung::delaunay to Rung::tetgen

struct CdtStatistics {
  std::uint64_t solids = 0;    // the number of solids that climbed the ladder
  std::uint64_t accepted = 0;  // solids with an accepted certificate
  std::uint64_t refuted = 0;   // solids that the certificate shows to be invalid
  std::uint64_t undecided = 0;
  /// attempts[rung][RungOutcome]; a solid can have several attempts.
  std::array<std::array<std::uint64_t, kRungOutcomes>, kRungs> attempts{};
  double seconds = 0;         // wall-clock time of all attempts
  double cpu_seconds = 0;     // CPU time of the threads of the callers
  double worker_seconds = 0;  // CPU time of the worker processes
  double engine_seconds = 0;  // CPU time of the engines' own calls

  /// Counts one solid. Does not count a solid without attempts (an invalid solid, another proof).
  void add(std::span<const RungAttempt> attempts_of_solid);
  CdtStatistics& operator+=(const CdtStatistics& other);
  std::uint64_t count(Rung rung, RungOutcome outcome) const;
};

/// True if a refusal is a property of the solid (interior_disconnected, cavity_mismatch,
/// wrong_orientation), whatever the engine: the solid is invalid.
bool is_property_of_solid(CertificateRefusal refusal);

}  // namespace watertight::delaunay
