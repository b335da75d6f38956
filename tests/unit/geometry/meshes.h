// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids of triangles for the tests of this folder.
#pragma once

#include <array>
#include <catch2/catch_test_macros.hpp>
#include <random>
#include <utility>
#include <vector>

#include "geometry/measures.h"
#include "geometry/solid.h"

namespace watertight::test {

/// A solid of triangles.
struct Mesh {
  Solid solid;
  std::vector<Triangle> triangles;
};

inline Mesh mesh_of(std::vector<Point> vertices, const std::vector<Triangle>& triangles,
                    const Lattice& lattice) {
  geometry::SolidArrays arrays;
  arrays.vertices = std::move(vertices);
  for (const Triangle& triangle : triangles) {
    arrays.ring_vertices.insert(arrays.ring_vertices.end(), triangle.begin(), triangle.end());
    arrays.end_ring();
    arrays.end_facet();
  }
  arrays.end_shell();
  auto solid = Solid::make(std::move(arrays), lattice, 0);
  REQUIRE(solid.has_value());
  return {*std::move(solid), triangles};
}

inline Mesh tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d,
                        const Lattice& lattice) {
  return mesh_of({a, b, c, d}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}, lattice);
}

/// A tetrahedron whose coordinates are integers from 0 to `most`.
inline Mesh random_tetrahedron(std::mt19937& random, const Lattice& lattice, int most = 1'000'000) {
  std::uniform_int_distribution<int> place(0, most);
  for (;;) {
    const auto point = [&] {
      return Point{static_cast<double>(place(random)), static_cast<double>(place(random)),
                   static_cast<double>(place(random))};
    };
    Mesh mesh = tetrahedron(point(), point(), point(), point(), lattice);
    if (geometry::volume_sign(mesh.solid.vertices(), mesh.triangles) > 0) return mesh;
  }
}

/// A box of twelve triangles.
inline Mesh box_mesh(const Point& min, const Point& max, const Lattice& lattice) {
  std::vector<Point> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(
        {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y, (i & 4) != 0 ? max.z : min.z});
  }
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c, d] : std::vector<std::array<Index, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
  return mesh_of(std::move(corners), triangles, lattice);
}

}  // namespace watertight::test
