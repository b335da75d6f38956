// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the oracle of bench/verdict with verdicts that were found by hand.
#include <catch2/catch_test_macros.hpp>

#include "bench/verdict/oracle.h"
#include "tests/solids/builders.h"

namespace watertight::verdict {
namespace {

using solids::box;
using solids::Facet;
using solids::inside_out;
using solids::join;
using solids::Ring;
using solids::Shape;
using solids::Shell;
using solids::solid_of;
using solids::tetrahedron;

std::set<int> codes(const Shape& shape) { return truth_of(solid_of(shape)).codes; }

Shell cavity(const Shell& shell) { return inside_out(shell); }

/// A box with its corner (0,0,0) cut off by three quadrilaterals that meet there; a cavity with the
/// corners a, b, d has edges along their diagonals.
Shape sealed_corner(double inset) {
  const Point o{0, 0, 0};
  const Point a{10000, inset, inset};
  const Point b{inset, 10000, inset};
  const Point d{inset, inset, 10000};
  const Point ab{11000, 11000, 0};
  const Point ad{11000, 0, 11000};
  const Point bd{0, 11000, 11000};
  const Point e{20000, 20000, 20000};
  const Point f{10000, 10000, 10000};
  const Shell outer{{{o, b, ab, a}}, {{o, d, bd, b}}, {{o, a, ad, d}}, {{e, ab, b}}, {{e, a, ab}},
                    {{e, bd, d}},    {{e, b, bd}},    {{e, ad, a}},    {{e, d, ad}}};
  return {outer, cavity(tetrahedron(a, b, d, f))};
}

TEST_CASE("the oracle accepts boxes, cavities and tunnels") {
  CHECK(codes({box({0, 0, 0}, {10, 20, 30})}).empty());
  CHECK(codes({box({0, 0, 0}, {9, 9, 9}), cavity(box({3, 3, 3}, {6, 6, 6}))}).empty());
  CHECK(codes({solids::pierced_box(2)}).empty());
  CHECK(codes({solids::schoenhardt()}).empty());
  CHECK(codes({solids::gable_house(10, 8, 3, 5)}).empty());
}

TEST_CASE("the oracle accepts cavities that touch in vertices and edges") {
  const Shell room = box({0, 0, 0}, {20, 20, 20});
  const Shell touching = tetrahedron({10, 5, 0}, {10, 15, 0}, {8, 10, 5}, {12, 10, 5});
  CHECK(codes({room, cavity(touching)}).empty());
  CHECK(
      codes({room, cavity(box({2, 2, 2}, {5, 5, 5})), cavity(box({5, 5, 2}, {8, 8, 5}))}).empty());
}

TEST_CASE("the oracle refuses shells that are not closed 2-manifolds") {
  const Shell cube = box({0, 0, 0}, {2, 2, 2});
  Shell open = cube;
  open.pop_back();
  CHECK(codes({open}).count(302) == 1);
  // The parts have an edge in common.
  CHECK(codes({join(cube, box({2, 2, 0}, {4, 4, 2}))}).count(303) == 1);
  // The parts have a vertex in common.
  CHECK(codes({join(cube, box({2, 2, 2}, {4, 4, 4}))}).count(303) == 1);
  CHECK(codes({join(cube, box({5, 5, 5}, {6, 6, 6}))}).count(305) == 1);
  CHECK(codes({join(cube, box({1, 1, 1}, {3, 3, 3}))}).count(306) == 1);
  Shell turned = cube;
  turned.front() = solids::turned_over(turned.front());
  CHECK(codes({turned}).count(307) == 1);
  CHECK(codes({inside_out(cube)}) == std::set<int>{405});
}

TEST_CASE("the oracle judges shells beside each other") {
  const Shell room = box({0, 0, 0}, {20, 20, 20});
  CHECK(codes({room, box({3, 3, 3}, {6, 6, 6})}) == std::set<int>{405});
  CHECK(codes({room, cavity(box({30, 3, 3}, {36, 6, 6}))}) == std::set<int>{403});
  CHECK(codes({room, cavity(box({15, 3, 3}, {36, 6, 6}))}) == std::set<int>{401});
  CHECK(codes({room, cavity(box({0, 3, 3}, {6, 6, 6}))}).count(401) == 1);
  const Shell big = box({2, 2, 2}, {9, 9, 9});
  CHECK(codes({room, cavity(big), cavity(box({3, 3, 3}, {4, 4, 4}))}) == std::set<int>{401});
  const Shell inscribed = tetrahedron({20, 20, 0}, {0, 0, 0}, {20, 0, 20}, {0, 20, 20});
  CHECK(codes({room, cavity(inscribed)}) == std::set<int>{404});
}

TEST_CASE("the oracle follows the canonical diagonals of quads that are not planar") {
  CHECK(codes(sealed_corner(0)) == std::set<int>{404});
  CHECK(codes(sealed_corner(4)) == std::set<int>{404});
  Shape open = sealed_corner(4);
  for (Facet& facet : open[1]) {  // moves one corner of the cavity inward
    for (Ring& ring : facet) {
      for (Point& p : ring) {
        if (p.z == 10000 && p.x == 4) p = {1000, 1000, 9000};
      }
    }
  }
  CHECK(codes(open).empty());
}

TEST_CASE("the oracle refuses walls that cross along a diagonal of both") {
  // The walls from a to d and from f to c pass through the line from b to e.
  const Point a{-10, -5, 10}, b{0, 0, 10}, c{14, 7, 10}, c0{14, 7, 0}, b0{0, 0, 0}, a0{-10, -5, 0};
  const Point f{14, -7, 10}, f0{14, -7, 0}, g{-10, 5, 10}, g0{-10, 5, 0};
  const Shell prism{{{a, b, c, c0, b0, a0}}, {{c, f, f0, c0}}, {{f, b, g, g0, b0, f0}},
                    {{g, a, a0, g0}},        {{f, c, b}},      {{a, g, b}},
                    {{c0, f0, b0}},          {{g0, a0, b0}}};
  CHECK(codes({prism}).count(306) == 1);
}

TEST_CASE(
    "the oracle accepts a hole that touches the outline where the facet across has the vertex") {
  const Point v{5, 0, 10};
  const Point apex{5, 3, 8};
  const Ring hole{v, {3, 4, 10}, {7, 4, 10}};
  Shell shell = box({0, 0, 0}, {10, 10, 10});
  const auto is_top = [](const Facet& facet) {
    for (const Point& p : facet[0]) {
      if (p.z != 10) return false;
    }
    return true;
  };
  for (Facet& facet : shell) {
    if (is_top(facet)) facet.push_back(hole);
  }
  for (std::size_t k = 0; k < 3; ++k) shell.push_back({{hole[(k + 1) % 3], hole[k], apex}});
  CHECK(codes({shell}).count(302) == 1);
  for (Facet& facet : shell) {
    Ring& ring = facet[0];
    for (std::size_t k = 0; k < ring.size() && !is_top(facet); ++k) {
      const Point& next = ring[(k + 1) % ring.size()];
      if (ring[k].y == 0 && next.y == 0 && ring[k].z == 10 && next.z == 10 && ring.size() == 4) {
        ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(k) + 1, v);
        break;
      }
    }
  }
  CHECK(codes({shell}).empty());
}

TEST_CASE("the oracle compares pairs") {
  const Solid cube = solid_of(Shape{box({0, 0, 0}, {4, 4, 4})});
  const auto pair = [&](const Shell& shell) { return pair_truth_of(cube, solid_of(Shape{shell})); };
  CHECK(pair(box({0, 0, 0}, {4, 4, 4})).are_equal);
  CHECK(pair(box({1, 1, 1}, {2, 2, 2})).overlap);
  CHECK(pair(box({0, 0, 0}, {4, 4, 2})).overlap);
  CHECK(pair(box({4, 1, 1}, {8, 2, 2})).share_area);
  CHECK_FALSE(pair(box({4, 1, 1}, {8, 2, 2})).overlap);
  CHECK_FALSE(pair(box({4, 4, 1}, {8, 8, 2})).share_area);
}

}  // namespace
}  // namespace watertight::verdict
