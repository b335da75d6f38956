// SPDX-License-Identifier: GPL-3.0-or-later
//
// Asks the product about samples, in variants that must not change the verdict, and compares its
// answers with the truth.
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
  allowed,  // undecided at extreme sizes, or where edges of two shells cross outside of vertices
  false_valid,
  false_invalid,
  wrong_code,
  undecided,
  varies,  // the canonical surface is valid in one mirror image and not in another
};
inline constexpr std::size_t kOutcomes = 7;
const char* to_string(Outcome outcome);

/// The product's answer about a sample.
struct Said {
  Verdict verdict = Verdict::undecided;
  std::set<int> codes;  // the codes of the errors
  std::string reason;   // the reason of an undecided verdict
};
std::string to_string(const Said& said);

/// One question about a sample, and how the answer agrees with the truth.
struct Judgement {
  std::string variant;
  Outcome outcome = Outcome::right;
  Truth truth;
  Said said;
  Sample sample;  // the sample as asked; kept for disagreements only
};

struct JudgeOptions {
  delaunay::EngineWorkers* workers = nullptr;  // if null, no engines are used
  bool with_variants = false;  // also mirrored, renumbered, strict, and by the exact tests alone
  bool with_engines = false;   // also by each engine alone
};

/// Asks all questions about a sample. `seed` chooses the renumbering. Thread-safe.
std::vector<Judgement> judge(const Sample& sample, std::uint64_t seed, const JudgeOptions& options);

/// A sample as a CityJSON text, or as WKT if its coordinates are no integers on a decimal grid.
struct WrittenSample {
  std::string text;
  const char* ending = ".city.json";
};
WrittenSample written(const Sample& sample);

}  // namespace watertight::verdict
