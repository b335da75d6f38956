// SPDX-License-Identifier: GPL-3.0-or-later
//
// The families of decisions of mode parallelogram, and how many values their contexts take.
#pragma once

#include <cstdint>

#include "codec/tip_prediction.h"

namespace watertight::parallelogram {

inline constexpr std::uint32_t kRooms = 32;
inline constexpr std::uint32_t kDegrees = 10;
inline constexpr std::uint32_t kAngles = 16;
inline constexpr std::uint32_t kRatios = 12;
inline constexpr std::uint32_t kCosines = 8;
inline constexpr std::uint32_t kSpans = TipPrediction::kSpanClasses;
inline constexpr std::uint32_t kErrors = 16;
inline constexpr std::uint32_t kSpreads = 8;
inline constexpr std::uint32_t kPatterns = 16;
inline constexpr std::uint32_t kParts = 4;
inline constexpr std::uint32_t kMisses = 6;
inline constexpr std::uint32_t kGuesses = TipPrediction::kGuesses;
inline constexpr std::uint32_t kDistances = 8;

enum Family : std::uint32_t {
  kHasRepeats,
  kMore,
  kNewShell,
  kClose,
  kNew,
  kRepeat,
  kWhich,
  kPlaces,
  kHasGuesses,
  kGuess,
  kFamilyCount
};
enum Number : std::uint32_t { kOrigin, kSeed, kResidual, kRank, kPlace, kNumberCount };

}  // namespace watertight::parallelogram
