// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <optional>
#include <utility>

#include "codec/mode_walk/walk.h"
#include "codec/page/modes.h"
#include "geometry/canonical_form.h"
#include "tests/generated/generated_solids.h"

using namespace watertight;
using generated::Random;

namespace {

std::optional<codec::GriddedSolid> gridded(const OrientedBoundary& boundary) {
  return codec::grid_solid(geometry::canonical_form(boundary).boundary.solid());
}

std::optional<Bytes> write(const codec::IntegerSolid& solid, const codec::PageMemory& memory = {}) {
  codec::EntropyStream stream = codec::EntropyStream::writer();
  codec::ModelBank models(codec::walk::model_layout());
  codec::IntegerSolid written = solid;
  codec::WriterChoice unused;
  if (!codec::walk::code_solid(stream, models, memory, written, unused, Limits{}))
    return std::nullopt;
  return std::move(stream).finish();
}

Status read(const Bytes& bytes, codec::IntegerSolid& solid, const codec::PageMemory& memory = {},
            const Limits& limits = {}) {
  codec::EntropyStream stream = codec::EntropyStream::reader(bytes);
  codec::ModelBank models(codec::walk::model_layout());
  codec::WriterChoice unused;
  Status status = codec::walk::code_solid(stream, models, memory, solid, unused, limits);
  if (status && !stream.is_finished()) return Error{ErrorCode::malformed, "bytes left"};
  return status;
}

/// True if the decoded solid is, in canonical form, the one it was made of.
bool is_same(const codec::GriddedSolid& expected, codec::IntegerSolid decoded) {
  codec::GriddedSolid other = expected;
  other.solid = std::move(decoded);
  const auto first = codec::ungrid_solid(expected, 0, Limits{});
  const auto second = codec::ungrid_solid(other, 0, Limits{});
  if (!first || !second) return false;
  const auto boundary = OrientedBoundary::make(*second);
  return boundary && geometry::canonical_form(*boundary).boundary.solid() == *first;
}

void check_round_trip(const std::string& name, const OrientedBoundary& boundary) {
  INFO(name);
  const auto solid = gridded(boundary);
  REQUIRE(solid);
  const auto bytes = write(solid->solid);
  REQUIRE(bytes);
  codec::IntegerSolid decoded;
  REQUIRE(read(*bytes, decoded));
  CHECK(is_same(*solid, std::move(decoded)));
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
      const auto solid = gridded(boundary);
      if (!solid) continue;  // doubles that are on no grid
      const auto bytes = write(solid->solid);
      if (!bytes) {
        ++refused;
        continue;
      }
      ++held;
      codec::IntegerSolid decoded;
      REQUIRE(read(*bytes, decoded));
      CHECK(is_same(*solid, std::move(decoded)));
    }
  }
  CHECK(refused <= 4);  // the block whose hole touches the outer ring
  CHECK(held > 100);
}

TEST_CASE("mode walk refuses what has no volume or leaves its range") {
  const auto solid = gridded(generated::box());
  REQUIRE(solid);
  codec::IntegerSolid flat = solid->solid;
  for (codec::GridPoint& p : flat.vertices) {
    p[0] = 3 * p[0] + p[2];
    p[2] = p[0] + 2 * p[1];
  }
  std::sort(flat.vertices.begin(), flat.vertices.end());
  REQUIRE(std::adjacent_find(flat.vertices.begin(), flat.vertices.end()) == flat.vertices.end());
  CHECK_FALSE(write(flat));
  codec::IntegerSolid wide = solid->solid;
  wide.vertices.back()[0] += std::int64_t{1} << 31;
  CHECK_FALSE(write(wide));
}

TEST_CASE("in a page mode walk takes columns from the solids before") {
  Random random(11);
  const auto solid = gridded(generated::random_prism(random, 12));
  REQUIRE(solid);
  codec::PageMemory memory;
  const auto alone = write(solid->solid, memory);
  memory.add(solid->solid);
  const auto again = write(solid->solid, memory);
  REQUIRE(alone);
  REQUIRE(again);
  CHECK(again->size() < alone->size());
  codec::IntegerSolid decoded;
  REQUIRE(read(*again, decoded, memory));
  CHECK(is_same(*solid, std::move(decoded)));
}

TEST_CASE("a measuring stream walks as a writing one, and both the same way every time") {
  Random random(5);
  const auto solid = gridded(generated::random_terrain(random, 8));
  REQUIRE(solid);
  const auto bytes = write(solid->solid);
  REQUIRE(bytes);
  CHECK(*bytes == *write(solid->solid));
  codec::EntropyStream meter = codec::EntropyStream::meter();
  codec::ModelBank models(codec::walk::model_layout());
  codec::IntegerSolid measured = solid->solid;
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
    const auto solid = gridded(boundary);
    REQUIRE(solid);
    const auto bytes = write(solid->solid);
    REQUIRE(bytes);
    Limits limits;
    limits.vertices = 1000;
    const auto attempt = [&](const Bytes& damaged) {
      codec::IntegerSolid decoded;
      if (!read(damaged, decoded, {}, limits)) return;
      CHECK(decoded.vertices.size() <= limits.vertices);
      for (const Index v : decoded.ring_vertices) REQUIRE(v < decoded.vertices.size());
    };
    for (std::size_t size = 0; size < bytes->size(); ++size) {
      attempt(Bytes(bytes->begin(), bytes->begin() + static_cast<std::ptrdiff_t>(size)));
    }
    for (int i = 0; i < 200; ++i) {
      Bytes damaged = *bytes;
      for (std::uint64_t flips = 1 + random.below(3); flips > 0; --flips) {
        damaged[random.below(damaged.size())] ^= static_cast<std::uint8_t>(1 + random.below(255));
      }
      attempt(damaged);
    }
  }
}

TEST_CASE("reading stops at the limit of vertices") {
  const auto solid = gridded(generated::pierced_block(3));
  REQUIRE(solid);
  const auto bytes = write(solid->solid);
  REQUIRE(bytes);
  Limits limits;
  limits.vertices = 10;
  codec::IntegerSolid decoded;
  const Status status = read(*bytes, decoded, {}, limits);
  REQUIRE_FALSE(status);
  CHECK(status.error().code != ErrorCode::not_encodable);
}

TEST_CASE("the walk refuses surfaces that are not closed") {
  const std::vector<Point> points{{0, 0, 0}, {0, 0, 9}, {0, 9, 0}, {9, 0, 0}};
  const auto delaunay = delaunay::canonical_delaunay(points);
  REQUIRE(delaunay);
  const codec::ModelLayout layout{codec::walk::kWalkFamilies, {}};
  const auto measure = [&](std::vector<Triangle> triangles) {
    codec::ModelBank models(layout);
    codec::EntropyStream meter = codec::EntropyStream::meter();
    codec::walk::BoundaryMesh mesh;
    mesh.component_first.push_back(static_cast<Index>(triangles.size()));
    mesh.triangles = std::move(triangles);
    return codec::walk::code_boundary_walk(meter, models, 0, points, *delaunay, mesh);
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
