// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <utility>
#include <vector>

#include "codec/page/modes.h"
#include "geometry/canonical_form.h"
#include "tests/generated/generated_solids.h"

using namespace watertight;

namespace {

struct Coded {
  Bytes bytes;
  codec::GriddedSolid gridded;
};

std::optional<codec::GriddedSolid> gridded(const OrientedBoundary& boundary) {
  return codec::grid_solid(geometry::canonical_form(boundary).boundary.solid());
}

Coded write(const OrientedBoundary& boundary, const codec::PageMemory& memory = {}) {
  Coded result;
  const auto on_grid = gridded(boundary);
  REQUIRE(on_grid);
  result.gridded = *on_grid;
  codec::EntropyStream stream = codec::EntropyStream::writer();
  codec::ModelBank models(codec::polygon::model_layout());
  codec::IntegerSolid solid = on_grid->solid;
  codec::WriterChoice unused;
  const Status status = codec::polygon::code_solid(stream, models, memory, solid, unused, Limits{});
  REQUIRE(status);
  result.bytes = std::move(stream).finish();
  return result;
}

Status read(ByteView bytes, codec::IntegerSolid& solid, bool& is_finished,
            const Limits& limits = {}, const codec::PageMemory& memory = {}) {
  codec::EntropyStream stream = codec::EntropyStream::reader(bytes);
  codec::ModelBank models(codec::polygon::model_layout());
  codec::WriterChoice unused;
  const Status status = codec::polygon::code_solid(stream, models, memory, solid, unused, limits);
  is_finished = stream.is_finished();
  return status;
}

/// The solid that `bytes` hold, in canonical form.
Solid canonical_of(const Coded& coded, codec::IntegerSolid solid) {
  codec::GriddedSolid gridded = coded.gridded;
  gridded.solid = std::move(solid);
  auto ungridded = codec::ungrid_solid(gridded, 0, Limits{});
  REQUIRE(ungridded);
  auto boundary = OrientedBoundary::make(std::move(*ungridded));
  REQUIRE(boundary);
  return geometry::canonical_form(*boundary).boundary.solid();
}

void check_round_trip(const OrientedBoundary& boundary, const codec::PageMemory& memory = {}) {
  const Coded coded = write(boundary, memory);
  codec::IntegerSolid solid;
  bool is_finished = false;
  const Status status = read(coded.bytes, solid, is_finished, {}, memory);
  REQUIRE(status);
  CHECK(is_finished);
  CHECK(canonical_of(coded, std::move(solid)).arrays() ==
        geometry::canonical_form(boundary).boundary.solid().arrays());
}

/// A box with a chimney: a facet with a hole whose ring begins at a new vertex.
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

/// A box whose cavity has an edge in common with it, so that this edge has four facets.
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

TEST_CASE("mode polygon gives back every generated solid") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    for (const generated::NamedBoundary& named : generated::all(seed)) {
      if (!gridded(named.boundary)) continue;
      INFO(named.name);
      check_round_trip(named.boundary);
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
  const auto on_grid = gridded(generated::random_prism(random, 7));
  REQUIRE(on_grid);
  for (const std::int64_t bound : {most, most + 1}) {
    codec::IntegerSolid solid = on_grid->solid;
    // Every other vertex at one end of an axis, so that all predictions are far off.
    for (std::size_t i = 0; i < solid.vertices.size(); ++i) {
      solid.vertices[i][i % 3] = i % 2 == 0 ? bound : -bound;
    }
    const codec::IntegerSolid truth = solid;
    codec::EntropyStream writer = codec::EntropyStream::writer();
    codec::ModelBank models(codec::polygon::model_layout());
    codec::WriterChoice unused;
    const Status written = codec::polygon::code_solid(writer, models, {}, solid, unused, Limits{});
    CHECK(written.has_value() == (bound == most));
    if (!written) continue;
    const Bytes bytes = std::move(writer).finish();
    codec::IntegerSolid again;
    bool is_finished = false;
    REQUIRE(read(bytes, again, is_finished));
    CHECK(is_finished);
    std::vector<codec::GridPoint> expected = truth.vertices;
    std::sort(expected.begin(), expected.end());
    std::sort(again.vertices.begin(), again.vertices.end());
    CHECK(again.vertices == expected);
  }
}

TEST_CASE("mode polygon codes a solid the better for the page around it") {
  generated::Random random(5);
  codec::PageMemory memory;
  const OrientedBoundary prism = generated::random_prism(random, 9);
  const std::size_t alone = write(prism).bytes.size();
  const auto on_grid = gridded(prism);
  REQUIRE(on_grid);
  memory.add(on_grid->solid);
  check_round_trip(prism, memory);
  CHECK(write(prism, memory).bytes.size() < alone);
}

TEST_CASE("mode polygon writes the same bytes for the same solid") {
  generated::Random random(9);
  for (const generated::NamedBoundary& named : generated::all(4)) {
    if (!gridded(named.boundary)) continue;
    INFO(named.name);
    CHECK(write(named.boundary).bytes == write(generated::shuffled(named.boundary, random)).bytes);
  }
}

TEST_CASE("mode polygon holds to the limits when it reads") {
  const Coded coded = write(generated::grid_cube(5));
  Limits limits;
  limits.vertices = 20;
  codec::IntegerSolid solid;
  bool is_finished = false;
  const Status status = read(coded.bytes, solid, is_finished, limits);
  REQUIRE_FALSE(status);
  CHECK(status.error().code == ErrorCode::limit_exceeded);

  limits = {};
  limits.facets = 20;
  const Status facets = read(coded.bytes, solid, is_finished, limits);
  REQUIRE_FALSE(facets);
  CHECK(facets.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("mode polygon reads hostile bytes without harm") {
  generated::Random random(17);
  std::vector<Bytes> blobs{write(box_with_chimney()).bytes, write(cavity_touching_at_edge()).bytes,
                           write(generated::pierced_block(2)).bytes,
                           write(generated::torus(6, 5)).bytes,
                           write(generated::random_prism(random, 12)).bytes};
  Limits limits;
  limits.vertices = limits.facets = limits.rings = 2000;
  limits.shells = 20;
  for (const Bytes& blob : blobs) {
    for (std::size_t size = 0; size < blob.size(); ++size) {
      codec::IntegerSolid solid;
      bool is_finished = false;
      const Status status = read(ByteView(blob).first(size), solid, is_finished, limits);
      CHECK((!status || solid.vertices.size() <= limits.vertices));
    }
    for (int i = 0; i < 400; ++i) {
      Bytes mutated = blob;
      for (std::uint64_t k = 0; k <= random.below(3); ++k) {
        mutated[random.below(mutated.size())] = static_cast<std::uint8_t>(random.next());
      }
      codec::IntegerSolid solid;
      bool is_finished = false;
      const Status status = read(mutated, solid, is_finished, limits);
      if (!status) continue;
      CHECK(solid.ring_offsets.back() == solid.ring_vertices.size());
      for (const Index vertex : solid.ring_vertices) REQUIRE(vertex < solid.vertices.size());
    }
  }
}
