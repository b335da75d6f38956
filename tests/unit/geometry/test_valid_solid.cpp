// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "tests/unit/geometry/solids.h"

namespace watertight::test {
namespace {

std::string reason(Result<OrientedBoundary> boundary) {
  REQUIRE_FALSE(boundary.has_value());
  CHECK(boundary.error().code == ErrorCode::not_encodable);
  return boundary.error().message;
}

struct BoxParts {
  std::vector<Point> vertices;
  Shell shell;
  BoxParts() { shell = box_shell(vertices, {0, 0, 0}, {1, 1, 1}, true); }
  Result<OrientedBoundary> make() const {
    return OrientedBoundary::make(solid_of(vertices, {shell}));
  }
};

}  // namespace

TEST_CASE("a closed oriented solid with holes and cavities is an oriented boundary") {
  CHECK(OrientedBoundary::make(tunnel_solid()).has_value());
}

TEST_CASE("a missing facet is named by its first unmatched edge") {
  BoxParts box;
  box.shell.erase(box.shell.begin());  // removes the ring 0 2 3 1 with the edges 0-2, 2-3, 3-1, 1-0
  CHECK(reason(box.make()) == "the edge from vertex 0 to vertex 1 is not matched by its reverse");
}

TEST_CASE("a flipped facet leaves unmatched edges") {
  BoxParts box;
  Ring& ring = box.shell[1][0];
  ring = Ring(ring.rbegin(), ring.rend());
  CHECK(reason(box.make()).find("not matched by its reverse") != std::string::npos);
}

TEST_CASE("an edge used twice in each direction is matched") {
  // Two boxes share the edge 3-7 of the first box, where four facets meet.
  std::vector<Point> vertices;
  Shell shell = box_shell(vertices, {0, 0, 0}, {1, 1, 1}, true);
  Shell second = box_shell(vertices, {1, 1, 0}, {2, 2, 1}, true);
  shell.insert(shell.end(), second.begin(), second.end());
  const Solid solid = geometry::merge_equal_vertices(solid_of(vertices, {shell})).solid;
  REQUIRE(solid.vertex_count() == 14);
  CHECK(OrientedBoundary::make(solid).has_value());
}

TEST_CASE("an edge is matched by its parts where a ring of its facet touches it") {
  // The upper facet has a triangular pit whose vertex 8 lies inside the edge of the facet from 5 to
  // 4.
  std::vector<Point> vertices;
  Shell shell = box_shell(vertices, {0, 0, 0}, {8, 8, 8}, true);
  vertices.insert(vertices.end(), {{4, 0, 8}, {6, 4, 8}, {2, 4, 8}, {4, 3, 6}});
  const auto has_edge = [](const Ring& ring, Index from, Index to) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ring[i] == from && ring[(i + 1) % ring.size()] == to) return true;
    }
    return false;
  };
  for (Facet& facet : shell) {
    if (has_edge(facet[0], 4, 5)) facet.push_back({8, 10, 9});
  }
  shell.insert(shell.end(), {{{8, 9, 11}}, {{9, 10, 11}}, {{10, 8, 11}}});
  // The facet across has the edge undivided: the boundary is closed as it stands.
  CHECK(OrientedBoundary::make(solid_of(vertices, {shell})).has_value());
  for (Facet& facet : shell) {
    if (!has_edge(facet[0], 5, 4)) continue;
    facet[0].insert(std::find(facet[0].begin(), facet[0].end(), Index{5}) + 1, 8);
  }
  const Solid solid = solid_of(vertices, {shell});
  const auto boundary = OrientedBoundary::make(solid);
  REQUIRE(boundary.has_value());
  CHECK(boundary->solid() == solid);
  // The vertex is one step beside the edge, so it splits no edge.
  vertices[8].y = 1;
  CHECK(reason(OrientedBoundary::make(solid_of(vertices, {shell})))
            .find("not matched by its reverse") != std::string::npos);
}

TEST_CASE("rings that are short or visit a vertex twice are refused") {
  BoxParts box;
  box.shell[2][0] = {0, 1};
  CHECK(reason(box.make()) == "ring 2 has fewer than 3 vertices");
  box.shell[2][0] = {0, 1, 5, 1};
  CHECK(reason(box.make()) == "ring 2 visits vertex 1 twice");
}

TEST_CASE("facets without rings, shells without facets and empty solids are refused") {
  BoxParts box;
  box.shell.push_back({});
  CHECK(reason(box.make()) == "facet 6 has no rings");
  CHECK(reason(OrientedBoundary::make(solid_of(box.vertices, {BoxParts().shell, {}}))) ==
        "shell 1 has no facets");
  CHECK(reason(OrientedBoundary::make(solid_of({}, {}))) == "the solid has no facets");
}

TEST_CASE("equal vertices that were not merged are refused") {
  std::vector<Point> vertices;
  Shell shell = box_shell(vertices, {0, 0, 0}, {1, 1, 1}, true);
  Shell second = box_shell(vertices, {1, 1, 1}, {2, 2, 2}, true);
  shell.insert(shell.end(), second.begin(), second.end());
  CHECK(reason(OrientedBoundary::make(solid_of(vertices, {shell}))) ==
        "vertices 7 and 8 are equal and have not been merged");
}

TEST_CASE("a solid refuses a lattice that is not one") {
  Lattice lattice;
  lattice.step[1].mantissa = 0;
  CHECK_FALSE(Solid::make(SolidArrays{}, lattice, 0).has_value());
  lattice = {};
  lattice.origin[2] = {1, 2'000'000'000};
  CHECK_FALSE(Solid::make(SolidArrays{}, lattice, 0).has_value());
  lattice = {};
  lattice.kind = LatticeKind::float64;
  CHECK(Solid::make(SolidArrays{}, lattice, 0).has_value());
  lattice.origin[2] = {1, 0};
  CHECK_FALSE(Solid::make(SolidArrays{}, lattice, 0).has_value());
}

}  // namespace watertight::test
