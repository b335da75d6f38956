// SPDX-License-Identifier: GPL-3.0-or-later
//
// The families and numbers of mode polygon, with the names, the order and the sizes of
// docs/format-polygon.md. Each call of code() lists the contexts of its family.
#pragma once

#include <cstdint>

#include "codec/entropy/model_layout.h"

namespace watertight::codec::polygon {

enum Family : std::uint32_t {
  kSize,
  kDegree,
  kNew,
  kOnLoop,
  kFollow,
  kMoreRings,
  kRingStart,
  kMoreShells,
  kHasCopies,
  kIsCopy,
  kUpright,
  kKnownColumn,
  kAcrossSign,
  kAlongSign,
  kKnownHeight,
};

enum Number : std::uint32_t {
  kLong,
  kLoopSteps,
  kGateSteps,
  kFirstPosition,
  kFirstOffset,
  kAcross,
  kAlong,
  kColumnRank,
  kPlaneResidual,
  kHeightResidual,
};

inline constexpr FamilyShape kFamilies[] = {
    {kSize, 4, {384, 64, 160, 128, 192}},
    {kDegree, 1, {24, 192, 144}},
    {kNew, 1, {216, 216, 108}},
    {kOnLoop, 1, {12}},
    {kFollow, 1, {8, 4}},
    {kMoreRings, 1, {9, 48}},
    {kRingStart, 1, {2}},
    {kMoreShells, 1, {4}},
    {kHasCopies, 1, {1}},
    {kIsCopy, 1, {1}},
    {kUpright, 3, {48, 54, 162, 72}},
    {kKnownColumn, 1, {63, 36, 24}},
    {kAcrossSign, 1, {112, 64}},
    {kAlongSign, 1, {112, 128, 224}},
    {kKnownHeight, 2, {48, 128, 36}},
};

inline constexpr NumberShape kNumbers[] = {
    {kLong, 1, {2}},
    {kLoopSteps, 1, {6, 12}},
    {kGateSteps, 1, {1}},
    {kFirstPosition, 1, {3}},
    {kFirstOffset, 1, {3}},
    {kAcross, 7, {56, 12, 32}},
    {kAlong, 7, {42, 32, 32}},
    {kColumnRank, 1, {21, 12}},
    {kPlaneResidual, 2, {12, 4, 16}},
    {kHeightResidual, 2, {32, 2}},
};

constexpr const FamilyShape& shape_of(Family family) { return kFamilies[family]; }
constexpr const NumberShape& shape_of(Number number) { return kNumbers[number]; }

}  // namespace watertight::codec::polygon
