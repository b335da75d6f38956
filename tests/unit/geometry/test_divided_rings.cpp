// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>

#include "geometry/divided_rings.h"
#include "tests/unit/geometry/solids.h"

namespace watertight::test {
namespace {

using Touches = std::vector<geometry::RingTouch>;

/// A solid of one facet with the given rings.
Solid facet_solid(const std::vector<Point>& vertices, const Facet& rings) {
  return solid_of(vertices, {{rings}});
}

}  // namespace

TEST_CASE("touches are given by corner and along the edge, for either direction") {
  const std::vector<Point> vertices{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {6, 0, 0},
                                    {7, 2, 0}, {5, 2, 0}, {3, 0, 0}, {4, 2, 0}, {2, 2, 0}};
  const Facet rings{{0, 1, 2, 3}, {4, 6, 5}, {7, 9, 8}};
  CHECK(geometry::ring_touches(facet_solid(vertices, rings)) == Touches{{0, 7}, {0, 4}});
  const Facet reversed{{3, 2, 1, 0}, {4, 5, 6}, {7, 8, 9}};
  CHECK(geometry::ring_touches(facet_solid(vertices, reversed)) == Touches{{2, 4}, {2, 7}});
}

TEST_CASE("vertices of the same ring, shared vertices and vertices beside an edge touch nothing") {
  const std::vector<Point> vertices{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0},
                                    {4, 0, 0}, {5, 2, 0}, {3, 2, 0}, {4, 0, 1}};
  // The vertex is in the same ring.
  CHECK(geometry::ring_touches(facet_solid(vertices, {{0, 1, 2, 4, 3}})).empty());
  CHECK(geometry::ring_touches(facet_solid(vertices, {{0, 1, 2, 4, 3}, {4, 6, 5}}))
            .empty());  // the exterior ring has the vertex too
  CHECK(geometry::ring_touches(facet_solid(vertices, {{0, 4, 1, 2, 3}, {4, 6, 5}}))
            .empty());  // the vertex is shared
  CHECK(geometry::ring_touches(facet_solid(vertices, {{0, 1, 2, 3}, {7, 6, 5}}))
            .empty());  // the vertex is one step off the edge
  CHECK(geometry::ring_touches(facet_solid(vertices, {{0, 1, 2, 3}, {4, 6, 5}})).size() == 1);
}

TEST_CASE("a vertex of two rings splits an edge of a third once") {
  const std::vector<Point> vertices{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {4, 0, 0},
                                    {5, 2, 0}, {4, 2, 0}, {3, 2, 0}, {2, 2, 0}};
  CHECK(geometry::ring_touches(facet_solid(vertices, {{0, 1, 2, 3}, {4, 6, 5}, {4, 8, 7}})) ==
        Touches{{0, 4}});
}

TEST_CASE("divided rings keep vertices, facets and shells and say where each corner comes from") {
  const std::vector<Point> vertices{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {6, 0, 0},
                                    {7, 2, 0}, {5, 2, 0}, {3, 0, 0}, {4, 2, 0}, {2, 2, 0}};
  const Solid solid = facet_solid(vertices, {{0, 1, 2, 3}, {4, 6, 5}, {7, 9, 8}});
  const geometry::DividedRings divided =
      geometry::divide_rings(solid, geometry::ring_touches(solid));
  CHECK(divided.solid == facet_solid(vertices, {{0, 7, 4, 1, 2, 3}, {4, 6, 5}, {7, 9, 8}}));
  CHECK(divided.corner_of == std::vector<Index>{0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(geometry::divide_rings(solid, {}).solid == solid);
  CHECK(geometry::ring_touches(divided.solid).empty());
}

TEST_CASE("rings that must share segments are not divided, and take no more memory for it") {
  // Each of n rings runs along one line, with its ends inside the edges of the others.
  std::vector<Point> vertices;
  Facet rings;
  for (int i = 0; i < 400; ++i) {
    const auto first = static_cast<Index>(vertices.size());
    const double x = i;
    vertices.insert(vertices.end(), {{x, 0, 0}, {1000 + x, 0, 0}, {x, 1 + x, 0}});
    rings.push_back({first, first + 1, first + 2});
  }
  CHECK(geometry::ring_touches(facet_solid(vertices, rings)).empty());
}

TEST_CASE("a plate with a thousand holes that touch its edges is searched at once") {
  std::vector<Point> vertices{{0, 0, 0}, {4000, 0, 0}, {4000, 4000, 0}, {0, 4000, 0}};
  Facet rings{{0, 1, 2, 3}};
  for (int i = 0; i < 1000; ++i) {
    const auto first = static_cast<Index>(vertices.size());
    const double x = 4 * i + 2;
    vertices.insert(vertices.end(), {{x, 0, 0}, {x - 1, 9, 0}, {x + 1, 9, 0}});
    rings.push_back({first, first + 1, first + 2});
  }
  const Touches touches = geometry::ring_touches(facet_solid(vertices, rings));
  REQUIRE(touches.size() == 1000);
  for (Index i = 0; i < 1000; ++i) CHECK(touches[i] == geometry::RingTouch{0, 4 + 3 * i});
}

}  // namespace watertight::test
