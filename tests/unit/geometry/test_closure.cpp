// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/closure.h"

#include "solids.h"

namespace watertight {
namespace {

using geometry::Closure;
using geometry::closure_of;

const Point kMin{0, 0, 0};
const Point kMax{2, 3, 4};

TEST_CASE("the facets of a box close, whichever way they turn") {
  std::vector<Point> vertices;
  test::Shell shell = test::box_shell(vertices, kMin, kMax, true);
  std::swap(shell[1][0][0], shell[1][0][2]);  // turns the facet over
  const Closure closure = closure_of(test::solid_of(vertices, {shell}));
  CHECK(closure.is_one_shell());
  CHECK(closure.open_edges == 0);
}

TEST_CASE("a missing facet opens its edges") {
  std::vector<Point> vertices;
  test::Shell shell = test::box_shell(vertices, kMin, kMax, true);
  shell.pop_back();
  const Closure closure = closure_of(test::solid_of(vertices, {shell}));
  CHECK_FALSE(closure.is_closed);
  CHECK(closure.open_edges == 4);
  CHECK(closure.parts == 1);
}

TEST_CASE("facets that repeat their vertices close where the vertices are equal") {
  std::vector<Point> vertices;
  test::Shell apart;
  for (std::size_t facet = 0; facet < 6; ++facet) {
    apart.push_back(test::box_shell(vertices, kMin, kMax, true)[facet]);
  }
  CHECK(closure_of(test::solid_of(vertices, {apart})).is_one_shell());
}

TEST_CASE("boxes apart or at one edge are no single shell") {
  std::vector<Point> vertices;
  test::Shell two = test::box_shell(vertices, kMin, kMax, true);
  test::Shell other = test::box_shell(vertices, {5, 5, 5}, {6, 6, 6}, true);
  two.insert(two.end(), other.begin(), other.end());
  const Closure apart = closure_of(test::solid_of(vertices, {two}));
  CHECK(apart.is_closed);
  CHECK(apart.parts == 2);
  CHECK_FALSE(apart.is_one_shell());

  std::vector<Point> corners;
  test::Shell joined = test::box_shell(corners, kMin, kMax, true);
  other = test::box_shell(corners, {2, 3, 0}, {4, 5, 4}, true);
  joined.insert(joined.end(), other.begin(), other.end());
  const Closure at_edge = closure_of(test::solid_of(corners, {joined}));
  CHECK_FALSE(at_edge.is_closed);
  CHECK(at_edge.open_edges == 1);
  CHECK(at_edge.parts == 1);
}

TEST_CASE("nothing and a doubled point do not close") {
  CHECK_FALSE(closure_of(test::solid_of({}, {{}})).is_closed);
  std::vector<Point> vertices;
  test::Shell shell = test::box_shell(vertices, kMin, kMax, true);
  shell[0][0].push_back(shell[0][0].back());  // an edge without length
  CHECK(closure_of(test::solid_of(vertices, {shell})).is_one_shell());
}

}  // namespace
}  // namespace watertight
