// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>

#include "geometry/mass/mass.h"
#include "geometry/measures.h"
#include "tests/unit/geometry/meshes.h"

namespace watertight::test {
namespace {

using geometry::centroid;
using geometry::volume_below;

Lattice decimetres() {
  Lattice lattice;
  lattice.step = {GridNumber{1, -1}, GridNumber{1, -1}, GridNumber{1, -1}};
  lattice.origin = {GridNumber{5, 2}, GridNumber{-7, 0}, GridNumber{25, -2}};
  return lattice;
}

/// The same mesh upside down: z becomes -z, triangles are turned over.
Mesh mirrored(const Mesh& mesh, Lattice lattice) {
  std::vector<Point> vertices(mesh.solid.vertices().begin(), mesh.solid.vertices().end());
  for (Point& vertex : vertices) vertex.z = vertex.z == 0 ? 0 : -vertex.z;
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& triangle : triangles) std::swap(triangle[1], triangle[2]);
  return mesh_of(std::move(vertices), triangles, lattice);
}

/// The volume of a tetrahedron below a height, from the volumes of its corners cut off (another
/// formula than that of volume_below, in doubles).
double cut_off(const Mesh& mesh, double height) {
  std::vector<Point> corners(mesh.solid.vertices().begin(), mesh.solid.vertices().end());
  std::ranges::sort(corners, {}, [](const Point& p) { return p.z; });
  const auto share = [&](std::size_t tip, std::initializer_list<std::size_t> others) {
    double product = 1;
    for (const std::size_t other : others) {
      product *= (height - corners[tip].z) / (corners[other].z - corners[tip].z);
    }
    return product;
  };
  const double volume = geometry::six_volume(mesh.solid.vertices(), mesh.triangles) / 6;
  if (height <= corners[0].z) return 0;
  if (height >= corners[3].z) return volume;
  if (height <= corners[1].z) return volume * share(0, {1, 2, 3});
  if (height >= corners[2].z) return volume * (1 - share(3, {0, 1, 2}));
  return volume * (share(0, {1, 2, 3}) + share(1, {0, 2, 3}));  // the second is negative
}

}  // namespace

TEST_CASE("a tetrahedron has its centre of mass, rounded once") {
  const Mesh mesh = tetrahedron({0, 0, 0}, {30, 0, 0}, {0, 30, 0}, {0, 0, 30}, decimetres());
  // A quarter of the sum of the corners: 0.75 from the origin (500, -7, 0.25).
  CHECK(centroid(mesh.solid, mesh.triangles) == std::array<double, 3>{500.75, -6.25, 1});
}

TEST_CASE("the centre of mass is that of the corners, whatever the tetrahedron") {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    const Mesh mesh = random_tetrahedron(random, Lattice());
    const auto centre = centroid(mesh.solid, mesh.triangles);
    for (int axis = 0; axis < 3; ++axis) {
      double sum = 0;  // of integers: exact
      for (const Point& corner : mesh.solid.vertices()) sum += corner[axis];
      CHECK(centre[static_cast<std::size_t>(axis)] == sum / 4);
    }
  }
}

TEST_CASE("the volume below a height grows from nothing to the volume") {
  const Mesh mesh = tetrahedron({0, 0, 0}, {30, 0, 0}, {0, 30, 0}, {0, 0, 30}, decimetres());
  CHECK(volume_below(mesh.solid, mesh.triangles, -100) == 0);
  CHECK(volume_below(mesh.solid, mesh.triangles, 0.25) == 0);
  CHECK(volume_below(mesh.solid, mesh.triangles, 1e300) == 4.5);
  CHECK(volume_below(mesh.solid, mesh.triangles, 3.25) == 4.5);
  CHECK(volume_below(mesh.solid, mesh.triangles, 1.75) == 4.5 * 7 / 8);
}

TEST_CASE("the volume below a height is what is left of the corners") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(-100'000, 1'100'000);
  for (int round = 0; round < 1000; ++round) {
    const Mesh mesh = random_tetrahedron(random, Lattice());
    const double height = place(random);
    const double below = volume_below(mesh.solid, mesh.triangles, height);
    const double expected = cut_off(mesh, height);
    const double whole = geometry::six_volume(mesh.solid.vertices(), mesh.triangles) / 6;
    CHECK(std::abs(below - expected) <= 1e-9 * whole);
  }
}

TEST_CASE("below and above are the whole, and a mirror image has them the other way round") {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> place(0, 10'000'000);
  for (int round = 0; round < 300; ++round) {
    const Mesh mesh = random_tetrahedron(random, Lattice());
    const Mesh image = mirrored(mesh, Lattice());
    const double height = place(random) / 10.0;  // mostly no double
    const double below = volume_below(mesh.solid, mesh.triangles, height);
    const double above = volume_below(image.solid, image.triangles, -height);
    const double whole = geometry::six_volume(mesh.solid.vertices(), mesh.triangles) / 6;
    CHECK(std::abs(below + above - whole) <= 2 * std::nextafter(whole, 2 * whole) - 2 * whole);
  }
}

TEST_CASE("a place is inside, on the boundary or outside, exactly") {
  // The slanted facet has x + y + z = 3 in decimetres from the origin (500, -7, 0.25).
  const Mesh mesh = tetrahedron({0, 0, 0}, {30, 0, 0}, {0, 30, 0}, {0, 0, 30}, decimetres());
  const auto at = [&](double x, double y, double z) {
    return geometry::locate(mesh.solid, mesh.triangles, {x, y, z});
  };
  CHECK(at(500.1, -6.9, 0.35) == 1);
  CHECK(at(501.1, -5.9, 1.05) == 0);  // 1.1 + 1.1 + 0.8, none of which is a double
  CHECK(at(501.1, -5.9, 1.0500000000000003) == -1);
  CHECK(at(501.1, -5.9, 1.0499999999999998) == 1);
  CHECK(at(500, -7, 0.25) == 0);
  CHECK(at(500, -7, 0.2499999999999999) == -1);
  CHECK(at(500.1, -6.9, -1e300) == -1);
}

}  // namespace watertight::test
