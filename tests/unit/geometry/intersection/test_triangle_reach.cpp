// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include <array>
#include <catch2/catch_test_macros.hpp>

#include "geometry/intersection/triangle_reach.h"
#include "tests/random.h"

namespace watertight::test {
namespace {

using CuboidKernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;

CuboidKernel::Point_3 cuboid_point(const Point& p) { return {p.x, p.y, p.z}; }

Point random_point(Random& random, std::uint64_t size) {
  const auto coordinate = [&] { return static_cast<double>(random.below(size)); };
  return {coordinate(), coordinate(), coordinate()};
}

/// CGAL's exact answer.
bool do_meet(const std::array<Point, 3>& corners, const Box& box) {
  return CGAL::do_intersect(
      CuboidKernel::Triangle_3(cuboid_point(corners[0]), cuboid_point(corners[1]),
                               cuboid_point(corners[2])),
      CuboidKernel::Iso_cuboid_3(cuboid_point(box.min), cuboid_point(box.max)));
}

}  // namespace

TEST_CASE("a triangle is apart from the boxes that it does not meet, as CGAL says") {
  Random random(47);
  std::size_t apart = 0;
  std::size_t meeting = 0;
  for (int round = 0; round < 4000; ++round) {
    const std::uint64_t size = round % 2 == 0 ? 12 : 1'000'000;
    std::array<Point, 3> corners;
    for (Point& corner : corners) corner = random_point(random, size);
    if (CGAL::collinear(cuboid_point(corners[0]), cuboid_point(corners[1]),
                        cuboid_point(corners[2])))
      continue;
    Box box;
    const Point low = random_point(random, size);
    box.include(low);
    const double side = 1 + static_cast<double>(random.below(1 + size / 3));
    box.include({low.x + side, low.y + 1, low.z + side});
    const geometry::TriangleReach reach(corners[0], corners[1], corners[2]);
    const bool is_near = geometry::box_of(corners).overlaps(box) && !reach.is_apart_from(box);
    CHECK(is_near == do_meet(corners, box));
    ++(is_near ? meeting : apart);
  }
  CHECK(apart > 500);
  CHECK(meeting > 200);
}

TEST_CASE("a triangle is never apart from a box that it touches, however far from the origin") {
  Random random(53);
  for (int round = 0; round < 4000; ++round) {
    std::array<Point, 3> corners;
    for (Point& corner : corners) corner = random_point(random, std::uint64_t{1} << 50);
    const geometry::TriangleReach reach(corners[0], corners[1], corners[2]);
    // The middle of an edge is exact, and so is a corner.
    const Point& a = corners[random.below(3)];
    const Point& b = corners[random.below(3)];
    Box box;
    box.include({a.x / 2 + b.x / 2, a.y / 2 + b.y / 2, a.z / 2 + b.z / 2});
    CHECK_FALSE(reach.is_apart_from(box));
  }
}

TEST_CASE("a triangle without area is not apart from the boxes on its line") {
  const geometry::TriangleReach reach({0, 0, 0}, {4, 4, 4}, {8, 8, 8});
  Box on_line;
  on_line.include({6, 6, 6});
  CHECK_FALSE(reach.is_apart_from(on_line));
  Box beside;
  beside.include({6, 6, 5});
  CHECK(reach.is_apart_from(beside));
}

}  // namespace watertight::test
