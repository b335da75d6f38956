// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/spline/grid_with_hole.h"

#include <catch2/catch_test_macros.hpp>

namespace watertight::samples {

GridWithHole::GridWithHole(int degree, std::uint64_t seed) {
  constexpr int kSize = 4;
  arrays.degree = degree;
  // The vertex in the middle of the hole comes last, so that all others have their knots before it.
  std::vector<Index> numbers;
  for (int y = 0; y <= kSize; ++y) {
    for (int x = 0; x <= kSize; ++x) {
      const bool is_new = x == 2 && y == 2;
      numbers.push_back(is_new ? (kSize + 1) * (kSize + 1) - 1
                               : static_cast<Index>(arrays.vertices.size()));
      if (!is_new) arrays.vertices.push_back({static_cast<double>(x), static_cast<double>(y), 0});
    }
  }
  std::vector<Triangle> around;
  std::vector<Triangle> inside;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto at = [&](int dx, int dy) {
        return numbers[static_cast<std::size_t>((y + dy) * (kSize + 1) + x + dx)];
      };
      const bool is_hole = (x == 1 || x == 2) && (y == 1 || y == 2);
      auto& triangles = is_hole ? inside : around;
      triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
      triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  }
  spline::CloudOptions options;
  options.degree = degree;
  options.seed = seed;
  const auto old_clouds = spline::make_clouds(arrays.vertices, around, {}, {}, options);
  REQUIRE(old_clouds);
  arrays.vertices.push_back({2, 2, 0});
  arrays.triangles = around;
  arrays.triangles.insert(arrays.triangles.end(), inside.begin(), inside.end());
  const auto clouds =
      spline::make_clouds(arrays.vertices, arrays.triangles, *old_clouds, {}, options);
  REQUIRE(clouds);
  arrays.clouds = *clouds;
  for (Index t = 0; t < arrays.triangles.size(); ++t) (t < around.size() ? old : hole).push_back(t);
}

}  // namespace watertight::samples
