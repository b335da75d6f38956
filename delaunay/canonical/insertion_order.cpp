// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/canonical/insertion_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace watertight::delaunay {
namespace {

/// The logarithm (base 2) of the most cells of the curve's grid along an axis: the bits of three
/// axes and of a round fit into the upper half of a key.
constexpr unsigned kMostBits = 9;
constexpr unsigned kRoundBits = 5;
/// Point sets up to this size are inserted in one round.
constexpr std::size_t kOneRound = 64;

/// The number of a cell along a Hilbert curve through a grid of 2^bits cells per axis. Source:
/// Skilling, "Programming the Hilbert curve" (2004).
std::uint32_t hilbert_place(std::array<std::uint32_t, 3> cell, unsigned bits) {
  auto& [x, y, z] = cell;
  for (std::uint32_t bit = 1U << (bits - 1); bit > 1; bit >>= 1) {
    const std::uint32_t lower = bit - 1;
    for (std::uint32_t& axis : cell) {
      if ((axis & bit) != 0) {
        x ^= lower;
      } else {
        const std::uint32_t exchanged = (x ^ axis) & lower;
        x ^= exchanged;
        axis ^= exchanged;
      }
    }
  }
  y ^= x;
  z ^= y;
  std::uint32_t flipped = 0;
  for (std::uint32_t bit = 1U << (bits - 1); bit > 1; bit >>= 1) {
    if ((z & bit) != 0) flipped ^= bit - 1;
  }
  std::uint32_t place = 0;
  for (unsigned i = bits; i-- > 0;) {
    for (const std::uint32_t axis : cell) place = 2 * place + (((axis ^ flipped) >> i) & 1);
  }
  return place;
}

/// The number of rounds after the round of a point: 0 for seven points of eight, 1 for seven
/// eighths of the rest, and so on.
std::uint64_t rounds_before_last(std::uint64_t index) {
  const std::uint64_t mixed = (index + 1) * 0x9E3779B97F4A7C15U;
  return static_cast<std::uint64_t>(std::countl_zero(mixed ^ (mixed << 32)) / 3);
}

}  // namespace

std::vector<Index> insertion_order(std::span<const Point> points) {
  double largest = 1;
  for (const Point& p : points) largest = std::max({largest, p.x, p.y, p.z});
  const auto coordinate_bits =
      static_cast<unsigned>(std::bit_width(static_cast<std::uint32_t>(largest)));
  const unsigned bits = std::min(kMostBits, coordinate_bits);
  const unsigned shift = coordinate_bits - bits;
  const auto cell = [shift](double c) { return static_cast<std::uint32_t>(c) >> shift; };
  std::vector<std::uint64_t> keys;
  keys.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [x, y, z] = points[i];
    const std::uint64_t round = points.size() <= kOneRound ? 0 : rounds_before_last(i);
    const std::uint64_t place = hilbert_place({cell(x), cell(y), cell(z)}, bits);
    const std::uint64_t first = (std::uint64_t{1} << kRoundBits) - 1 - round;
    keys.push_back((first << (3 * kMostBits) | place) << 32 | i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order;
  order.reserve(points.size());
  for (const std::uint64_t key : keys) order.push_back(static_cast<Index>(key));
  return order;
}

}  // namespace watertight::delaunay
