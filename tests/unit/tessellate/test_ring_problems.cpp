// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <cmath>
#include <random>

#include "tessellate/ring_problems.h"
#include "tests/unit/tessellate/facet_solid.h"

using namespace watertight;

namespace {

using test::facet_solid;
using test::Ring;
using Kinds = std::vector<tessellate::RingProblemKind>;

std::vector<tessellate::RingProblem> problems_of(const std::vector<Ring>& rings) {
  const tessellate::RingProblems result = tessellate::ring_problems(facet_solid(rings), 0, 100);
  CHECK(result.is_complete);
  return result.problems;
}

Kinds kinds_of(const std::vector<Ring>& rings) {
  Kinds kinds;
  for (const tessellate::RingProblem& problem : problems_of(rings)) kinds.push_back(problem.kind);
  return kinds;
}

Ring square(double low, double high) {
  return {{low, low, 0}, {high, low, 0}, {high, high, 0}, {low, high, 0}};
}

}  // namespace

TEST_CASE("simple rings that share at most vertices have no problems") {
  CHECK(kinds_of({square(0, 9)}).empty());
  CHECK(kinds_of({square(0, 9), square(2, 4)}).empty());
  CHECK(kinds_of({square(0, 9), square(0, 4)}) != Kinds{});  // the rings share parts of edges
  CHECK(kinds_of({square(0, 9), {{0, 0, 0}, {2, 5, 0}, {5, 2, 0}}}).empty());
  CHECK(kinds_of({square(0, 9), square(1, 3), square(3, 5)}).empty());
}

TEST_CASE("rings that touch inside edges have no problem; other contacts keep their edges") {
  const Ring at_edge{{0, 5, 0}, {3, 4, 0}, {3, 6, 0}};
  CHECK(kinds_of({square(0, 9), at_edge}).empty());
  CHECK(kinds_of({square(0, 9), at_edge, {{3, 5, 0}, {6, 4, 0}, {6, 6, 0}}}).empty());
  // A third ring crosses the first hole; the numbers of edges are those of the submitted rings.
  const auto crossed = problems_of({square(0, 9), at_edge, {{2, 1, 0}, {8, 1, 0}, {2, 8, 0}}});
  REQUIRE_FALSE(crossed.empty());
  for (const tessellate::RingProblem& problem : crossed) {
    CHECK(problem.kind == tessellate::RingProblemKind::rings_meet);
    CHECK(problem.ring == 1);
    CHECK(problem.edge < 3);
    CHECK(problem.other_edge < 3);
  }
  // The hole overlaps the fourth edge of the exterior ring.
  const auto along = problems_of({square(0, 9), {{0, 4, 0}, {3, 5, 0}, {0, 6, 0}}});
  REQUIRE(along.size() == 1);
  CHECK(along[0].edge == 3);
  CHECK(along[0].other_edge == 2);
  // The hole touches the exterior ring from outside.
  CHECK(kinds_of({square(0, 9), {{9, 5, 0}, {12, 4, 0}, {12, 6, 0}}}) ==
        Kinds{tessellate::RingProblemKind::outside_exterior});
  // Two tips of the exterior ring are inside one edge of a hole; the hole is inside between them,
  // and outside beyond.
  CHECK(kinds_of({{{0, 0, 0},
                   {4, 0, 0},
                   {5, 2, 0},
                   {6, 0, 0},
                   {7, 0, 0},
                   {8, 2, 0},
                   {9, 0, 0},
                   {12, 0, 0},
                   {12, 9, 0},
                   {0, 9, 0}},
                  {{4, 2, 0}, {10, 2, 0}, {5, 5, 0}}})
            .empty());
  CHECK(kinds_of({{{0, 0, 0},
                   {5, 0, 0},
                   {5, 2, 0},
                   {4, 4, 0},
                   {9, 4, 0},
                   {8, 2, 0},
                   {8, 0, 0},
                   {12, 0, 0},
                   {12, 9, 0},
                   {0, 9, 0}},
                  {{1, 2, 0}, {10, 2, 0}, {6, 7, 0}}}) != Kinds{});
}

TEST_CASE("a bow tie meets itself in the exact crossing point") {
  const auto problems = problems_of({{{0, 0, 0}, {3, 3, 3}, {3, 0, 3}, {0, 3, 0}}});
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].kind == tessellate::RingProblemKind::self_contact);
  CHECK(problems[0].edge == 0);
  CHECK(problems[0].other_edge == 2);
  CHECK(problems[0].witness == Point{1.5, 1.5, 1.5});
}

TEST_CASE("touching, spikes and repeated vertices are contacts of a ring with itself") {
  const Kinds once{tessellate::RingProblemKind::self_contact};
  CHECK(kinds_of({{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {4, 0, 0}, {0, 8, 0}}}) == once);
  CHECK(kinds_of({{{0, 0, 0}, {4, 0, 0}, {2, 2, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 0}}}) == once);
  CHECK(kinds_of({{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {8, 4, 0}, {0, 8, 0}}}) == once);
}

TEST_CASE("collapsed and duplicate rings are reported") {
  CHECK(kinds_of({{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}}}) ==
        Kinds{tessellate::RingProblemKind::collapsed});
  CHECK(kinds_of({square(0, 9), square(2, 4), square(2, 4)}) ==
        Kinds{tessellate::RingProblemKind::same_ring});
}

TEST_CASE("rings that cross, nest or lie outside are distinguished") {
  CHECK(kinds_of({square(0, 9), square(5, 12)}) ==
        Kinds{tessellate::RingProblemKind::rings_meet, tessellate::RingProblemKind::rings_meet});
  CHECK(kinds_of({square(0, 9), square(12, 14)}) ==
        Kinds{tessellate::RingProblemKind::outside_exterior});
  CHECK(kinds_of({square(0, 9), square(1, 8), square(3, 4)}) ==
        Kinds{tessellate::RingProblemKind::nested});
  // The hole crosses the exterior ring in two of its vertices only.
  CHECK(kinds_of({square(0, 9), {{9, 0, 0}, {12, 12, 0}, {0, 9, 0}, {4, 4, 0}}}) ==
        Kinds{tessellate::RingProblemKind::rings_meet});
  // All vertices of the hole are vertices of the exterior ring, so that the edges decide.
  CHECK(kinds_of({{{0, 0, 0}, {9, 0, 0}, {5, 5, 0}, {0, 9, 0}},
                  {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}}) != Kinds{});
}

TEST_CASE("problems are found whichever way the facet lies in space") {
  for (int axis = 0; axis < 3; ++axis) {
    Ring ring{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 6, 0}};
    for (Point& p : ring) {
      Point turned;
      for (int i = 0; i < 3; ++i) turned[(i + axis) % 3] = p[i];
      p = turned;
    }
    CHECK(kinds_of({ring}) == Kinds{tessellate::RingProblemKind::self_contact});
  }
}

TEST_CASE("a facet is triangulated exactly when its rings have no problem") {
  std::mt19937 random(3);
  std::size_t triangulated = 0;
  std::size_t wrong = 0;
  const auto point = [&] { return Point{double(random() % 7), double(random() % 7), 0}; };
  for (int round = 0; round < 20000; ++round) {
    std::vector<Ring> rings(1 + random() % 2);
    for (Ring& ring : rings) {
      while (ring.size() < 3 + random() % 3) {
        const Point p = point();
        if (ring.empty() || (ring.back() != p && ring.front() != p)) ring.push_back(p);
      }
    }
    const Solid solid = facet_solid(rings);
    const bool is_good =
        tessellate::triangulate_facets(solid).state[0] == tessellate::FacetState::triangulated;
    const bool has_problems = !tessellate::ring_problems(solid, 0, 100).problems.empty();
    triangulated += is_good ? 1 : 0;
    if (is_good == has_problems) ++wrong;
  }
  CHECK(wrong == 0);
  CHECK(triangulated > 1000);
}

TEST_CASE("many problems are cut off, and the result says so") {
  Ring ring;
  for (int i = 0; i < 60; ++i) ring.push_back({double(i % 2 * 100), double(i * 7 % 60), 0});
  const tessellate::RingProblems result = tessellate::ring_problems(facet_solid({ring}), 0, 10);
  CHECK(result.problems.size() <= 10);
  CHECK_FALSE(result.is_complete);
}

TEST_CASE("a star with millions of crossings costs no more than the problems that are kept") {
  Ring ring;  // 2,001 edges across a circle: two million crossings
  for (int i = 0; i < 2001; ++i) {
    const double angle = 2 * 3.14159265358979 * i * 1000 / 2001;
    ring.push_back({std::round(1e6 * std::cos(angle)), std::round(1e6 * std::sin(angle)), 0});
  }
  const auto start = std::chrono::steady_clock::now();
  const tessellate::RingProblems result = tessellate::ring_problems(facet_solid({ring}), 0, 100);
  CHECK(result.problems.size() <= 100);
  CHECK_FALSE(result.is_complete);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
}

TEST_CASE("a nested hole among thousands is found by the holes near it") {
  std::vector<Ring> rings{square(0, 100000)};
  for (int i = 0; i < 2000; ++i) rings.push_back(square(10 * i + 1, 10 * i + 9));
  rings.push_back(square(13, 15));
  const tessellate::RingProblems result = tessellate::ring_problems(facet_solid(rings), 0, 100);
  REQUIRE(result.problems.size() == 1);
  CHECK(result.problems[0].kind == tessellate::RingProblemKind::nested);
  CHECK(result.problems[0].other_ring == 2);
}

TEST_CASE("the turn of a ring is exact and independent of its start") {
  std::vector<Ring> rings{square(0, 4)};
  for (int start = 0; start < 4; ++start) {
    CHECK(tessellate::ring_turn(facet_solid(rings), 0, 2) == 1);
    std::rotate(rings[0].begin(), rings[0].begin() + 1, rings[0].end());
  }
  std::reverse(rings[0].begin(), rings[0].end());
  CHECK(tessellate::ring_turn(facet_solid(rings), 0, 2) == -1);
}

TEST_CASE("the search for ring problems can be cancelled") {
  Ring ring;  // a comb whose teeth overlap in one axis
  for (int i = 0; i < 2000; ++i) {
    ring.push_back({0.0, 2.0 * i, 0});
    ring.push_back({1000.0, 2.0 * i + 1, 0});
  }
  ring.push_back({-10, 4000, 0});
  ring.push_back({-10, 0, 0});
  const Solid solid = facet_solid({ring});
  int asked = 0;
  const tessellate::RingProblems result =
      tessellate::ring_problems(solid, 0, 100, [&] { return ++asked == 2; });
  CHECK_FALSE(result.is_complete);
  CHECK(asked == 2);
  CHECK(tessellate::ring_problems(solid, 0, 100, [] { return false; }).is_complete);
}
