// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mode parallelogram: what comes back, what it refuses, and damaged streams.
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <vector>

#include "codec/page/modes.h"
#include "geometry/canonical_form.h"
#include "tests/generated/generated_solids.h"

namespace watertight {
namespace {

codec::IntegerSolid integers_of(const OrientedBoundary& boundary) {
  const geometry::CanonicalSolid canonical = geometry::canonical_form(boundary);
  const auto gridded = codec::grid_solid(canonical.boundary.solid());
  REQUIRE(gridded);
  return gridded->solid;
}

/// The corners of each triangle by position, with its shell: equal for equal solids.
using PlacedTriangle = std::pair<Index, std::array<codec::GridPoint, 3>>;
std::vector<PlacedTriangle> placed(const codec::IntegerSolid& solid) {
  std::vector<PlacedTriangle> result;
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    for (Index facet = solid.shell_offsets[shell]; facet < solid.shell_offsets[shell + 1];
         ++facet) {
      const auto ring = solid.ring(solid.facet_offsets[facet]);
      REQUIRE(ring.size() == 3);
      std::array<codec::GridPoint, 3> corners{solid.vertices[ring[0]], solid.vertices[ring[1]],
                                              solid.vertices[ring[2]]};
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      result.emplace_back(shell, corners);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

Result<Bytes> write(const codec::IntegerSolid& solid, const codec::PageMemory& memory = {}) {
  codec::ModelBank models(codec::parallelogram::model_layout());
  codec::EntropyStream stream = codec::EntropyStream::writer();
  codec::IntegerSolid source = solid;
  codec::WriterChoice choice;
  const Status coded = codec::parallelogram::code_solid(stream, models, memory, source, choice, {});
  if (!coded) return coded.error();
  return std::move(stream).finish();
}

Result<codec::IntegerSolid> read(ByteView bytes, const codec::PageMemory& memory = {},
                                 const Limits& limits = {}) {
  codec::ModelBank models(codec::parallelogram::model_layout());
  codec::EntropyStream stream = codec::EntropyStream::reader(bytes);
  codec::IntegerSolid solid;
  codec::WriterChoice unused;
  const Status coded =
      codec::parallelogram::code_solid(stream, models, memory, solid, unused, limits);
  if (!coded) return coded.error();
  if (!stream.is_finished()) return Error{ErrorCode::malformed, "bytes are left over"};
  return solid;
}

void check_round_trip(const codec::IntegerSolid& solid) {
  const auto bytes = write(solid);
  REQUIRE(bytes);
  const auto back = read(*bytes);
  REQUIRE(back);
  CHECK(back->vertices.size() == solid.vertices.size());
  CHECK(placed(*back) == placed(solid));
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
  check_round_trip(integers_of(generated::torus(12, 9)));
  check_round_trip(integers_of(generated::torus(16, 12)));
  generated::Random random(7);
  codec::IntegerSolid rough = integers_of(generated::torus(16, 16));
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
  // Two tetrahedra of one shell with a common vertex, then with a common edge.
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
  codec::IntegerSolid solid = integers_of(generated::torus(5, 4));
  for (codec::GridPoint& vertex : solid.vertices) vertex[0] += 1'000'000'000;
  codec::PageMemory memory;
  memory.add(solid);
  const auto near = write(solid, memory);
  const auto alone = write(solid);
  REQUIRE(near);
  REQUIRE(alone);
  CHECK(near->size() < alone->size());
  const auto back = read(*near, memory);
  REQUIRE(back);
  CHECK(placed(*back) == placed(solid));
}

TEST_CASE("mode parallelogram refuses polygons and open surfaces") {
  const auto polygons = write(integers_of(generated::box()));
  REQUIRE(!polygons);
  CHECK(polygons.error().code == ErrorCode::not_encodable);
  auto open = tetrahedron(0, 1, 2, 3);
  open.pop_back();
  const auto surface = write(triangles({{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}, {open}));
  REQUIRE(!surface);
  CHECK(surface.error().code == ErrorCode::not_encodable);
}

TEST_CASE("mode parallelogram writes the same bytes whatever the order of facets") {
  generated::Random random(3);
  const OrientedBoundary torus = generated::torus(9, 5);
  const auto bytes = write(integers_of(torus));
  const auto shuffled = write(integers_of(generated::shuffled(torus, random)));
  REQUIRE(bytes);
  REQUIRE(shuffled);
  CHECK(*bytes == *shuffled);
}

TEST_CASE("mode parallelogram asks its limits before it grows") {
  const codec::IntegerSolid solid = integers_of(generated::torus(16, 12));
  const auto bytes = write(solid);
  REQUIRE(bytes);
  Limits few;
  few.vertices = 100;
  auto refused = read(*bytes, {}, few);
  REQUIRE(!refused);
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  few = {};
  few.facets = 100;
  refused = read(*bytes, {}, few);
  REQUIRE(!refused);
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("mode parallelogram survives damaged streams") {
  generated::Random random(11);
  const codec::IntegerSolid solid = integers_of(generated::torus(6, 5));
  const auto bytes = write(solid);
  REQUIRE(bytes);
  Limits limits;
  limits.vertices = limits.facets = 2000;
  for (std::size_t size = 0; size < bytes->size(); ++size) {
    const auto back = read(ByteView(*bytes).subspan(0, size), {}, limits);
    CHECK(!(back && placed(*back) == placed(solid)));
  }
  int same = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes damaged = *bytes;
    damaged[random.below(damaged.size())] ^= static_cast<std::uint8_t>(1 + random.below(255));
    const auto back = read(damaged, {}, limits);
    if (back && placed(*back) == placed(solid)) ++same;
  }
  CHECK(same == 0);
  for (int trial = 0; trial < 500; ++trial) {
    Bytes noise(random.below(400));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.next());
    (void)read(noise, {}, limits);
  }
}

}  // namespace
}  // namespace watertight
