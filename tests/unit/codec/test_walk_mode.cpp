// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <utility>

#include "codec/mode_walk/walk.h"
#include "tests/unit/codec/integer_modes.h"

using namespace watertight;
using generated::Random;

namespace {

using test::integers_of;
using test::kWalk;
using test::read;
using test::write;

void check_round_trip(const std::string& name, const OrientedBoundary& boundary) {
  INFO(name);
  const auto solid = integers_of(boundary);
  REQUIRE(solid);
  test::check_round_trip(kWalk, *solid);
}

/// An octahedron around `centre`.
void add_octahedron(SolidArrays& arrays, Point centre, double radius) {
  const auto first = static_cast<Index>(arrays.vertices.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Point p = centre;
      p[axis] += sign * radius;
      arrays.vertices.push_back(p);
    }
  }
  for (Index x = 0; x < 2; ++x) {
    for (Index y = 0; y < 2; ++y) {
      for (Index z = 0; z < 2; ++z) {
        std::vector<Index> ring{first + x, first + 2 + y, first + 4 + z};
        if ((x + y + z) % 2 == 0) std::swap(ring[1], ring[2]);
        generated::add_facet(arrays, {ring});
      }
    }
  }
  arrays.end_shell();
}

}  // namespace

TEST_CASE("mode walk brings back holes, cavities, touching shells and high genus") {
  check_round_trip("box", generated::box());
  check_round_trip("pierced block", generated::pierced_block(3));
  check_round_trip("cavities", generated::box_with_cavities(4));
  check_round_trip("torus", generated::torus(7, 5));
  check_round_trip("grid cube", generated::grid_cube(3));
  check_round_trip("Schoenhardt's polyhedron", generated::schoenhardt());
  check_round_trip("touching at an edge", generated::boxes_touching_at_edge());
  check_round_trip("touching at a vertex", generated::boxes_touching_at_vertex());
  SolidArrays arrays;
  add_octahedron(arrays, {0, 0, 0}, 5);
  check_round_trip("octahedron", generated::boundary_of(std::move(arrays)));
}

TEST_CASE("mode walk brings back every generated solid or refuses it") {
  std::size_t refused = 0;
  std::size_t held = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    for (const auto& [name, boundary] : generated::all(seed)) {
      INFO(name);
      const auto solid = integers_of(boundary);
      if (!solid) continue;  // the solid has doubles that are on no grid
      const auto bytes = write(kWalk, *solid);
      ++(bytes ? held : refused);
      if (bytes) test::check_round_trip(kWalk, *solid);
    }
  }
  CHECK(refused <= 4);  // the block whose hole touches the outer ring is refused
  CHECK(held > 100);
}

TEST_CASE("mode walk refuses solids without volume or outside its range") {
  const auto solid = integers_of(generated::box());
  REQUIRE(solid);
  codec::IntegerSolid flat = *solid;
  for (codec::GridPoint& p : flat.vertices) {
    p[0] = 3 * p[0] + p[2];
    p[2] = p[0] + 2 * p[1];
  }
  std::sort(flat.vertices.begin(), flat.vertices.end());
  REQUIRE(std::adjacent_find(flat.vertices.begin(), flat.vertices.end()) == flat.vertices.end());
  CHECK_FALSE(write(kWalk, flat));
  codec::IntegerSolid wide = *solid;
  wide.vertices.back()[0] += std::int64_t{1} << 31;
  CHECK_FALSE(write(kWalk, wide));
}

TEST_CASE("in a page mode walk takes columns from the solids before") {
  Random random(11);
  const auto solid = integers_of(generated::random_prism(random, 12));
  REQUIRE(solid);
  codec::PageMemory memory;
  memory.add(*solid);
  test::check_round_trip(kWalk, *solid, memory);
  CHECK(write(kWalk, *solid, memory)->size() < write(kWalk, *solid)->size());
}

TEST_CASE("a measuring stream walks as a writing one, and every walk is the same") {
  Random random(5);
  const auto solid = integers_of(generated::random_terrain(random, 8));
  REQUIRE(solid);
  const auto bytes = write(kWalk, *solid);
  REQUIRE(bytes);
  CHECK(*bytes == *write(kWalk, *solid));
  codec::EntropyStream meter = codec::EntropyStream::meter();
  codec::ModelBank models(codec::walk::model_layout());
  codec::IntegerSolid measured = *solid;
  codec::WriterChoice unused;
  REQUIRE(codec::walk::code_solid(meter, models, codec::PageMemory{}, measured, unused, Limits{}));
  const auto bits = meter.cost() >> codec::kCostBits;
  CHECK(bits / 8 <= bytes->size() + 2);
  CHECK(bits / 8 + 4 >= bytes->size());
}

TEST_CASE("damaged streams of mode walk end in an error or in bounded arrays") {
  Random random(7);
  for (const auto& boundary :
       {generated::pierced_block(2), generated::random_prism(random, 20), generated::torus(6, 6)}) {
    test::check_damaged(kWalk, *integers_of(boundary), 200);
  }
}

TEST_CASE("reading in mode walk stops at the limit of vertices") {
  const auto bytes = write(kWalk, *integers_of(generated::pierced_block(3)));
  REQUIRE(bytes);
  Limits few;
  few.vertices = 10;
  CHECK(read(kWalk, *bytes, {}, few).error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("the walk refuses surfaces that are not closed") {
  const std::vector<Point> points{{0, 0, 0}, {0, 0, 9}, {0, 9, 0}, {9, 0, 0}};
  const auto delaunay = delaunay::canonical_delaunay(points);
  REQUIRE(delaunay);
  const codec::ModelLayout& layout = codec::walk::model_layout();
  const auto measure = [&](std::vector<Triangle> triangles) {
    codec::ModelBank models(layout);
    codec::EntropyStream meter = codec::EntropyStream::meter();
    codec::walk::BoundaryMesh mesh;
    mesh.component_first.push_back(static_cast<Index>(triangles.size()));
    mesh.triangles = std::move(triangles);
    return codec::walk::code_boundary_walk(meter, models, points, *delaunay, mesh);
  };
  const Triangle a{0, 1, 2};
  const Triangle b{0, 2, 3};
  const Triangle c{0, 3, 1};
  const Triangle d{1, 3, 2};
  CHECK(measure({a, b, c, d}));
  CHECK_FALSE(measure({a, b, c}));
  CHECK_FALSE(measure({a, b, c, d, a}));
  CHECK_FALSE(measure({a, b, c, {1, 2, 3}}));
  CHECK_FALSE(measure({a, b, c, {1, 3, 4}}));
}
