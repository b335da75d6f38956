// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <numeric>

#include "geometry/canonical_form.h"
#include "tests/unit/geometry/solids.h"

namespace watertight::test {
namespace {

OrientedBoundary boundary_of(Solid solid) {
  auto boundary = OrientedBoundary::make(std::move(solid));
  REQUIRE(boundary.has_value());
  return std::move(boundary).value();
}

/// The solid with vertices, interior shells, facets, interior rings and ring starts shuffled.
Solid renumbered(std::vector<Point> vertices, std::vector<Shell> shells, Random& random) {
  std::vector<Index> number(vertices.size());
  std::iota(number.begin(), number.end(), Index{0});
  shuffle(number, random);
  std::vector<Point> moved(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) moved[number[i]] = vertices[i];
  std::vector<Shell> inner(shells.begin() + 1, shells.end());
  shuffle(inner, random);
  std::copy(inner.begin(), inner.end(), shells.begin() + 1);
  for (Shell& shell : shells) {
    shuffle(shell, random);
    for (Facet& facet : shell) {
      std::vector<Ring> interior(facet.begin() + 1, facet.end());
      shuffle(interior, random);
      std::copy(interior.begin(), interior.end(), facet.begin() + 1);
      for (Ring& ring : facet) {
        for (Index& vertex : ring) vertex = number[vertex];
        const auto start = static_cast<std::ptrdiff_t>(random.below(ring.size()));
        std::rotate(ring.begin(), ring.begin() + start, ring.end());
      }
    }
  }
  return solid_of(std::move(moved), shells);
}

}  // namespace

TEST_CASE("the canonical form has sorted vertices, rings, facets and inner shells") {
  const geometry::CanonicalSolid canonical = geometry::canonical_form(boundary_of(tunnel_solid()));
  const Solid& solid = canonical.boundary.solid();
  CHECK(std::is_sorted(solid.vertices().begin(), solid.vertices().end()));
  for (Index ring = 0; ring < solid.ring_count(); ++ring) {
    const auto vertices = solid.ring(ring);
    CHECK(*std::min_element(vertices.begin(), vertices.end()) == vertices[0]);
  }
  int facets_with_holes = 0;
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    const IndexRange rings = solid.rings_of(facet);
    if (rings.size() == 1) continue;
    REQUIRE(rings.size() == 3);
    ++facets_with_holes;
    const auto corner = [&](Index ring) { return solid.vertices()[solid.ring(ring)[0]]; };
    CHECK(corner(rings.begin).x == 0);
    CHECK(corner(rings.begin + 1).x == 2);
    CHECK(corner(rings.begin + 2).x == 8);
  }
  CHECK(facets_with_holes == 2);
  CHECK(solid.shell_count() == 3);
  CHECK(solid.world(solid.ring(solid.rings_of(solid.facets_of(1).begin).begin)[0]) ==
        std::array<double, 3>{20, 5, 2});
  CHECK(solid.world(solid.ring(solid.rings_of(solid.facets_of(2).begin).begin)[0]) ==
        std::array<double, 3>{24, 5, 2});
}

TEST_CASE("the canonical form and the hash do not depend on numbering") {
  const auto [vertices, shells] = tunnel_with_cavities();
  const OrientedBoundary source = boundary_of(tunnel_solid());
  const geometry::CanonicalSolid expected = geometry::canonical_form(source);
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    const OrientedBoundary shuffled = boundary_of(renumbered(vertices, shells, random));
    const geometry::CanonicalSolid canonical = geometry::canonical_form(shuffled);
    REQUIRE(canonical.boundary.solid() == expected.boundary.solid());
    REQUIRE(geometry::solid_hash(shuffled) == geometry::solid_hash(source));
    const auto restored = geometry::restore_order(canonical.boundary.solid(), canonical.order);
    REQUIRE(restored.has_value());
    REQUIRE(*restored == shuffled.solid());
  }
}

TEST_CASE("the canonical form of a canonical solid is itself") {
  const geometry::CanonicalSolid once = geometry::canonical_form(boundary_of(tunnel_solid()));
  CHECK_FALSE(once.order.is_identity());
  const geometry::CanonicalSolid twice = geometry::canonical_form(once.boundary);
  CHECK(twice.boundary.solid() == once.boundary.solid());
  CHECK(twice.order.is_identity());
}

TEST_CASE("the hash depends on orientation, coordinates, lattice and reference system") {
  const auto hash_of = [](const Solid& solid) { return geometry::solid_hash(boundary_of(solid)); };
  const Solid source = tunnel_solid();
  const auto remade = [&](auto change) {
    SolidArrays arrays = source.arrays();
    Lattice lattice = source.lattice();
    std::uint32_t srid = source.srid();
    change(arrays, lattice, srid);
    auto solid = Solid::make(std::move(arrays), lattice, srid);
    REQUIRE(solid.has_value());
    return hash_of(*solid);
  };
  CHECK(remade([](SolidArrays&, Lattice&, std::uint32_t&) {}) == hash_of(source));
  CHECK(remade([](SolidArrays& arrays, Lattice&, std::uint32_t&) { arrays.vertices[3].x += 1; }) !=
        hash_of(source));
  CHECK(remade([](SolidArrays& arrays, Lattice&, std::uint32_t&) {
          for (std::size_t ring = 0; ring + 1 < arrays.ring_offsets.size(); ++ring) {
            std::reverse(arrays.ring_vertices.begin() + arrays.ring_offsets[ring],
                         arrays.ring_vertices.begin() + arrays.ring_offsets[ring + 1]);
          }
        }) != hash_of(source));
  CHECK(remade([](SolidArrays&, Lattice& lattice, std::uint32_t&) {
          lattice.step[0] = {1, -3};
        }) != hash_of(source));
  CHECK(remade([](SolidArrays&, Lattice&, std::uint32_t& srid) { srid = 0; }) != hash_of(source));
}

TEST_CASE("restoring refuses orders that do not fit the solid") {
  const geometry::CanonicalSolid canonical = geometry::canonical_form(boundary_of(tunnel_solid()));
  const Solid& solid = canonical.boundary.solid();
  const auto is_refused = [&](auto change) {
    geometry::SourceOrder order = canonical.order;
    change(order);
    const auto restored = geometry::restore_order(solid, order);
    return !restored && restored.error().code == ErrorCode::malformed;
  };
  CHECK(is_refused([](geometry::SourceOrder& order) { order.vertex.pop_back(); }));
  CHECK(is_refused([](geometry::SourceOrder& order) { order.vertex[0] = order.vertex[1]; }));
  CHECK(is_refused([](geometry::SourceOrder& order) { order.facet[2] = 1'000'000; }));
  CHECK(
      is_refused([](geometry::SourceOrder& order) { std::swap(order.shell[0], order.shell[1]); }));
  CHECK(is_refused(
      [](geometry::SourceOrder& order) { std::swap(order.facet.front(), order.facet.back()); }));
  CHECK(is_refused(
      [](geometry::SourceOrder& order) { std::swap(order.ring.front(), order.ring.back()); }));
  CHECK(is_refused([](geometry::SourceOrder& order) { std::swap(order.ring[0], order.ring[1]); }));
  CHECK(is_refused([](geometry::SourceOrder& order) { order.ring_start[0] = 4; }));
}

}  // namespace watertight::test
