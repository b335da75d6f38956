// SPDX-License-Identifier: GPL-3.0-or-later
//
// Angles as whole numbers, computed by + - * / and square roots alone, so that every machine finds
// the same ones.
#pragma once

#include <algorithm>
#include <cstdint>

namespace watertight::fill {

/// An angle as a fraction of a full turn in units of 2^-32 turns; sums wrap around.
using Turn = std::uint32_t;
inline constexpr Turn kHalfTurn = Turn{1} << 31U;

/// The angle from the direction (1, 0) to (x, y), counter-clockwise; 0 for (0, 0). Requires finite
/// numbers. Error: at most 1 unit. Cost: one division.
Turn turn_to(double x, double y);

/// The smaller of the two angles between directions, at most kHalfTurn.
inline Turn turn_between(Turn a, Turn b) { return std::min<Turn>(a - b, b - a); }

/// An angle, or a sum of angles, in radians.
inline double radians(std::uint64_t turns) {
  constexpr double kTwoPi = 6.283185307179586;
  constexpr double kFullTurn = 4294967296.0;
  return static_cast<double>(turns) * (kTwoPi / kFullTurn);
}

}  // namespace watertight::fill
