// SPDX-License-Identifier: GPL-3.0-or-later
//
// One seed of the metamorphic run: makes a solid, validates it and the same solid written or placed
// differently, asks the oracles, and reports contradictions.
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
  std::span<const Solid> real_solids;          // if empty, all solids are generated
  delaunay::EngineWorkers* workers = nullptr;  // if null, the full ladder is left out
  std::uint64_t ladder_every = 0;  // the interval of seeds that climb the full ladder; 0: none
  std::uint64_t nef_every = 0;     // the interval of seeds with cavities that ask Nef; 0: none
};

struct SeedResult {
  std::string family;
  std::string outcome;                          // the verdict and the codes of the solid itself
  std::map<std::string, std::uint64_t> checks;  // for each relation, how often it was checked
  std::vector<std::string> disagreements;  // each as "relation: one verdict / the other verdict"
};

/// Examines a seed. The result depends on the seed only, except for time-outs of the engines.
/// Thread-safe.
SeedResult examine_seed(std::uint64_t seed, const RelationOptions& options);

/// The solid of a seed, to look at a disagreement.
Solid solid_of_seed(std::uint64_t seed, const RelationOptions& options);

}  // namespace watertight
