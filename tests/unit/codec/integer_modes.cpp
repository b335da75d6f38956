// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/codec/integer_modes.h"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <map>
#include <utility>

#include "geometry/canonical_form.h"

namespace watertight::test {
namespace {

PlacedRing placed_ring(const codec::IntegerSolid& solid, Index number) {
  PlacedRing ring;
  for (const Index vertex : solid.ring(number)) ring.push_back(solid.vertices[vertex]);
  PlacedRing least = ring;
  for (std::size_t turn = 1; turn < ring.size(); ++turn) {
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
    least = std::min(least, ring);
  }
  return least;
}

PlacedFacet placed_facet(const codec::IntegerSolid& solid, Index number) {
  PlacedFacet facet;
  for (Index ring = solid.facet_offsets[number]; ring < solid.facet_offsets[number + 1]; ++ring) {
    facet.push_back(placed_ring(solid, ring));
  }
  if (!facet.empty()) std::sort(facet.begin() + 1, facet.end());
  return facet;
}

bool is_in_range(const codec::IntegerSolid& solid) {
  return solid.ring_offsets.back() == solid.ring_vertices.size() &&
         std::all_of(solid.ring_vertices.begin(), solid.ring_vertices.end(),
                     [&](Index vertex) { return vertex < solid.vertices.size(); });
}

}  // namespace

codec::ModelBank& new_models(const codec::ModelLayout& layout) {
  struct Banks {
    codec::ModelBank untouched;
    codec::ModelBank used;
  };
  static std::map<const codec::ModelLayout*, Banks> banks_of;
  auto banks = banks_of.find(&layout);
  if (banks == banks_of.end()) {
    const codec::ModelBank untouched(layout);
    banks = banks_of.emplace(&layout, Banks{untouched, untouched}).first;
  }
  banks->second.used = banks->second.untouched;
  return banks->second.used;
}

std::optional<codec::IntegerSolid> integers_of(const OrientedBoundary& boundary) {
  auto gridded = codec::grid_solid(geometry::canonical_form(boundary).boundary.solid());
  if (!gridded) return std::nullopt;
  return std::move(gridded->solid);
}

Result<Bytes> write(const IntegerMode& mode, const codec::IntegerSolid& solid,
                    const codec::PageMemory& memory) {
  codec::EntropyStream stream = codec::EntropyStream::writer();
  codec::ModelBank& models = new_models(mode.model_layout());
  codec::IntegerSolid written = solid;
  codec::WriterChoice choice;
  const Status status = mode.code_solid(stream, models, memory, written, choice, {});
  if (!status) return status.error();
  return std::move(stream).finish();
}

Result<codec::IntegerSolid> read(const IntegerMode& mode, ByteView bytes,
                                 const codec::PageMemory& memory, const Limits& limits) {
  codec::EntropyStream stream = codec::EntropyStream::reader(bytes);
  codec::ModelBank& models = new_models(mode.model_layout());
  codec::IntegerSolid solid;
  codec::WriterChoice unused;
  const Status status = mode.code_solid(stream, models, memory, solid, unused, limits);
  if (!status) return status.error();
  if (!stream.is_finished()) return Error{ErrorCode::malformed, "bytes are left"};
  return solid;
}

std::vector<PlacedShell> placed(const codec::IntegerSolid& solid) {
  std::vector<PlacedShell> shells;
  for (Index number = 0; number < solid.shell_count(); ++number) {
    PlacedShell& shell = shells.emplace_back();
    for (Index facet = solid.shell_offsets[number]; facet < solid.shell_offsets[number + 1];
         ++facet) {
      shell.push_back(placed_facet(solid, facet));
    }
    std::sort(shell.begin(), shell.end());
  }
  if (!shells.empty()) std::sort(shells.begin() + 1, shells.end());
  return shells;
}

void check_round_trip(const IntegerMode& mode, const codec::IntegerSolid& solid,
                      const codec::PageMemory& memory) {
  const auto bytes = write(mode, solid, memory);
  REQUIRE(bytes);
  const auto back = read(mode, *bytes, memory);
  REQUIRE(back);
  REQUIRE(is_in_range(*back));
  CHECK(back->vertices.size() == solid.vertices.size());
  CHECK(placed(*back) == placed(solid));
}

void check_damaged(const IntegerMode& mode, const codec::IntegerSolid& solid, int changes) {
  const auto bytes = write(mode, solid);
  REQUIRE(bytes);
  const std::vector<PlacedShell> truth = placed(solid);
  Limits limits;
  limits.vertices = limits.facets = limits.rings = 2000;
  limits.shells = 20;
  const auto attempt = [&](ByteView damaged) {
    const auto back = read(mode, damaged, {}, limits);
    if (!back) return;
    CHECK(back->vertices.size() <= limits.vertices);
    REQUIRE(is_in_range(*back));
    CHECK(placed(*back) != truth);
  };
  for (std::size_t size = 0; size < bytes->size(); ++size) attempt(ByteView(*bytes).first(size));
  generated::Random random(17);
  for (int i = 0; i < changes; ++i) {
    Bytes damaged = *bytes;
    damaged[i % damaged.size()] ^= static_cast<std::uint8_t>(1 + random.below(255));
    for (std::uint64_t more = random.below(3); more > 0; --more) {
      damaged[random.below(damaged.size())] = static_cast<std::uint8_t>(random.next());
    }
    attempt(damaged);
  }
}

}  // namespace watertight::test
