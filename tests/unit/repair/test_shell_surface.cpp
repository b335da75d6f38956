// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>

#include "repair/shell_surface.h"
#include "tests/solids/builders.h"

namespace watertight::repair {
namespace {

/// A box without its lid, and points inside and above.
EditedSolid open_box() {
  solids::Shell shell = solids::box({0, 0, 0}, {8, 8, 8});
  std::erase_if(shell, [](const solids::Facet& facet) {
    return std::ranges::all_of(facet[0], [](const Point& p) { return p.z == 8; });
  });
  EditedSolid solid = edited(solids::solid_of({shell}));
  for (const Point& extra : {Point{4, 4, 4}, Point{4, 4, 12}, Point{4, 4, -4}}) {
    solid.vertices.push_back(extra);
  }
  return solid;
}

Index vertex_at(const EditedSolid& solid, const Point& place) {
  const auto found = std::ranges::find(solid.vertices, place);
  REQUIRE(found != solid.vertices.end());
  return static_cast<Index>(found - solid.vertices.begin());
}

TEST_CASE("triangles have room where they meet a shell in common vertices and open edges") {
  const EditedSolid solid = open_box();
  const ShellSurface surface(solid);
  const auto at = [&](double x, double y, double z) { return vertex_at(solid, {x, y, z}); };
  CHECK(surface.has_room_for({at(0, 0, 8), at(8, 0, 8), at(8, 8, 8)}));    // half of the lid
  CHECK(surface.has_room_for({at(0, 0, 8), at(8, 0, 8), at(4, 4, 4)}));    // from a rim inwards
  CHECK(surface.has_room_for({at(0, 0, 8), at(8, 0, 8), at(4, 4, 12)}));   // from a rim upwards
  CHECK(!surface.has_room_for({at(0, 0, 0), at(8, 0, 0), at(4, 4, 4)}));   // on a closed edge
  CHECK(!surface.has_room_for({at(0, 0, 8), at(8, 8, 8), at(4, 4, -4)}));  // through the floor
  CHECK(!surface.has_room_for({at(0, 0, 8), at(8, 0, 8), at(8, 0, 0)}));   // on a wall
}

TEST_CASE("the facet behind a border edge lies away from the hole") {
  const EditedSolid solid = open_box();
  const ShellSurface surface(solid);
  const Index a = vertex_at(solid, {0, 0, 8});
  const Index b = vertex_at(solid, {8, 0, 8});
  const geometry::Vector3 down = surface.behind(a, b);
  CHECK(down[2] < 0);
  CHECK(surface.behind(b, a) == geometry::Vector3{});  // against the sense of the missing facet
}

}  // namespace
}  // namespace watertight::repair
