// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/rows/place.h"

#include <algorithm>
#include <cmath>

namespace watertight::store {
namespace {

constexpr double kHalf = 1073741824;               // 2^30, half the number of cells on an axis
constexpr std::uint64_t kLastCell = 2147483647;    // 2^31 - 1
constexpr double kCellsPerDegree = 1048576 * 2.0;  // 2^21
constexpr double kLargestDegree = 360;

std::uint64_t cell_number(double low, double high, double cells_per_unit) {
  const double bound = 2 * kHalf;  // a limit that keeps the sum finite
  const double twice_centre = std::clamp(low, -bound, bound) + std::clamp(high, -bound, bound);
  const double cell = std::floor(twice_centre * (cells_per_unit / 2));
  return static_cast<std::uint64_t>(std::clamp(cell, -kHalf, kHalf - 1) + kHalf);
}

bool may_be_degrees(const StoredBox& box) {
  double largest = 0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    largest = std::max({largest, std::abs(box.min[axis]), std::abs(box.max[axis])});
  }
  return largest <= kLargestDegree;
}

/// The number of a cell along the Hilbert curve: two bits for each halving of the square.
std::int64_t hilbert_number(std::uint64_t x, std::uint64_t y) {
  std::uint64_t number = 0;
  for (std::uint64_t half = (kLastCell + 1) / 2; half > 0; half /= 2) {
    const bool is_right = (x & half) != 0;
    const bool is_upper = (y & half) != 0;
    number = number * 4 + ((is_right ? 3U : 0U) ^ (is_upper ? 1U : 0U));
    if (is_upper) continue;
    if (is_right) {
      x = kLastCell - x;
      y = kLastCell - y;
    }
    std::swap(x, y);
  }
  return static_cast<std::int64_t>(number);
}

}  // namespace

std::int64_t place_number(const std::optional<StoredBox>& box) {
  if (!box) return kNoPlace;
  const double cells_per_unit = may_be_degrees(*box) ? kCellsPerDegree : 2;
  return hilbert_number(cell_number(box->min[0], box->max[0], cells_per_unit),
                        cell_number(box->min[1], box->max[1], cells_per_unit));
}

}  // namespace watertight::store
