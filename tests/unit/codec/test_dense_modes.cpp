// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests mode parallelogram: round trips, refused solids, and damaged streams.
#include <catch2/catch_test_macros.hpp>
#include <utility>
#include <vector>

#include "tests/unit/codec/integer_modes.h"

namespace watertight {
namespace {

using test::kParallelogram;
using test::read;
using test::write;

codec::IntegerSolid dense_integers_of(const OrientedBoundary& boundary) {
  auto solid = test::integers_of(boundary);
  REQUIRE(solid);
  return *std::move(solid);
}

void check_round_trip(const codec::IntegerSolid& solid) {
  test::check_round_trip(kParallelogram, solid);
}

codec::IntegerSolid triangles(std::vector<codec::GridPoint> vertices,
                              const std::vector<std::vector<Triangle>>& shells) {
  codec::IntegerSolid solid;
  solid.vertices = std::move(vertices);
  for (const auto& shell : shells) {
    for (const Triangle& triangle : shell) {
      solid.ring_vertices.insert(solid.ring_vertices.end(), triangle.begin(), triangle.end());
      solid.ring_offsets.push_back(static_cast<Index>(solid.ring_vertices.size()));
      solid.facet_offsets.push_back(solid.ring_count());
    }
    solid.shell_offsets.push_back(solid.facet_count());
  }
  return solid;
}

std::vector<Triangle> tetrahedron(Index a, Index b, Index c, Index d) {
  return {{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}};
}

TEST_CASE("mode parallelogram brings triangle surfaces of any genus back") {
  check_round_trip(dense_integers_of(generated::torus(12, 9)));
  check_round_trip(dense_integers_of(generated::torus(16, 12)));
  generated::Random random(7);
  codec::IntegerSolid rough = dense_integers_of(generated::torus(16, 16));
  for (codec::GridPoint& vertex : rough.vertices) {
    for (std::int64_t& coordinate : vertex) {
      coordinate = 1000 * coordinate + static_cast<std::int64_t>(random.below(900));
    }
  }
  check_round_trip(rough);
}

TEST_CASE("mode parallelogram keeps cavities and bodies that touch") {
  const std::vector<codec::GridPoint> far{{0, 0, 0},       {900, 0, 0},     {0, 900, 0},
                                          {0, 0, 900},     {100, 100, 100}, {150, 100, 100},
                                          {100, 150, 100}, {100, 100, 150}};
  check_round_trip(triangles(far, {tetrahedron(0, 1, 2, 3), tetrahedron(4, 6, 5, 7)}));
  // Two tetrahedra of one shell have a common vertex, or a common edge.
  const std::vector<codec::GridPoint> points{{0, 0, 0},   {90, 0, 0},  {0, 90, 0},     {0, 0, 90},
                                             {-90, 0, 0}, {0, -90, 0}, {-10, -10, -90}};
  auto at_vertex = tetrahedron(0, 1, 2, 3);
  for (const Triangle& triangle : tetrahedron(0, 4, 5, 6)) at_vertex.push_back(triangle);
  check_round_trip(triangles(points, {at_vertex}));
  const std::vector<codec::GridPoint> six{points.begin(), points.begin() + 6};
  auto at_edge = tetrahedron(0, 1, 2, 3);
  for (const Triangle& triangle : tetrahedron(0, 4, 5, 3)) at_edge.push_back(triangle);
  check_round_trip(triangles(six, {at_edge}));
}

TEST_CASE("mode parallelogram keeps coordinates near the end of their range") {
  constexpr std::int64_t kFar = (std::int64_t{1} << 53) - 1;
  check_round_trip(triangles({{-kFar, -kFar, -kFar}, {kFar, -kFar, 0}, {0, kFar, 5}, {1, 2, kFar}},
                             {tetrahedron(0, 1, 2, 3)}));
}

TEST_CASE("mode parallelogram begins from the page's last position") {
  codec::IntegerSolid solid = dense_integers_of(generated::torus(5, 4));
  for (codec::GridPoint& vertex : solid.vertices) vertex[0] += 1'000'000'000;
  codec::PageMemory memory;
  memory.add(solid);
  test::check_round_trip(kParallelogram, solid, memory);
  CHECK(write(kParallelogram, solid, memory)->size() < write(kParallelogram, solid)->size());
}

TEST_CASE("mode parallelogram refuses polygons and open surfaces") {
  const auto polygons = write(kParallelogram, dense_integers_of(generated::box()));
  REQUIRE(!polygons);
  CHECK(polygons.error().code == ErrorCode::not_encodable);
  auto open = tetrahedron(0, 1, 2, 3);
  open.pop_back();
  const auto surface =
      write(kParallelogram, triangles({{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}, {open}));
  REQUIRE(!surface);
  CHECK(surface.error().code == ErrorCode::not_encodable);
}

TEST_CASE("mode parallelogram writes the same bytes whatever the order of facets") {
  generated::Random random(3);
  const OrientedBoundary torus = generated::torus(9, 5);
  const auto bytes = write(kParallelogram, dense_integers_of(torus));
  const auto shuffled =
      write(kParallelogram, dense_integers_of(generated::shuffled(torus, random)));
  REQUIRE(bytes);
  REQUIRE(shuffled);
  CHECK(*bytes == *shuffled);
}

TEST_CASE("mode parallelogram checks its limits before it grows") {
  const auto bytes = write(kParallelogram, dense_integers_of(generated::torus(16, 12)));
  REQUIRE(bytes);
  Limits few;
  few.vertices = 100;
  CHECK(read(kParallelogram, *bytes, {}, few).error().code == ErrorCode::limit_exceeded);
  few = {};
  few.facets = 100;
  CHECK(read(kParallelogram, *bytes, {}, few).error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("mode parallelogram survives damaged streams") {
  test::check_damaged(kParallelogram, dense_integers_of(generated::torus(6, 5)), 3000);
  generated::Random random(11);
  Limits limits;
  limits.vertices = limits.facets = 2000;
  for (int trial = 0; trial < 500; ++trial) {
    Bytes noise(random.below(400));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.next());
    (void)read(kParallelogram, noise, {}, limits);
  }
}

}  // namespace
}  // namespace watertight
