// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmpxx.h>

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>

#include "geometry/mass/area.h"
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

/// The number of `digits` bits that a grid number is.
mpf_class float_of(const GridNumber& number, std::int32_t radix, mp_bitcnt_t digits) {
  mpf_class power(1, digits);
  for (std::int32_t i = 0; i < std::abs(number.exponent); ++i) power *= radix;
  const mpf_class mantissa(static_cast<double>(number.mantissa), digits);
  return number.exponent < 0 ? mpf_class(mantissa / power) : mpf_class(mantissa * power);
}

/// The area of triangles by Heron's formula in floating-point numbers of many digits (another
/// formula and another arithmetic than those of area_of), as the nearest double.
double area_by_heron(const Mesh& mesh) {
  constexpr mp_bitcnt_t kDigits = 2048;
  const std::int32_t radix = mesh.solid.lattice().kind == geometry::LatticeKind::binary ? 2 : 10;
  const auto length = [&](Index from, Index to) {
    mpf_class square(0, kDigits);
    for (int axis = 0; axis < 3; ++axis) {
      mpf_class way(mesh.solid.vertices()[to][axis], kDigits);
      way -= mpf_class(mesh.solid.vertices()[from][axis], kDigits);
      way *= float_of(mesh.solid.lattice().step[static_cast<std::size_t>(axis)], radix, kDigits);
      square += way * way;
    }
    return mpf_class(sqrt(square), kDigits);
  };
  mpf_class area(0, kDigits);
  for (const auto& [i, j, k] : mesh.triangles) {
    const mpf_class a = length(i, j), b = length(j, k), c = length(k, i);
    const mpf_class half((a + b + c) / 2, kDigits);
    const mpf_class product(half * (half - a) * (half - b) * (half - c), kDigits);
    if (product > 0) area += sqrt(product);
  }
  double nearest = area.get_d();  // rounded toward zero
  const double next = std::nextafter(nearest, INFINITY);
  if (area - mpf_class(nearest, kDigits) > mpf_class(next, kDigits) - area) nearest = next;
  return nearest;
}

}  // namespace

TEST_CASE("areas are exact sums, rounded once: rational ones") {
  // The legs 0.3 and 0.4 have the hypotenuse 0.5, and three such triangles stand on a base.
  const Mesh flat = tetrahedron({0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {0, 0, 12}, decimetres());
  CHECK(geometry::area_of(flat.solid, std::span(flat.triangles).first(0)) == 0);
  CHECK(geometry::area_of(flat.solid, flat.triangles) == area_by_heron(flat));
  const Mesh cube = tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, decimetres());
  CHECK(geometry::area_of(cube.solid, std::span(cube.triangles).first(1)) == 0.005);
}

TEST_CASE("areas are exact sums, rounded once: on all kinds of lattices") {
  std::mt19937 random(7);
  const auto number = [&](int reach) {
    return static_cast<double>(
        static_cast<int>(random() % (2U * static_cast<unsigned>(reach) + 1)) - reach);
  };
  for (int round = 0; round < 4000; ++round) {
    const int reach = round % 3 == 0 ? 9 : round % 3 == 1 ? 5000 : 900'000'000;
    Lattice lattice = decimetres();
    double unit = 1;
    switch (round % 5) {
      case 0:
        lattice.step = {GridNumber{1, -3}, GridNumber{1, -3}, GridNumber{1, -3}};
        break;
      case 1:
        lattice.step = {GridNumber{1, -15}, GridNumber{1, -15}, GridNumber{7, -3}};
        break;
      case 2:
        lattice.kind = geometry::LatticeKind::binary;
        lattice.step = {GridNumber{1, -10}, GridNumber{1, -10}, GridNumber{1, -10}};
        break;
      case 3:
        lattice = Lattice{};
        lattice.kind = geometry::LatticeKind::float64;
        unit = round % 2 == 0 ? 0x1p-7 : 1.0 / 3;  // differences of thirds are no doubles
        break;
      default:
        lattice.step = {GridNumber{25, -11}, GridNumber{25, -11}, GridNumber{25, -11}};
    }
    const auto place = [&] {
      return Point{number(reach) * unit, number(reach) * unit, number(reach) * unit};
    };
    const Mesh mesh = tetrahedron(place(), place(), place(), place(), lattice);
    CHECK(geometry::area_of(mesh.solid, mesh.triangles) == area_by_heron(mesh));
  }
}

TEST_CASE("a sum of roots at the border of two doubles is decided by more digits") {
  // 321 * 28059810762433 is 2^53 + 1, so that the first triangle's area is half way between two
  // doubles, of which the even one is taken. The second adds 10^-9 / sqrt(2).
  Lattice lattice;
  lattice.step = {GridNumber{1, 0}, GridNumber{1, 0}, GridNumber{1, -9}};
  const std::vector<Triangle> both{{0, 1, 2}, {0, 3, 4}};
  const Mesh mesh = mesh_of({{0, 0, 0}, {321, 0, 0}, {0, 28059810762433, 0}, {0, 0, 1}, {1, 1, 0}},
                            both, lattice);
  CHECK(geometry::area_of(mesh.solid, std::span(both).first(1)) == 4503599627370496.0);
  CHECK(geometry::area_of(mesh.solid, both) == 4503599627370497.0);
}

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
