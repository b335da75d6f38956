// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>

#include "geometry/measures.h"
#include "tests/unit/geometry/solids.h"

namespace watertight::test {
namespace {

/// The fans of triangles of facets without interior rings, which is enough for boxes.
std::vector<Triangle> fans(const Solid& solid) {
  std::vector<Triangle> triangles;
  for (Index ring = 0; ring < solid.ring_count(); ++ring) {
    const auto corners = solid.ring(ring);
    for (std::size_t i = 2; i < corners.size(); ++i) {
      triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }
  return triangles;
}

Solid box_solid(const Point& min, const Point& max, Lattice lattice, bool is_outward = true) {
  std::vector<Point> vertices;
  const Shell shell = box_shell(vertices, min, max, is_outward);
  auto solid = Solid::make(arrays_of(std::move(vertices), {shell}), lattice, 0);
  REQUIRE(solid.has_value());
  return std::move(solid).value();
}

}  // namespace

TEST_CASE("a box has its volume, area, box and genus") {
  Lattice lattice;
  lattice.step = {GridNumber{1, -1}, GridNumber{1, -1}, GridNumber{1, -1}};
  lattice.origin = {GridNumber{5, 2}, GridNumber{-7, 0}, GridNumber{25, -2}};
  const Solid solid = box_solid({0, 0, 0}, {30, 20, 10}, lattice);
  const geometry::Measures measures = geometry::measure(solid, fans(solid));
  CHECK(measures.volume == 6.0);  // exact, although 0.1 is no double
  CHECK(std::abs(measures.area - 22.0) < 1e-12);
  CHECK(measures.box_min == std::array<double, 3>{500, -7, 0.25});
  CHECK(measures.box_max == std::array<double, 3>{503, -5, 1.25});
  CHECK(measures.genus == 0);
  CHECK(measures.facets == 6);
  CHECK(measures.vertices == 8);
}

TEST_CASE("genus counts the tunnels of all shells") {
  const Solid solid = tunnel_solid();
  CHECK(geometry::measure(solid, {}).genus == 2);
  CHECK(geometry::measure(solid, {}).shells == 3);
  CHECK(geometry::measure(solid, {}).rings == solid.ring_count());
}

TEST_CASE("the sign of the volume follows the orientation") {
  const Solid outward = box_solid({0, 0, 0}, {1, 1, 1}, {});
  const Solid inward = box_solid({0, 0, 0}, {1, 1, 1}, {}, false);
  CHECK(geometry::volume_sign(outward.vertices(), fans(outward)) == 1);
  CHECK(geometry::volume_sign(inward.vertices(), fans(inward)) == -1);
  CHECK(geometry::volume_sign(inward.vertices(), {}) == 0);
  CHECK(geometry::six_volume(inward.vertices(), fans(inward)) == -6.0);
}

TEST_CASE("volumes are exact where doubles cancel") {
  // A sheet one unit thick at 2^52: the terms of its volume are near 2^156.
  const double far = std::ldexp(1.0, 52);
  const Solid thin = box_solid({far, far, far}, {far + 1, far + 3, far + 5}, {});
  CHECK(geometry::six_volume(thin.vertices(), fans(thin)) == 6.0 * 15);
  const Solid wide = box_solid({0, 0, 0}, {far, far, 1}, {});
  CHECK(geometry::six_volume(wide.vertices(), fans(wide)) == 6.0 * std::ldexp(1.0, 104));
  // Doubles that are no integers and have very different magnitudes.
  Lattice plain;
  plain.kind = LatticeKind::float64;
  const Solid small = box_solid({1e-200, 0.5, 0.25}, {3e-200, 0.75, 1e200}, plain);
  const double volume = geometry::six_volume(small.vertices(), fans(small));
  CHECK(std::abs(volume / (6 * 2e-200 * 0.25 * 1e200) - 1) < 1e-15);
  CHECK(geometry::volume_sign(small.vertices(), fans(small)) == 1);
}

TEST_CASE("128-bit and long integers give the same volume") {
  Random random(11);
  for (int round = 0; round < 200; ++round) {
    std::vector<Point> vertices(12);
    for (Point& p : vertices) {
      for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<double>(random.below(1U << 20U));
    }
    std::vector<Triangle> triangles(20);
    for (Triangle& triangle : triangles) {
      for (Index& vertex : triangle) vertex = static_cast<Index>(random.below(vertices.size()));
    }
    const double direct = geometry::six_volume(vertices, triangles);
    // Coordinates scaled by 2^-21 are no integers: long integers add the same terms, times 2^-63.
    std::vector<Point> eighths = vertices;
    for (Point& p : eighths) {
      for (int axis = 0; axis < 3; ++axis) p[axis] /= 2097152.0;
    }
    REQUIRE(geometry::six_volume(eighths, triangles) == std::ldexp(direct, -63));
  }
}

TEST_CASE("the sign of a volume is that of the exact sum, however thin the solid") {
  Random random(23);
  int undecided_by_doubles = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto coordinate = [&] { return static_cast<double>(random.below(1U << 30U)) / 3.0; };
    std::vector<Point> vertices(4);
    for (int i = 0; i < 3; ++i) {
      vertices[static_cast<std::size_t>(i)] = {coordinate(), coordinate(), coordinate()};
    }
    // The fourth is in the plane of the others but for rounding, and some ulps.
    Point& last = vertices[3];
    for (int axis = 0; axis < 3; ++axis) {
      last[axis] = vertices[0][axis] / 4 + vertices[1][axis] / 4 + vertices[2][axis] / 2;
    }
    last.z = std::nextafter(last.z, round % 2 == 0 ? 0.0 : 1e300);
    const std::vector<Triangle> triangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const double exact = geometry::six_volume(vertices, triangles);
    const int sign = exact > 0 ? 1 : exact < 0 ? -1 : 0;
    REQUIRE(geometry::volume_sign(vertices, triangles) == sign);
    undecided_by_doubles += std::abs(exact) < 1e9 ? 1 : 0;  // of products near 1e26
  }
  CHECK(undecided_by_doubles > 0);
}

}  // namespace watertight::test
