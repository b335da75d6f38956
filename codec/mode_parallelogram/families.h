// SPDX-License-Identifier: GPL-3.0-or-later
//
// The families and numbers of mode parallelogram, with the names, the order and the sizes of
// docs/format-parallelogram.md. Each call of code() lists the contexts of its family.
#pragma once

#include <cstdint>

#include "codec/entropy/model_layout.h"

namespace watertight::codec::parallelogram {

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
};

enum Number : std::uint32_t { kOrigin, kSeed, kResidual, kRank, kPlace };

inline constexpr FamilyShape kFamilies[] = {
    {kHasRepeats, 1, {1}},
    {kMore, 1, {2}},
    {kNewShell, 1, {1}},
    {kClose,
     3,
     {192, 1024, 1000, 1400, 384, 1024, 320, 576, 256, 4096, 256, 320, 400, 400, 256, 196, 1728,
      256}},
    {kNew, 1, {32, 32, 64, 512}},
    {kRepeat, 3, {192, 96, 384, 112}},
    {kWhich, 5, {80, 120}},
    {kPlaces, 1, {6}},
    {kHasGuesses, 1, {1}},
    {kGuess, 5, {216, 216, 216, 96, 96, 384}},
};

inline constexpr NumberShape kNumbers[] = {
    {kOrigin, 1, {2, 64}}, {kSeed, 1, {3, 64}},    {kResidual, 6, {192, 288, 528, 768, 768, 16}},
    {kRank, 1, {1}},       {kPlace, 2, {32, 256}},
};

constexpr const FamilyShape& shape_of(Family family) { return kFamilies[family]; }
constexpr const NumberShape& shape_of(Number number) { return kNumbers[number]; }

}  // namespace watertight::codec::parallelogram
