// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "geometry/solid.h"

namespace watertight::test {

using Ring = std::vector<Point>;

/// A solid of one facet. Equal points become one vertex; `random` shuffles the numbers of the
/// vertices.
inline Solid facet_solid(const std::vector<Ring>& rings, std::mt19937* random = nullptr) {
  SolidArrays arrays;
  std::vector<Point>& points = arrays.vertices;
  for (const Ring& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (random != nullptr) std::shuffle(points.begin(), points.end(), *random);
  std::map<Point, Index> number;
  for (const Point& p : points) number.emplace(p, static_cast<Index>(number.size()));
  for (const Ring& ring : rings) {
    for (const Point& p : ring) arrays.ring_vertices.push_back(number[p]);
    arrays.end_ring();
  }
  arrays.end_facet();
  arrays.end_shell();
  auto solid = Solid::make(std::move(arrays), Lattice{}, 0);
  REQUIRE(solid);
  return *solid;
}

}  // namespace watertight::test
