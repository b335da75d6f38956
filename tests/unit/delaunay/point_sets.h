// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sets of integer points for the Delaunay tests and bench/delaunay, each made by a formula that
// docs/format.md states: the golden digests can be reproduced from it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/point.h"

namespace watertight::point_sets {

/// The generator of the formulas: s = 6364136223846793005 s + 1442695040888963407 mod 2^64, then
/// floor(s / 2^33) mod m.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}
  std::int64_t below(std::int64_t m) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::int64_t>(state_ >> 33) % m;
  }

 private:
  std::uint64_t state_;
};

/// The points of a formula, which has a kind of set and its parameters, e.g. "grid 3 3 3":
/// distinct, in lexicographic order. No points if there is no such kind.
std::vector<Point> make(const std::string& formula);

/// The formula of a number, in an endless sequence of all kinds; most of the sets are small.
std::string any_formula(std::uint64_t number);

/// The points in another order.
std::vector<Point> shuffled(std::vector<Point> points, std::uint64_t seed);

}  // namespace watertight::point_sets
