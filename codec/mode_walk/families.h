// SPDX-License-Identifier: GPL-3.0-or-later
//
// The families and numbers of mode walk, with the names, the order and the sizes of
// docs/format-walk.md. Each call of code() lists the contexts of its family.
#pragma once

#include <cstdint>

#include "codec/entropy/model_layout.h"

namespace watertight::codec::walk {

enum Family : std::uint32_t {
  // The walk.
  kCandidate,
  kDistant,
  kRare,
  kSeed,
  kChoice,
  // Facets.
  kInterior,
  kExterior,
  // Columns.
  kPlace,
  kHeight,
  kTopBits,
};

/// The numbers of mode walk. Only the columns have numbers.
enum Number : std::uint32_t { kPosition, kSize, kGap, kResidual, kRank, kFloors };

inline constexpr FamilyShape kFamilies[] = {
    {kCandidate, 18, {504, 756, 1920, 630, 432, 1260, 3960, 1920}},
    {kDistant, 18, {504, 756, 1920, 630, 432, 1260, 3960, 1920}},
    {kRare, 1, {7}},
    {kSeed, 1, {84}},
    {kChoice, 4, {768, 1024, 768}},
    {kInterior, 9, {16128, 162, 126, 567, 432, 288}},
    {kExterior, 1, {3}},
    {kPlace, 1, {80}},
    {kHeight, 1, {96, 48, 128}},
    {kTopBits, 1, {24, 744}},
};

inline constexpr NumberShape kNumbers[] = {
    {kPosition, 1, {6}},  {kSize, 1, {6, 186}}, {kGap, 1, {31}},
    {kResidual, 2, {16}}, {kRank, 1, {16}},     {kFloors, 1, {6}},
};

constexpr const FamilyShape& shape_of(Family family) { return kFamilies[family]; }
constexpr const NumberShape& shape_of(Number number) { return kNumbers[number]; }

}  // namespace watertight::codec::walk
