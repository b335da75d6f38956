// SPDX-License-Identifier: GPL-3.0-or-later
//
// Random numbers for tests and benches: equal seeds give equal numbers on every machine.
#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/point.h"

namespace watertight::test {

/// The generator SplitMix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }
  /// A number in [0, end), nearly uniform. Requires end > 0.
  std::uint64_t below(std::uint64_t end) { return next() % end; }
  /// A number in [low, high], which must not span all integers. Computed without signs, because
  /// high - low may overflow.
  std::int64_t between(std::int64_t low, std::int64_t high) {
    const auto first = static_cast<std::uint64_t>(low);
    return static_cast<std::int64_t>(first + below(static_cast<std::uint64_t>(high) - first + 1));
  }
  /// A whole number in [low, high], as a coordinate.
  double within(std::int64_t low, std::int64_t high) {
    return static_cast<double>(between(low, high));
  }

 private:
  std::uint64_t state_;
};

/// Shuffles values; the first `fixed` of them stay where they are.
template <class Values>
void shuffle(Values& values, Random& random, std::size_t fixed = 0) {
  for (std::size_t i = values.size(); i > fixed + 1; --i) {
    std::swap(values[i - 1], values[fixed + random.below(i - fixed)]);
  }
}

/// The numbers below `size`, shuffled except for the first `fixed`.
inline std::vector<Index> permutation(std::size_t size, Random& random, std::size_t fixed) {
  std::vector<Index> order(size);
  std::iota(order.begin(), order.end(), Index{0});
  shuffle(order, random, fixed);
  return order;
}

}  // namespace watertight::test
