// SPDX-License-Identifier: GPL-3.0-or-later
//
// The families of models of mode `polygon`, in the order of its layout (mode.cpp).
#pragma once

#include <algorithm>
#include <cstdint>

namespace watertight::codec::polygon {

/// Families of decisions.
enum PolygonFamily : std::uint32_t {
  kRingSize,
  kDegree,
  kNewVertex,
  kOnLoop,
  kFollow,
  kMoreRings,
  kRingStart,
  kMoreShells,
  kHasCopies,
  kIsCopy,
  kVertical,
  kKnownColumn,
  kAcrossSign,
  kAlongSign,
  kKnownHeight,
  kPolygonFamilies
};

/// Families of numbers.
enum PolygonNumber : std::uint32_t {
  kLongRing,
  kLoopSteps,
  kGateSteps,
  kFirstPosition,
  kFirstOffset,
  kAcross,
  kAlong,
  kColumnRank,
  kPlaneResidual,
  kHeightResidual,
  kPolygonNumbers
};

/// A context of at most `count` values.
template <class Number>
constexpr std::uint32_t capped(Number value, std::uint32_t count) {
  return value < 0 ? 0U
                   : static_cast<std::uint32_t>(
                         std::min<std::uint64_t>(static_cast<std::uint64_t>(value), count - 1));
}

}  // namespace watertight::codec::polygon
