// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/angles.h"

#include <cmath>

namespace watertight::fill {
namespace {

constexpr double kFullTurn = 4294967296.0;
constexpr double kTurnsPerRadian = kFullTurn / 6.283185307179586;
constexpr double kTan1 = 0.198912367379658;    // tan(pi / 16)
constexpr double kTan2 = 0.41421356237309503;  // tan(pi / 8)
constexpr double kTan3 = 0.6681786379192989;   // tan(3 pi / 16)

/// The arctangent of |z| <= tan(pi / 16), by its series: what is left out is below 1e-13.
double small_arctangent(double z) {
  const double s = z * z;
  const double series =
      1.0 + s * (-1.0 / 3 +
                 s * (1.0 / 5 +
                      s * (-1.0 / 7 + s * (1.0 / 9 + s * (-1.0 / 11 + s * (1.0 / 13 - s / 15))))));
  return z * series;
}

/// The angle to (x, y) in units of 2^-32 turns, for 0 <= y <= x.
double first_octant(double x, double y) {
  constexpr double kSixteenth = kFullTurn / 16;
  if (y <= kTan1 * x) return small_arctangent(y / x) * kTurnsPerRadian;
  if (y <= kTan3 * x) {
    return kSixteenth + small_arctangent((y - kTan2 * x) / (x + kTan2 * y)) * kTurnsPerRadian;
  }
  return 2 * kSixteenth + small_arctangent((y - x) / (x + y)) * kTurnsPerRadian;
}

}  // namespace

Turn turn_to(double x, double y) {
  const double across = std::abs(x);
  const double up = std::abs(y);
  if (across == 0 && up == 0) return 0;
  double turns = up <= across ? first_octant(across, up) : kFullTurn / 4 - first_octant(up, across);
  if (x < 0) turns = kFullTurn / 2 - turns;
  if (y < 0) turns = -turns;
  return static_cast<Turn>(static_cast<std::int64_t>(std::floor(turns + 0.5)));
}

}  // namespace watertight::fill
