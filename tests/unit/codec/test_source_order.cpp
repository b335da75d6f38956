// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <numeric>
#include <optional>
#include <vector>

#include "codec/page/source_order.h"
#include "tests/generated/generated_solids.h"

namespace watertight {
namespace {

using generated::Random;

codec::ModelBank neutral_bank() { return codec::ModelBank(codec::order_layout()); }

Bytes written(const Solid& canonical, const geometry::SourceOrder& order) {
  auto stream = codec::EntropyStream::writer();
  auto bank = neutral_bank();
  geometry::SourceOrder copy = order;
  codec::code_order(stream, bank, canonical, copy);
  CHECK(copy == order);
  return std::move(stream).finish();
}

/// The order that the bytes give, or nothing if the stream refuses the bytes.
std::optional<geometry::SourceOrder> read_back(const Solid& canonical, const Bytes& bytes) {
  auto stream = codec::EntropyStream::reader(bytes);
  auto bank = neutral_bank();
  geometry::SourceOrder order;
  codec::code_order(stream, bank, canonical, order);
  CHECK(geometry::restore_order(canonical, order));  // any bytes give permutations
  if (!stream.is_finished()) return std::nullopt;
  return order;
}

std::vector<OrientedBoundary> samples() {
  return {generated::box(),
          generated::pierced_block(3),
          generated::box_with_cavities(4),
          generated::boxes_touching_at_edge(),
          generated::block_with_touching_hole(),
          generated::torus(7, 5),
          generated::grid_cube(3),
          generated::schoenhardt()};
}

void shuffle(std::vector<Index>& list, std::size_t begin, std::size_t end, Random& random) {
  for (std::size_t i = end; i > begin + 1; --i) {
    std::swap(list[i - 1], list[begin + random.below(i - begin)]);
  }
}

/// A random order that a source could have.
geometry::SourceOrder random_order(const Solid& solid, Random& random) {
  geometry::SourceOrder order;
  order.vertex.resize(solid.vertex_count());
  std::iota(order.vertex.begin(), order.vertex.end(), Index{0});
  shuffle(order.vertex, 0, order.vertex.size(), random);
  std::vector<Index> shells(solid.shell_count());
  std::iota(shells.begin(), shells.end(), Index{0});
  shuffle(shells, 1, shells.size(), random);
  order.shell.resize(shells.size());
  order.facet.resize(solid.facet_count());
  order.ring.resize(solid.ring_count());
  order.ring_start.resize(solid.ring_count());
  Index facet_place = 0;
  Index ring_place = 0;
  for (Index place = 0; place < shells.size(); ++place) {
    order.shell[shells[place]] = place;
    const IndexRange range = solid.facets_of(shells[place]);
    std::vector<Index> facets(range.size());
    std::iota(facets.begin(), facets.end(), range.begin);
    shuffle(facets, 0, facets.size(), random);
    for (const Index facet : facets) {
      order.facet[facet] = facet_place++;
      const IndexRange ring_range = solid.rings_of(facet);
      std::vector<Index> rings(ring_range.size());
      std::iota(rings.begin(), rings.end(), ring_range.begin);
      shuffle(rings, 1, rings.size(), random);
      for (const Index ring : rings) {
        order.ring[ring] = ring_place++;
        order.ring_start[ring] = static_cast<Index>(random.below(solid.ring(ring).size()));
      }
    }
  }
  return order;
}

TEST_CASE("the source order of a solid comes back") {
  for (const OrientedBoundary& boundary : samples()) {
    const geometry::CanonicalSolid canonical = geometry::canonical_form(boundary);
    const Solid& solid = canonical.boundary.solid();
    const auto order = read_back(solid, written(solid, canonical.order));
    REQUIRE(order);
    CHECK(*order == canonical.order);
  }
}

TEST_CASE("any order comes back, and costs no more than a permutation") {
  Random random(5);
  for (const OrientedBoundary& boundary : samples()) {
    const geometry::CanonicalSolid canonical = geometry::canonical_form(boundary);
    const Solid& solid = canonical.boundary.solid();
    for (int round = 0; round < 20; ++round) {
      const geometry::SourceOrder chosen = random_order(solid, random);
      const auto order = read_back(solid, written(solid, chosen));
      REQUIRE(order);
      CHECK(*order == chosen);
    }
  }
}

/// Numbers the vertices by first use, as readers do.
void number_by_first_use(const Solid& solid, geometry::SourceOrder& order) {
  std::vector<Index> rings(order.ring.size());
  for (Index ring = 0; ring < rings.size(); ++ring) rings[order.ring[ring]] = ring;
  std::fill(order.vertex.begin(), order.vertex.end(), kNone);
  Index next = 0;
  for (const Index ring : rings) {
    const auto vertices = solid.ring(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      Index& number = order.vertex[vertices[(order.ring_start[ring] + i) % vertices.size()]];
      if (number == kNone) number = next++;
    }
  }
}

TEST_CASE("a bank that has learned a habit codes it in next to nothing") {
  geometry::CanonicalSolid canonical = geometry::canonical_form(generated::box());
  number_by_first_use(canonical.boundary.solid(), canonical.order);
  const Solid& solid = canonical.boundary.solid();
  auto bank = neutral_bank();
  auto stream = codec::EntropyStream::meter();
  std::uint64_t last = 0;
  for (int i = 0; i < 50; ++i) {
    const std::uint64_t before = stream.cost();
    geometry::SourceOrder copy = canonical.order;
    codec::code_order(stream, bank, solid, copy);
    last = stream.cost() - before;
  }
  CHECK(last < 4U << codec::kCostBits);
}

TEST_CASE("bytes that are no order give permutations nonetheless") {
  Random random(9);
  const geometry::CanonicalSolid canonical = geometry::canonical_form(generated::pierced_block(3));
  const Solid& solid = canonical.boundary.solid();
  const geometry::SourceOrder chosen = random_order(solid, random);
  const Bytes bytes = written(solid, chosen);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Bytes prefix(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    CHECK(read_back(solid, prefix) != chosen);
  }
  for (int round = 0; round < 300; ++round) {
    Bytes noise(random.below(64));
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random.below(256));
    read_back(solid, noise);
  }
}

}  // namespace
}  // namespace watertight
