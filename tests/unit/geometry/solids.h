// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids for the tests of this folder.
#pragma once

#include <catch2/catch_test_macros.hpp>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include "geometry/valid_solid.h"
#include "tests/random.h"

namespace watertight::test {

using Ring = std::vector<Index>;
using Facet = std::vector<Ring>;
using Shell = std::vector<Facet>;

inline SolidArrays arrays_of(std::vector<Point> vertices, const std::vector<Shell>& shells) {
  SolidArrays arrays;
  arrays.vertices = std::move(vertices);
  for (const Shell& shell : shells) {
    for (const Facet& facet : shell) {
      for (const Ring& ring : facet) {
        arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
        arrays.end_ring();
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  return arrays;
}

inline Solid solid_of(std::vector<Point> vertices, const std::vector<Shell>& shells) {
  auto solid = Solid::make(arrays_of(std::move(vertices), shells), Lattice{}, 7415);
  REQUIRE(solid.has_value());
  return std::move(solid).value();
}

/// Appends the eight corners of a box and returns its six facets, turned outward or inward.
inline Shell box_shell(std::vector<Point>& vertices, const Point& min, const Point& max,
                       bool is_outward) {
  const auto first = static_cast<Index>(vertices.size());
  for (int i = 0; i < 8; ++i) {
    vertices.push_back(
        {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y, (i & 4) != 0 ? max.z : min.z});
  }
  Shell shell;
  for (const Ring& corners : {Ring{0, 2, 3, 1}, Ring{4, 5, 7, 6}, Ring{0, 1, 5, 4},
                              Ring{2, 6, 7, 3}, Ring{0, 4, 6, 2}, Ring{1, 3, 7, 5}}) {
    Ring ring;
    for (const Index corner : corners) ring.push_back(first + corner);
    if (!is_outward) ring = Ring(ring.rbegin(), ring.rend());
    shell.push_back({ring});
  }
  return shell;
}

/// A box with a square tunnel along z (two facets with interior rings) and two cavities.
inline std::pair<std::vector<Point>, std::vector<Shell>> tunnel_with_cavities() {
  std::vector<Point> vertices;
  Shell outer = box_shell(vertices, {0, 0, 0}, {30, 20, 10}, true);
  Shell tunnel = box_shell(vertices, {2, 2, 0}, {5, 5, 10}, false);
  outer[0].push_back(tunnel[0][0]);  // the bottom
  outer[1].push_back(tunnel[1][0]);  // the top
  outer.insert(outer.end(), tunnel.begin() + 2, tunnel.end());
  Shell second = box_shell(vertices, {8, 2, 0}, {11, 5, 10}, false);
  outer[0].push_back(second[0][0]);
  outer[1].push_back(second[1][0]);
  outer.insert(outer.end(), second.begin() + 2, second.end());
  Shell cavity = box_shell(vertices, {20, 5, 2}, {22, 7, 4}, false);
  Shell other = box_shell(vertices, {24, 5, 2}, {26, 7, 4}, false);
  return {std::move(vertices), {outer, other, cavity}};
}

inline Solid tunnel_solid() {
  auto [vertices, shells] = tunnel_with_cavities();
  return solid_of(std::move(vertices), shells);
}

}  // namespace watertight::test
