// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <map>
#include <vector>

#include "geometry/intersection/triangle_triangle.h"
#include "tests/unit/geometry/triangle_oracle.h"

namespace watertight::test {
namespace {

/// The class of the triangle of the first three points and `second`, three further points unless
/// given.
geometry::ContactClass contact(std::vector<Point> points, Triangle second = {3, 4, 5}) {
  return geometry::classify_contact(points, {0, 1, 2}, second);
}

const std::vector<Point> kFloor{{0, 0, 0}, {12, 0, 0}, {0, 12, 0}};

std::vector<Point> with_floor(std::initializer_list<Point> others) {
  std::vector<Point> points = kFloor;
  points.insert(points.end(), others);
  return points;
}

}  // namespace

TEST_CASE("triangles that only share vertices or edges do not intersect") {
  CHECK(contact(with_floor({{0, 0, 9}, {5, 5, 9}, {1, 7, 2}})) == geometry::ContactClass::disjoint);
  CHECK(contact(with_floor({{5, 0, 5}, {0, 5, 5}}), {0, 3, 4}) ==
        geometry::ContactClass::shared_vertex);
  CHECK(contact(with_floor({{-5, -1, 0}, {-1, -5, 0}}), {0, 3, 4}) ==
        geometry::ContactClass::shared_vertex);
  CHECK(contact(with_floor({{5, 5, 5}}), {1, 0, 3}) == geometry::ContactClass::shared_edge);
  CHECK(contact(with_floor({{5, -5, 0}}), {1, 0, 3}) == geometry::ContactClass::shared_edge);
  for (const geometry::ContactClass fine :
       {geometry::ContactClass::disjoint, geometry::ContactClass::shared_vertex,
        geometry::ContactClass::shared_edge}) {
    CHECK_FALSE(geometry::is_intersection(fine));
  }
  CHECK(geometry::is_intersection(geometry::ContactClass::vertex_vertex));
}

TEST_CASE("every way of touching has its name") {
  CHECK(contact(with_floor({{0, 0, 0}, {3, 3, 5}, {3, 1, 5}})) ==
        geometry::ContactClass::vertex_vertex);
  CHECK(contact(with_floor({{6, 0, 0}, {3, 3, 5}, {3, 1, 5}})) ==
        geometry::ContactClass::vertex_edge);
  CHECK(contact(with_floor({{3, 3, 0}, {3, 3, 5}, {3, 1, 5}})) ==
        geometry::ContactClass::vertex_face);
  CHECK(contact(with_floor({{6, 0, -3}, {6, 0, 3}, {6, -9, 0}})) ==
        geometry::ContactClass::edge_edge);
  CHECK(contact(with_floor({{3, 0, 0}, {20, 0, 0}, {6, -9, 4}})) ==
        geometry::ContactClass::edge_overlap);
  CHECK(contact(with_floor({{3, 3, 0}, {20, 3, 0}, {6, 3, 4}})) ==
        geometry::ContactClass::edge_face);
  CHECK(contact(with_floor({{3, 3, -3}, {3, 3, 3}, {20, 3, 0}})) ==
        geometry::ContactClass::crossing);
  CHECK(contact(with_floor({{3, 3, 0}, {20, 3, 0}, {3, 20, 0}})) ==
        geometry::ContactClass::coplanar_overlap);
  CHECK(contact(with_floor({{0, 12, 0}, {0, 0, 0}, {12, 0, 0}})) ==
        geometry::ContactClass::duplicate);
  CHECK(contact(kFloor, {2, 1, 0}) == geometry::ContactClass::duplicate);
}

TEST_CASE("triangles with a common vertex or edge can still intersect") {
  CHECK(contact(with_floor({{9, 9, -5}, {9, 9, 5}}), {0, 3, 4}) ==
        geometry::ContactClass::crossing);
  CHECK(contact(with_floor({{-9, -9, -5}, {-9, -9, 5}}), {0, 3, 4}) ==
        geometry::ContactClass::shared_vertex);
  CHECK(contact(with_floor({{3, 3, 0}, {3, 3, 5}}), {0, 3, 4}) ==
        geometry::ContactClass::edge_face);
  CHECK(contact(with_floor({{6, 0, 0}, {3, 3, 5}}), {0, 3, 4}) ==
        geometry::ContactClass::edge_overlap);
  CHECK(contact(with_floor({{6, 0, 0}, {9, -9, 0}}), {0, 3, 4}) ==
        geometry::ContactClass::edge_overlap);
  CHECK(contact(with_floor({{3, 1, 0}, {1, 3, 0}}), {0, 3, 4}) ==
        geometry::ContactClass::coplanar_overlap);
  CHECK(contact(with_floor({{5, 5, 0}}), {1, 0, 3}) == geometry::ContactClass::coplanar_overlap);
  CHECK(contact(with_floor({{0, 12, 0}}), {1, 0, 3}) == geometry::ContactClass::duplicate);
}

TEST_CASE("the witness is the middle of the common part of two triangles") {
  auto points = with_floor({{3, 3, -3}, {3, 3, 3}, {20, 3, 0}});
  CHECK(geometry::contact_witness(points, {0, 1, 2}, {3, 4, 5}) == Point{6, 3, 0});
  points = with_floor({{1, 1, 0}, {1, 1, 1}, {1, 2, 1}});
  CHECK(geometry::contact_witness(points, {0, 1, 2}, {3, 4, 5}) == Point{1, 1, 0});
  // A third is no double, so the witness is rounded once.
  points = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {1, 1, -1}, {1, 1, 2}, {2, 1, 2}};
  CHECK(geometry::contact_witness(points, {0, 1, 2}, {3, 4, 5}) == Point{1 + 1.0 / 6, 1, 0});
}

TEST_CASE("the classification agrees with an exact construction on random degenerate pairs") {
  Random random(2026);
  std::map<geometry::ContactClass, int> counts;
  constexpr int kPairs = 20'000;
  for (int i = 0; i < kPairs; ++i) {
    const TrianglePair pair = random_pair(random);
    const auto difference = disagreement(pair, random);
    INFO("pair " << i << ": " << difference.value_or(""));
    REQUIRE_FALSE(difference.has_value());
    ++counts[geometry::classify_contact(pair.points, pair.first, pair.second)];
  }
  // Every class must occur often.
  CHECK(counts.size() == 12);
  for (const auto& [contact_class, count] : counts) {
    INFO(geometry::to_string(contact_class));
    CHECK(count > 50);
  }
}

}  // namespace watertight::test
