// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <thread>
#include <vector>

#include "geometry/intersection/box_partition.h"
#include "geometry/predicates/predicates.h"
#include "tests/random.h"

namespace watertight::test {
namespace {

struct Soup {
  std::vector<Point> points;
  std::vector<Triangle> triangles;
};

/// Random triangles of the given extent on a grid; some share vertices.
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
         geometry::are_collinear(soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]);
}

std::vector<geometry::IntersectingPair> all_pairs(const Soup& soup) {
  std::vector<geometry::IntersectingPair> pairs;
  for (Index i = 0; i < soup.triangles.size(); ++i) {
    if (is_degenerate(soup, soup.triangles[i])) continue;
    for (Index j = i + 1; j < soup.triangles.size(); ++j) {
      if (is_degenerate(soup, soup.triangles[j])) continue;
      const auto contact =
          geometry::classify_contact(soup.points, soup.triangles[i], soup.triangles[j]);
      if (geometry::is_intersection(contact)) pairs.push_back({i, j, contact});
    }
  }
  return pairs;
}

std::vector<geometry::IntersectingPair> found_pairs(const Soup& soup) {
  auto pairs = geometry::intersecting_pairs(soup.points, soup.triangles, {.limit = 100'000'000});
  REQUIRE(pairs.has_value());
  return std::move(pairs).value();
}

/// A closed surface like a sphere, of rings x segments quadrilaterals split in two.
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

/// A fan around vertex 0 whose outer edges run along a line, or around a cone if `is_closed`.
Soup fan(Index count, bool is_closed, Random& random) {
  Soup soup;
  soup.points.push_back({0, 0, 500});
  for (Index i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * i / count;
    soup.points.push_back(is_closed ? Point{std::round(1e6 * std::cos(angle)),
                                            std::round(1e6 * std::sin(angle)),
                                            static_cast<double>(random.between(-9, 9))}
                                    : Point{4.0 * i, 0, 0});
  }
  for (Index i = 0; i + 1 < count; ++i) soup.triangles.push_back({0, i + 1, i + 2});
  if (is_closed) soup.triangles.push_back({0, count, 1});
  return soup;
}

/// Long thin triangles in one direction, or in random ones if `is_random`.
Soup needles(Index count, bool is_random, Random& random) {
  Soup soup;
  for (Index i = 0; i < count; ++i) {
    const Point from{static_cast<double>(random.between(0, 3000)),
                     static_cast<double>(random.between(0, 3000)), 0};
    Point to{from.x + 100'000, from.y + 200'000, 300'000};
    if (is_random) {
      for (int axis = 0; axis < 3; ++axis) {
        to[axis] = static_cast<double>(random.between(-3000, 3000));
      }
    }
    const auto first = static_cast<Index>(soup.points.size());
    soup.points.insert(soup.points.end(), {from, {from.x + 7, from.y + 3, 1}, to});
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// Adds triangles of points of the soup and of new points, so that some hit fans and needles.
void add_random_triangles(Soup& soup, std::size_t count, Random& random) {
  const std::size_t last = soup.points.size();
  for (std::size_t i = 0; i < count; ++i) {
    Triangle triangle{};
    for (Index& vertex : triangle) {
      vertex = static_cast<Index>(random.below(last));
      if (random.below(3) == 0) continue;
      Point p = soup.points[vertex];
      for (int axis = 0; axis < 3; ++axis) p[axis] += static_cast<double>(random.between(-40, 40));
      vertex = static_cast<Index>(soup.points.size());
      soup.points.push_back(p);
    }
    soup.triangles.push_back(triangle);
  }
}

/// A soup with enough triangles for several pieces of work.
Soup crossing_spheres() {
  Soup soup = sphere(90, 110);
  const Soup other = sphere(90, 110);
  const auto first = static_cast<Index>(soup.points.size());
  for (const Point& p : other.points) soup.points.push_back({p.x + 300'000, p.y + 7, p.z + 1});
  for (const auto& [a, b, c] : other.triangles) {
    soup.triangles.push_back({first + a, first + b, first + c});
  }
  return soup;
}

/// Soups in which no axis-parallel plane separates the boxes, each with some defects.
std::vector<Soup> hard_soups() {
  Random random(11);
  std::vector<Soup> soups;
  for (const bool is_closed : {false, true}) {
    soups.push_back(fan(600, is_closed, random));
    add_random_triangles(soups.back(), 100, random);
  }
  // Two fans around two vertices at one point, and triangles through that point.
  Soup twins = fan(400, true, random);
  const auto other = static_cast<Index>(twins.points.size());
  twins.points.push_back(twins.points[0]);
  for (Index i = 1; i < 400; ++i) twins.triangles.push_back({other, i, i + 1});
  twins.points.insert(twins.points.end(), {{-100, -3, 500}, {100, -3, 500}, {0, 50, 500}});
  twins.triangles.push_back({other + 1, other + 2, other + 3});
  add_random_triangles(twins, 30, random);
  soups.push_back(std::move(twins));
  for (const bool is_random : {false, true}) {
    soups.push_back(needles(400, is_random, random));
    add_random_triangles(soups.back(), 50, random);
  }
  // A plane grid with every third square twice, and a fan above the grid in its plane.
  Soup grid;
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 30; ++j) grid.points.push_back({10.0 * i, 10.0 * j, 5.0 * i + 5.0 * j});
  }
  for (Index i = 0; i + 31 < 900; ++i) {
    if (i % 30 == 29) continue;
    grid.triangles.push_back({i, i + 30, i + 31});
    grid.triangles.push_back({i, i + 31, i + 1});
    if (i % 3 == 0) grid.triangles.push_back({i + 31, i + 30, i});
  }
  soups.push_back(std::move(grid));
  return soups;
}

}  // namespace

TEST_CASE("fans, needles and coplanar grids give the same pairs as a comparison of all triangles") {
  for (const Soup& soup : hard_soups()) {
    const auto expected = all_pairs(soup);
    INFO(soup.triangles.size() << " triangles, " << expected.size() << " pairs");
    CHECK(!expected.empty());
    CHECK(found_pairs(soup) == expected);
  }
}

TEST_CASE("any number of threads finds the same pairs, also with a limit on their number") {
  std::vector<Soup> soups = hard_soups();
  soups.push_back(crossing_spheres());
  for (const Soup& soup : soups) {
    for (const std::uint64_t limit : {std::uint64_t{100}, std::uint64_t{1} << 40U}) {
      const auto one = geometry::intersecting_pairs(soup.points, soup.triangles, {.limit = limit});
      REQUIRE(one.has_value());
      CHECK(one->size() <= limit);
      for (const unsigned threads : {2U, 5U}) {
        const auto several = geometry::intersecting_pairs(soup.points, soup.triangles,
                                                          {.limit = limit, .threads = threads});
        REQUIRE(several.has_value());
        CHECK(*several == *one);
      }
    }
  }
}

TEST_CASE("triangles of one group are not compared") {
  for (const Soup& soup : hard_soups()) {
    std::vector<Index> group_of;
    for (Index t = 0; t < soup.triangles.size(); ++t) group_of.push_back(t / 3);
    auto expected =
        geometry::intersecting_pairs(soup.points, soup.triangles, {.limit = 100'000'000});
    REQUIRE(expected.has_value());
    const std::size_t all = expected->size();
    std::erase_if(*expected, [&](const geometry::IntersectingPair& pair) {
      return group_of[pair.first] == group_of[pair.second];
    });
    CHECK(expected->size() < all);
    const auto pairs = geometry::intersecting_pairs(soup.points, soup.triangles,
                                                    {.limit = 100'000'000, .group_of = group_of});
    REQUIRE(pairs.has_value());
    CHECK(*pairs == *expected);
  }
}

TEST_CASE("only the caller's thread is asked whether to end a search with threads") {
  const Soup soup = crossing_spheres();
  const auto caller = std::this_thread::get_id();
  bool is_other = false;
  geometry::IntersectionOptions options;
  options.threads = 4;
  options.cancel = [&] {
    is_other = is_other || std::this_thread::get_id() != caller;
    return true;
  };
  const auto pairs = geometry::intersecting_pairs(soup.points, soup.triangles, options);
  CHECK((pairs.has_value() || pairs.error().code == ErrorCode::cancelled));
  CHECK_FALSE(is_other);
}

TEST_CASE("fans of many triangles end after few comparisons") {
  // Comparing all boxes would take billions of steps; the number of calls shows that the search
  // does not.
  Random random(8);
  for (const Soup& soup : {fan(60'000, true, random), fan(30'000, false, random)}) {
    std::uint64_t asked = 0;
    const auto pairs = geometry::intersecting_pairs(soup.points, soup.triangles,
                                                    {.cancel = [&] { return ++asked > 500; }});
    REQUIRE(pairs.has_value());
    CHECK(pairs->empty());
  }
}

TEST_CASE("the box partition finds the same pairs as a comparison of all triangles") {
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
  soup.points[1020].x *= -2;  // moves the vertex through the opposite side
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
  const auto pairs = geometry::intersecting_pairs(soup.points, soup.triangles, {.limit = 1000});
  REQUIRE(pairs.has_value());
  CHECK(pairs->size() == 1000);
  CHECK(pairs->front() == geometry::IntersectingPair{0, 1, geometry::ContactClass::duplicate});
}

TEST_CASE("the search can be cancelled") {
  Soup soup;
  soup.points = {{0, 0, 0}, {5, 0, 0}, {0, 5, 0}};
  soup.triangles.assign(3000, {0, 1, 2});
  int asked = 0;
  const auto pairs = geometry::intersecting_pairs(
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
