// SPDX-License-Identifier: GPL-3.0-or-later
//
// Asks the product about samples, in variants that must not change the verdict, and compares what
// it says with the truth.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/verdict/families.h"
#include "delaunay/ladder.h"
#include "validate/certify.h"

namespace watertight::verdict {

enum class Outcome : std::uint8_t {
  right,
  allowed,  // undecided at extreme sizes, or where edges of shells cross in no vertex
  false_valid,
  false_invalid,
  wrong_code,
  undecided,
  varies,  // the canonical surface itself is valid in one mirror image and not in another
};
inline constexpr std::size_t kOutcomes = 7;
const char* to_string(Outcome outcome);

/// The product's verdict.
struct Said {
  Verdict verdict = Verdict::undecided;
  std::set<int> codes;  // of error findings
  std::string reason;   // when undecided
};
std::string to_string(const Said& said);

/// One question about a sample and what became of it.
struct Judgement {
  std::string variant;
  Outcome outcome = Outcome::right;
  Truth truth;
  Said said;
  Sample sample;  // as asked; kept for disagreements only
};

struct JudgeOptions {
  delaunay::EngineWorkers* workers = nullptr;  // null: no engines
  bool with_variants = false;                  // mirrored, renumbered, strict, by exact tests alone
  bool with_engines = false;                   // by each engine alone
};

/// All questions about a sample. `seed` chooses the numbering. Thread-safe.
std::vector<Judgement> judge(const Sample& sample, std::uint64_t seed, const JudgeOptions& options);

/// The sample as a CityJSON text, or as WKT where its coordinates are no integers on a decimal
/// grid.
struct WrittenSample {
  std::string text;
  const char* ending = ".city.json";
};
WrittenSample written(const Sample& sample);

}  // namespace watertight::verdict
