// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rings on small grids, where points lie on lines and circles with others, judged in whole numbers.
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "tessellate/few_vertices.h"

namespace watertight::test_few_vertices {
namespace {

using Spot = std::array<std::int64_t, 2>;
using tessellate::FewVertices;

std::int64_t turn(const Spot& a, const Spot& b, const Spot& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Above 0 if d is in the circle through a, b and c, which are counterclockwise.
std::int64_t in_circle(const Spot& a, const Spot& b, const Spot& c, const Spot& d) {
  std::array<std::array<std::int64_t, 3>, 3> m{};
  const std::array<Spot, 3> corners{a, b, c};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t x = corners[i][0] - d[0];
    const std::int64_t y = corners[i][1] - d[1];
    m[i] = {x, y, x * x + y * y};
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

int sign(std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

bool is_on(const Spot& a, const Spot& b, const Spot& p) {
  return turn(a, b, p) == 0 && std::min(a, b) <= p && p <= std::max(a, b);
}

/// Whether two segments have a point in common.
bool do_meet(const Spot& a, const Spot& b, const Spot& c, const Spot& d) {
  if (is_on(a, b, c) || is_on(a, b, d) || is_on(c, d, a) || is_on(c, d, b)) return true;
  return sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 &&
         sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0;
}

bool is_simple(const std::vector<Spot>& ring) {
  const std::size_t count = ring.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Spot& a = ring[i];
    const Spot& b = ring[(i + 1) % count];
    const Spot& c = ring[(i + 2) % count];
    if (a == b || is_on(a, b, c) || is_on(b, c, a)) return false;
    for (std::size_t k = i + 2; k < count; ++k) {
      if ((k + 1) % count == i) continue;
      if (do_meet(a, b, ring[k], ring[(k + 1) % count])) return false;
    }
  }
  return true;
}

std::vector<FewVertices::Corners> triangles_of(const std::vector<Spot>& ring) {
  std::vector<FewVertices::PlanePoint> points;
  for (const auto& [x, y] : ring) {
    points.push_back({static_cast<double>(x), static_cast<double>(y)});
  }
  FewVertices few;
  const auto found = few.triangulate(points);
  return {found.begin(), found.end()};
}

/// Whether an edge between two triangles stays: ties are broken as tessellate/facets.cpp says.
bool is_delaunay(const Spot& from, const Spot& to, const Spot& left, const Spot& right) {
  const std::int64_t in = in_circle(from, to, left, right);
  return in < 0 || (in == 0 && std::max(from, to) < std::max(left, right));
}

void check(const std::vector<Spot>& ring) {
  const auto triangles = triangles_of(ring);
  const std::size_t count = ring.size();
  REQUIRE(triangles.size() == count - 2);
  std::int64_t area = 0;
  for (std::size_t i = 1; i + 1 < count; ++i) area += turn(ring[0], ring[i], ring[i + 1]);
  std::map<std::array<std::size_t, 2>, std::size_t> third;  // by directed edge
  std::int64_t sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const std::int64_t own = turn(ring[a], ring[b], ring[c]);
    REQUIRE(own > 0);
    sum += own;
    REQUIRE(third.emplace(std::array<std::size_t, 2>{a, b}, c).second);
    REQUIRE(third.emplace(std::array<std::size_t, 2>{b, c}, a).second);
    REQUIRE(third.emplace(std::array<std::size_t, 2>{c, a}, b).second);
  }
  REQUIRE(sum == std::abs(area));
  for (const auto& [edge, left] : third) {
    const auto other = third.find({edge[1], edge[0]});
    const std::size_t way = (edge[0] + count - edge[1]) % count;
    REQUIRE((other == third.end()) == (way == 1 || way == count - 1));
    if (other == third.end()) continue;
    REQUIRE(is_delaunay(ring[edge[0]], ring[edge[1]], ring[left], ring[other->second]));
  }
}

/// A ring through random points of a grid; crossing edges are uncrossed a few times.
std::vector<Spot> random_ring(std::mt19937& random, std::size_t count, std::int64_t size) {
  std::uniform_int_distribution<std::int64_t> at(0, size);
  std::vector<Spot> ring(count);
  for (Spot& spot : ring) spot = {at(random), at(random)};
  for (int round = 0; round < 30; ++round) {
    for (std::size_t i = 0; i + 2 < count; ++i) {
      for (std::size_t k = i + 2; k < count; ++k) {
        if (!do_meet(ring[i], ring[i + 1], ring[k], ring[(k + 1) % count])) continue;
        std::reverse(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     ring.begin() + static_cast<std::ptrdiff_t>(k) + 1);
      }
    }
  }
  return ring;
}

TEST_CASE("simple rings of few vertices get their Delaunay triangles, other rings none") {
  std::mt19937 random(7);
  std::size_t simple = 0;
  for (int i = 0; i < 10'000; ++i) {
    const std::size_t count = 3 + random() % (FewVertices::kMost - 2);
    const auto ring = random_ring(random, count, i % 3 == 0 ? 5 : i % 3 == 1 ? 12 : 1000);
    CAPTURE(ring);
    if (is_simple(ring)) {
      ++simple;
      check(ring);
    } else {
      REQUIRE(triangles_of(ring).empty());
    }
  }
  CHECK(simple > 1'500);
}

TEST_CASE("vertices on the edges of a square are corners of triangles") {
  std::vector<Spot> ring;
  for (std::int64_t i = 0; i < 6; ++i) ring.push_back({i, 0});
  for (std::int64_t i = 0; i < 6; ++i) ring.push_back({6, i});
  for (std::int64_t i = 6; i > 0; --i) ring.push_back({i, 6});
  for (std::int64_t i = 6; i > 0; --i) ring.push_back({0, i});
  check(ring);
  std::reverse(ring.begin(), ring.end());
  check(ring);
}

}  // namespace
}  // namespace watertight::test_few_vertices
