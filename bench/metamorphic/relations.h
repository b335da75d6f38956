// SPDX-License-Identifier: GPL-3.0-or-later
//
// One seed of the metamorphic run: makes a solid, asks the validator about it and about the same
// solid written or placed differently, asks the oracles, and says what does not fit together.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "delaunay/ladder.h"
#include "geometry/solid.h"

namespace watertight {

struct RelationOptions {
  std::span<const Solid> real_solids;          // may be empty: all solids are generated then
  delaunay::EngineWorkers* workers = nullptr;  // null: no full ladder
  std::uint64_t ladder_every = 0;              // every so many seeds climb the full ladder; 0: none
  std::uint64_t nef_every = 0;                 // every so many seeds with cavities ask Nef; 0: none
};

struct SeedResult {
  std::string family;
  std::string outcome;                          // verdict and codes of the solid itself
  std::map<std::string, std::uint64_t> checks;  // relation -> times it was checked
  std::vector<std::string> disagreements;       // "relation: what one says / what the other says"
};

/// Deterministic in the seed but for time-outs of the engines. Thread-safe.
SeedResult examine_seed(std::uint64_t seed, const RelationOptions& options);

/// The solid of a seed, for looking at a disagreement.
Solid solid_of_seed(std::uint64_t seed, const RelationOptions& options);

}  // namespace watertight
