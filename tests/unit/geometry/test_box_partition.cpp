// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <vector>

#include "geometry/box_partition.h"
#include "geometry/predicates.h"
#include "tests/unit/geometry/random.h"

namespace watertight::test {
namespace {

struct Soup {
  std::vector<Point> points;
  std::vector<Triangle> triangles;
};

/// Triangles of the given extent on a grid, some sharing vertices.
Soup random_soup(Random& random, std::size_t count, std::int64_t grid, std::int64_t extent) {
  Soup soup;
  while (soup.triangles.size() < count) {
    const Point corner{static_cast<double>(random.between(0, grid)),
                       static_cast<double>(random.between(0, grid)),
                       static_cast<double>(random.between(0, grid))};
    Triangle triangle{};
    for (Index& vertex : triangle) {
      if (!soup.points.empty() && random.below(4) == 0) {
        vertex = static_cast<Index>(random.below(soup.points.size()));
        continue;
      }
      vertex = static_cast<Index>(soup.points.size());
      Point p = corner;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] += static_cast<double>(random.between(0, extent));
      soup.points.push_back(p);
    }
    soup.triangles.push_back(triangle);
  }
  return soup;
}

bool is_degenerate(const Soup& soup, const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0] ||
         are_collinear(soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]);
}

std::vector<IntersectingPair> all_pairs(const Soup& soup) {
  std::vector<IntersectingPair> pairs;
  for (Index i = 0; i < soup.triangles.size(); ++i) {
    if (is_degenerate(soup, soup.triangles[i])) continue;
    for (Index j = i + 1; j < soup.triangles.size(); ++j) {
      if (is_degenerate(soup, soup.triangles[j])) continue;
      const auto contact = classify_contact(soup.points, soup.triangles[i], soup.triangles[j]);
      if (is_intersection(contact)) pairs.push_back({i, j, contact});
    }
  }
  return pairs;
}

std::vector<IntersectingPair> found_pairs(const Soup& soup) {
  auto pairs = intersecting_pairs(soup.points, soup.triangles, {.limit = 100'000'000});
  REQUIRE(pairs.has_value());
  return std::move(pairs).value();
}

/// A closed sphere-like surface of quads split in two: rings x segments.
Soup sphere(int rings, int segments) {
  Soup soup;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const double polar = 3.0 * (i + 1) / (rings + 2);
      const double turn = 6.283185307179586 * j / segments;
      soup.points.push_back({std::round(1e6 * std::sin(polar) * std::cos(turn)),
                             std::round(1e6 * std::sin(polar) * std::sin(turn)),
                             std::round(1e6 * std::cos(polar))});
    }
  }
  const auto at = [&](int i, int j) { return static_cast<Index>(i * segments + j % segments); };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      soup.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      soup.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return soup;
}

}  // namespace

TEST_CASE("the box partition finds the pairs that comparing all triangles finds") {
  Random random(5);
  for (const auto& [count, grid, extent] : {std::array<std::int64_t, 3>{10, 4, 4},
                                            {400, 60, 8},
                                            {1500, 200, 8},
                                            {1500, 40, 2},
                                            {600, 5, 40},
                                            {1500, 100'000'000, 4'000'000}}) {
    const Soup soup = random_soup(random, static_cast<std::size_t>(count), grid, extent);
    const auto expected = all_pairs(soup);
    INFO(count << " triangles, " << expected.size() << " pairs");
    CHECK(found_pairs(soup) == expected);
    if (count > 100) CHECK(!expected.empty());
  }
}

TEST_CASE("a surface without self-intersection has no pairs and a moved vertex is found") {
  Soup soup = sphere(40, 50);
  CHECK(found_pairs(soup).empty());
  soup.points[1020].x *= -2;  // through the opposite side
  soup.points[1020].y *= -2;
  const auto pairs = found_pairs(soup);
  CHECK(!pairs.empty());
  CHECK(pairs == all_pairs(soup));
}

TEST_CASE("a fan of triangles around one vertex ends") {
  Soup soup;
  soup.points.push_back({0, 0, 0});
  for (int i = 0; i <= 3000; ++i) soup.points.push_back({double(i), 3000.0 - i, double(i % 7)});
  for (Index i = 1; i <= 3000; ++i) soup.triangles.push_back({0, i, i + 1});
  CHECK(found_pairs(soup).empty());
}

TEST_CASE("many equal triangles end at the limit") {
  Soup soup;
  soup.points = {{0, 0, 0}, {5, 0, 0}, {0, 5, 0}};
  soup.triangles.assign(5000, {0, 1, 2});
  const auto pairs = intersecting_pairs(soup.points, soup.triangles, {.limit = 1000});
  REQUIRE(pairs.has_value());
  CHECK(pairs->size() == 1000);
  CHECK(pairs->front() == IntersectingPair{0, 1, ContactClass::duplicate});
}

TEST_CASE("the search can be cancelled") {
  Soup soup;
  soup.points = {{0, 0, 0}, {5, 0, 0}, {0, 5, 0}};
  soup.triangles.assign(3000, {0, 1, 2});
  int asked = 0;
  const auto pairs = intersecting_pairs(
      soup.points, soup.triangles, {.limit = 1ULL << 40U, .cancel = [&] { return ++asked == 3; }});
  REQUIRE_FALSE(pairs.has_value());
  CHECK(pairs.error().code == ErrorCode::cancelled);
  CHECK(asked == 3);
}

TEST_CASE("degenerate triangles belong to no pair") {
  Soup soup;
  soup.points = {{0, 0, 0}, {6, 0, 0}, {0, 6, 0}, {1, 1, -1}, {1, 1, 1}, {1, 1, 3}};
  soup.triangles = {{0, 1, 2}, {3, 4, 5}, {3, 3, 4}};
  CHECK(found_pairs(soup).empty());
}

TEST_CASE("boxes far from the origin and beyond single precision lose no pair") {
  for (const double far : {0.0, 1e15, 1e200}) {
    Soup soup;
    const double step = far == 0 ? 1 : far / 1e15;
    for (int i = 0; i < 40; ++i) {
      const auto first = static_cast<Index>(soup.points.size());
      const double x = far + step * 4 * i;
      soup.points.push_back({x, far, far});
      const double rise = i % 2 == 0 ? 0 : step * 8;
      soup.points.push_back({x + step * 8, far + step * 8, far + rise});
      soup.points.push_back({x + step * 8, far, far + (step * 8 - rise)});
      soup.triangles.push_back({first, first + 1, first + 2});
    }
    const auto expected = all_pairs(soup);
    CHECK(!expected.empty());
    CHECK(found_pairs(soup) == expected);
  }
}

}  // namespace watertight::test
