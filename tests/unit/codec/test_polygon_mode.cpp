// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <utility>
#include <vector>

#include "geometry/canonical_form.h"
#include "tests/unit/codec/integer_modes.h"

using namespace watertight;

namespace {

using test::integers_of;
using test::kPolygon;
using test::read;
using test::write;

void check_round_trip(const OrientedBoundary& boundary) {
  const auto solid = integers_of(boundary);
  REQUIRE(solid);
  test::check_round_trip(kPolygon, *solid);
}

/// A box with a chimney: the hole of a facet begins at a new vertex.
OrientedBoundary box_with_chimney() {
  SolidArrays arrays;
  generated::add_box(arrays, {0, 0, 0}, {10, 10, 10});
  const Index first = static_cast<Index>(arrays.vertices.size());
  for (const double z : {10.0, 14.0}) {
    for (const auto& [x, y] : {std::pair{4.0, 4.0}, {6.0, 4.0}, {6.0, 6.0}, {4.0, 6.0}}) {
      arrays.vertices.push_back({x, y, z});
    }
  }
  SolidArrays result;
  result.vertices = arrays.vertices;
  for (Index facet = 0; facet + 1 < arrays.facet_offsets.size(); ++facet) {
    const Index ring = arrays.facet_offsets[facet];
    std::vector<Index> vertices(arrays.ring_vertices.begin() + arrays.ring_offsets[ring],
                                arrays.ring_vertices.begin() + arrays.ring_offsets[ring + 1]);
    bool is_top = true;
    for (const Index vertex : vertices) is_top = is_top && arrays.vertices[vertex][2] == 10;
    std::vector<std::vector<Index>> rings{vertices};
    if (is_top) rings.push_back({first, first + 3, first + 2, first + 1});
    generated::add_facet(result, rings);
  }
  for (Index i = 0; i < 4; ++i) {
    const Index next = (i + 1) % 4;
    generated::add_facet(result, {{first + i, first + next, first + 4 + next, first + 4 + i}});
  }
  generated::add_facet(result, {{first + 4, first + 5, first + 6, first + 7}});
  result.end_shell();
  return generated::boundary_of(std::move(result));
}

/// A box with a cavity that has an edge in common with the box: the edge has four facets.
OrientedBoundary cavity_touching_at_edge() {
  SolidArrays arrays;
  generated::add_box(arrays, {0, 0, 0}, {10, 10, 10});
  generated::add_box(arrays, {0, 0, 0}, {4, 4, 10}, generated::Turn::inward);
  auto solid = Solid::make(std::move(arrays), Lattice{}, 0);
  REQUIRE(solid);
  auto boundary = OrientedBoundary::make(geometry::merge_equal_vertices(*solid).solid);
  REQUIRE(boundary);
  return *boundary;
}

}  // namespace

TEST_CASE("mode polygon gives back every generated solid that is on a grid") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    for (const generated::NamedBoundary& named : generated::all(seed)) {
      INFO(named.name);
      if (const auto solid = integers_of(named.boundary)) test::check_round_trip(kPolygon, *solid);
    }
  }
}

TEST_CASE("mode polygon gives back facets with holes, cavities and touching shells") {
  check_round_trip(box_with_chimney());
  check_round_trip(generated::pierced_block(3));
  check_round_trip(generated::box_with_cavities(3));
  check_round_trip(generated::boxes_touching_at_edge());
  check_round_trip(generated::boxes_touching_at_vertex());
  check_round_trip(generated::block_with_touching_hole());
  check_round_trip(cavity_touching_at_edge());
  check_round_trip(generated::torus(7, 5));
  check_round_trip(generated::grid_cube(4));
}

TEST_CASE("mode polygon holds coordinates up to its bound, and refuses those beyond") {
  constexpr std::int64_t most = (std::int64_t{1} << 53) - 1;
  generated::Random random(3);
  const auto prism = integers_of(generated::random_prism(random, 7));
  REQUIRE(prism);
  for (const std::int64_t bound : {most, most + 1}) {
    codec::IntegerSolid solid = *prism;
    // The vertices alternate between the ends of an axis, so that all predictions are far off.
    for (std::size_t i = 0; i < solid.vertices.size(); ++i) {
      solid.vertices[i][i % 3] = i % 2 == 0 ? bound : -bound;
    }
    if (bound == most) {
      test::check_round_trip(kPolygon, solid);
    } else {
      CHECK_FALSE(write(kPolygon, solid));
    }
  }
}

TEST_CASE("mode polygon takes fewer bytes for a solid after others in a page") {
  generated::Random random(5);
  const auto prism = integers_of(generated::random_prism(random, 9));
  REQUIRE(prism);
  codec::PageMemory memory;
  memory.add(*prism);
  test::check_round_trip(kPolygon, *prism, memory);
  CHECK(write(kPolygon, *prism, memory)->size() < write(kPolygon, *prism)->size());
}

TEST_CASE("mode polygon writes the same bytes for the same solid") {
  generated::Random random(9);
  for (const generated::NamedBoundary& named : generated::all(4)) {
    const auto solid = integers_of(named.boundary);
    const auto shuffled = integers_of(generated::shuffled(named.boundary, random));
    if (!solid) continue;
    INFO(named.name);
    CHECK(*write(kPolygon, *solid) == *write(kPolygon, *shuffled));
  }
}

TEST_CASE("mode polygon keeps to the limits when it reads") {
  const auto bytes = write(kPolygon, *integers_of(generated::grid_cube(5)));
  REQUIRE(bytes);
  Limits few;
  few.vertices = 20;
  CHECK(read(kPolygon, *bytes, {}, few).error().code == ErrorCode::limit_exceeded);
  few = {};
  few.facets = 20;
  CHECK(read(kPolygon, *bytes, {}, few).error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("mode polygon reads hostile bytes without harm") {
  generated::Random random(17);
  for (const OrientedBoundary& boundary :
       {box_with_chimney(), cavity_touching_at_edge(), generated::pierced_block(2),
        generated::torus(6, 5), generated::random_prism(random, 12)}) {
    test::check_damaged(kPolygon, *integers_of(boundary), 400);
  }
}
