// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/facets.h"
#include "tests/unit/validate/solids.h"
#include "validate/overlap/point_location.h"

using namespace watertight;
using namespace watertight::test;

TEST_CASE("points of a grid are located in a box of the grid, corners, edges and faces included") {
  const Solid solid = geometry::merge_equal_vertices(solid_of({box({1, 1, 1}, {4, 4, 4})})).solid;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  for (int i = 0; i < 216; ++i) {
    const Point p{double(i % 6), double(i / 6 % 6), double(i / 36)};
    int inside = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const int here = p[axis] > 1 && p[axis] < 4 ? 1 : p[axis] == 1 || p[axis] == 4 ? 0 : -1;
      inside = std::min(inside, here);
    }
    CHECK(static_cast<int>(validate::locate(p, solid.vertices(), facets.triangles)) == inside);
  }
}

TEST_CASE("points above, below and beside slanted surfaces are located") {
  const Solid solid = geometry::merge_equal_vertices(solid_of({corner({0, 0, 0}, 6)})).solid;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  for (int i = 0; i < 512; ++i) {
    const Point p{double(i % 8), double(i / 8 % 8), double(i / 64)};
    const double sum = p.x + p.y + p.z;
    const bool is_on = sum <= 6 && (sum == 6 || p.x == 0 || p.y == 0 || p.z == 0);
    const validate::Location expected = is_on     ? validate::Location::boundary
                                        : sum < 6 ? validate::Location::inside
                                                  : validate::Location::outside;
    CHECK(validate::locate(p, solid.vertices(), facets.triangles) == expected);
  }
}
