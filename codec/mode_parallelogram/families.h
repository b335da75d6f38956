// SPDX-License-Identifier: GPL-3.0-or-later
//
// The families of decisions of mode parallelogram, and how many values their contexts take.
#pragma once

#include <array>
#include <cstdint>

#include "codec/mode_parallelogram/tip_prediction.h"

namespace watertight::codec::parallelogram {

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

/// How many values the contexts of Close take.
inline constexpr std::array<std::uint32_t, 18> kCloseSizes{kAngles * kRatios,
                                                           kCosines* kCosines * 16,
                                                           kDegrees* kDegrees* kDegrees,
                                                           14 * kDegrees* kDegrees,
                                                           kRooms* kRatios,
                                                           32 * kRooms,
                                                           32 * kDegrees,
                                                           24 * 24,
                                                           16 * 16,
                                                           16 * kAngles * 16,
                                                           16 * 16,
                                                           20 * 16,
                                                           20 * 20,
                                                           20 * 20,
                                                           16 * 16,
                                                           14 * 14,
                                                           12 * 12 * 12,
                                                           256};
using CloseContexts = std::array<std::uint32_t, kCloseSizes.size()>;

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

}  // namespace watertight::codec::parallelogram
