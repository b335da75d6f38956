// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmpxx.h>

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "geometry/predicates/predicates.h"
#include "tessellate/trimmed/grid.h"
#include "tessellate/trimmed/region.h"

namespace watertight {
namespace {

using tessellate::PlaneEdge;
using tessellate::PlaneGrid;
using tessellate::Region;
using Loop = std::vector<Point>;

Region region_of(const std::vector<Loop>& loops) {
  Region region;
  for (const Loop& loop : loops) {
    const auto first = static_cast<Index>(region.points.size());
    const auto count = static_cast<Index>(loop.size());
    for (Index i = 0; i < count; ++i) region.edges.push_back({first + i, first + (i + 1) % count});
    region.points.insert(region.points.end(), loop.begin(), loop.end());
  }
  return region;
}

mpq_class doubled_area(const Point& a, const Point& b, const Point& c) {
  return (mpq_class(b.x) - mpq_class(a.x)) * (mpq_class(c.y) - mpq_class(a.y)) -
         (mpq_class(b.y) - mpq_class(a.y)) * (mpq_class(c.x) - mpq_class(a.x));
}

mpq_class doubled_area(const Region& region) {
  mpq_class sum = 0;
  for (const auto& [from, to] : region.edges) {
    const Point& a = region.points[from];
    const Point& b = region.points[to];
    sum += mpq_class(a.x) * mpq_class(b.y) - mpq_class(a.y) * mpq_class(b.x);
  }
  return sum;
}

// Triangles turn left, have the region's area exactly, use every point, and have each edge of the
// region once and every other edge twice: so they cover the region once.
void check_cover(const Region& region, const std::vector<Point>& points,
                 const std::vector<Triangle>& triangles) {
  mpq_class sum = 0;
  std::map<PlaneEdge, int> uses;
  std::set<Index> used;
  bool all_turn_left = true;
  for (const Triangle& t : triangles) {
    const mpq_class area = doubled_area(points[t[0]], points[t[1]], points[t[2]]);
    all_turn_left = all_turn_left && area > 0;
    sum += area;
    for (std::size_t k = 0; k < 3; ++k) {
      ++uses[{t[k], t[(k + 1) % 3]}];
      used.insert(t[k]);
    }
  }
  CHECK(all_turn_left);
  CHECK(sum == doubled_area(region));
  CHECK(used.size() == points.size());
  const std::set<PlaneEdge> border(region.edges.begin(), region.edges.end());
  bool all_paired = true;
  for (const auto& [edge, count] : uses) {
    const bool is_border = border.contains(edge);
    const bool has_twin = uses.contains({edge[1], edge[0]});
    all_paired = all_paired && count == 1 && has_twin != is_border;
  }
  CHECK(all_paired);
}

bool segments_meet(const Region& region, std::size_t i, std::size_t k) {
  const auto [a, b] = region.edges[i];
  const auto [c, d] = region.edges[k];
  const auto& p = region.points;
  const auto side = [&](Index x, Index y, Index z) {
    return geometry::orient2d(p[x], p[y], p[z], 2);
  };
  const auto on = [&](Index x, Index y, Index z) {
    return geometry::is_on_segment(p[x], p[y], p[z]);
  };
  if (b == c && on(c, d, a)) return true;
  if (d == a && on(a, b, c)) return true;
  if (b == c) return on(a, b, d);
  if (d == a) return on(c, d, b);
  if (on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b)) return true;
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

bool all_pairs_simple(const Region& region) {
  for (std::size_t i = 0; i < region.edges.size(); ++i) {
    for (std::size_t k = i + 1; k < region.edges.size(); ++k) {
      if (segments_meet(region, i, k)) return false;
    }
  }
  return true;
}

// A loop of random points around the middle; small numbers make points meet lines and each other.
Loop random_loop(std::mt19937& random, std::size_t count, int size, bool is_star) {
  Loop loop;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(count);
    const double radius = static_cast<double>(1 + random() % static_cast<unsigned>(size));
    loop.push_back(is_star ? Point{std::round(radius * std::cos(angle)),
                                   std::round(radius * std::sin(angle)), 0}
                           : Point{static_cast<double>(random() % static_cast<unsigned>(size)),
                                   static_cast<double>(random() % static_cast<unsigned>(size)), 0});
  }
  return loop;
}

}  // namespace

TEST_CASE("a region with holes and inner points is covered by its triangles") {
  Region region = region_of({{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}},
                             {{2, 2, 0}, {2, 4, 0}, {4, 4, 0}, {4, 2, 0}},
                             {{6, 2, 0}, {6, 4, 0}, {8, 4, 0}, {8, 2, 0}}});
  region.points.push_back({5, 8, 0});
  region.points.push_back({5, 4, 0});
  auto result = tessellate::sweep_region(region);
  REQUIRE_FALSE(result.conflict);
  check_cover(region, region.points, result.triangles);
  tessellate::flip_to_delaunay(region.points, result.triangles);
  check_cover(region, region.points, result.triangles);
}

TEST_CASE("a sweep refuses exactly the loops that are not simple") {
  std::mt19937 random(1);
  std::size_t simple = 0;
  for (int round = 0; round < 60'000; ++round) {
    const std::size_t count = 3 + random() % 12;
    const int size = 3 + static_cast<int>(random() % 40);
    const Region region = region_of({random_loop(random, count, size, random() % 4 != 0)});
    const bool is_simple = all_pairs_simple(region);
    const bool turns_left = doubled_area(region) > 0;
    auto result = tessellate::sweep_region(region);
    if (result.conflict.has_value() != !(is_simple && turns_left)) {
      CAPTURE(round, count, size, is_simple, turns_left);
      FAIL("wrong verdict");
    }
    if (result.conflict) continue;
    ++simple;
    if (round % 8 != 0) continue;
    check_cover(region, region.points, result.triangles);
    tessellate::flip_to_delaunay(region.points, result.triangles);
    check_cover(region, region.points, result.triangles);
  }
  CHECK(simple > 10'000);
}

TEST_CASE("a conflict names the edges that meet") {
  const Region bow = region_of({{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}}});
  const auto result = tessellate::sweep_region(bow);
  REQUIRE(result.conflict);
  CHECK(result.triangles.empty());
  const Region outside = region_of({{{0, 0, 0}, {0, 4, 0}, {4, 4, 0}, {4, 0, 0}}});
  const auto turned = tessellate::sweep_region(outside);
  REQUIRE(turned.conflict);
  CHECK(turned.conflict->kind == tessellate::RegionConflict::Kind::side);
  Region open = bow;
  open.edges.pop_back();
  CHECK(tessellate::sweep_region(open).conflict->kind ==
        tessellate::RegionConflict::Kind::not_closed);
  Region equal = region_of({{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {4, 0, 0}}});
  CHECK(tessellate::sweep_region(equal).conflict->kind == tessellate::RegionConflict::Kind::equal);
  Region far = region_of({{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}}});
  far.points.push_back({9, 9, 0});
  CHECK(tessellate::sweep_region(far).conflict->kind == tessellate::RegionConflict::Kind::outside);
}

TEST_CASE("grid points strictly inside the loops become vertices, and no others") {
  std::mt19937 random(2);
  for (int round = 0; round < 600; ++round) {
    const Loop loop = random_loop(random, 4 + random() % 40, 30, true);
    const Region region = region_of({loop});
    if (!all_pairs_simple(region) || doubled_area(region) <= 0) continue;
    PlaneGrid grid;
    const double step = static_cast<double>(1 + random() % 8) * (random() % 2 == 0 ? 1 : 0.37);
    for (double at = -33; at < 33; at += step) grid.us.push_back(at);
    for (double at = -33; at < 33; at += 2 * step) grid.vs.push_back(at);
    const auto result = tessellate::triangulate_trimmed(region, grid);
    REQUIRE_FALSE(result.conflict);
    check_cover(region, result.points, result.triangles);
    std::size_t inside = 0;
    for (const double u : grid.us) {
      for (const double v : grid.vs) {
        const Point p{u, v, 0};
        int winding = 0;
        bool is_on = false;
        for (const auto& [from, to] : region.edges) {
          const Point& a = region.points[from];
          const Point& b = region.points[to];
          is_on = is_on || geometry::is_on_segment(a, b, p);
          const int side = geometry::orient2d(a, b, p, 2);
          if (a.y <= v && b.y > v && side > 0) ++winding;
          if (b.y <= v && a.y > v && side < 0) --winding;
        }
        inside += !is_on && winding != 0 ? 1U : 0U;
      }
    }
    CHECK(result.points.size() == region.points.size() + inside);
  }
}

TEST_CASE("the triangles do not depend on the numbers of the points") {
  std::mt19937 random(3);
  for (int round = 0; round < 2000; ++round) {
    const Loop loop = random_loop(random, 4 + random() % 30, 12, true);
    if (const Region region = region_of({loop});
        !all_pairs_simple(region) || doubled_area(region) <= 0) {
      continue;
    }
    std::set<std::vector<Point>> first;
    for (std::size_t turn = 0; turn < 2; ++turn) {
      Loop turned = loop;
      std::rotate(turned.begin(),
                  turned.begin() + static_cast<std::ptrdiff_t>(turn * loop.size() / 2),
                  turned.end());
      const auto result = tessellate::triangulate_trimmed(region_of({turned}),
                                                          {{-8, -4, 0, 4, 8}, {-8, -4, 0, 4, 8}});
      std::set<std::vector<Point>> shapes;
      for (const Triangle& t : result.triangles) {
        std::vector<Point> corners{result.points[t[0]], result.points[t[1]], result.points[t[2]]};
        std::sort(corners.begin(), corners.end());
        shapes.insert(corners);
      }
      if (turn == 0) first = shapes;
      CHECK(shapes == first);
    }
  }
}

}  // namespace watertight
