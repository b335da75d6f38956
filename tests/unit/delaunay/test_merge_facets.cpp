// SPDX-License-Identifier: GPL-3.0-or-later
//
// Facets in one plane as one facet, and the ladder that proves a solid by such facets.
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <vector>

#include "delaunay/constrained/merge_facets.h"
#include "delaunay/ladder.h"
#include "geometry/measures.h"
#include "sample_solids.h"
#include "tessellate/facets.h"
#include "tests/generated/generated_solids.h"

namespace watertight {
namespace {

using samples::Shape;

/// The solid with each canonical triangle of its facets as a facet.
Solid in_triangles(const Solid& given) {
  const tessellate::FacetTriangles canonical = tessellate::triangulate_facets(given);
  const Solid& solid = canonical.divided_solid(given);
  SolidArrays arrays;
  arrays.vertices.assign(solid.vertices().begin(), solid.vertices().end());
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const geometry::IndexRange facets = solid.facets_of(shell);
    for (Index t = canonical.first[facets.begin]; t < canonical.first[facets.end]; ++t) {
      const Triangle& triangle = canonical.triangles[t];
      arrays.ring_vertices.insert(arrays.ring_vertices.end(), triangle.begin(), triangle.end());
      arrays.end_ring();
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  Result<Solid> result = Solid::make(std::move(arrays), solid.lattice(), solid.srid());
  REQUIRE(result.has_value());
  return *std::move(result);
}

std::optional<delaunay::MergedFacets> merged(const Solid& solid) {
  return delaunay::merge_flat_facets(solid, tessellate::triangulate_facets(solid));
}

double six_volume(const Solid& solid) {
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  return geometry::six_volume(facets.divided_solid(solid).vertices(), facets.triangles);
}

double area(const Solid& solid) {
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  return geometry::measure(facets.divided_solid(solid), facets.triangles).area;
}

/// A box with needles: each of two opposite edges of its roof has `count` vertices inside, close to
/// each other, and the roof and the two walls are cut into triangles.
Shape box_in_needles(int count) {
  const double length = count + 1;
  Shape shape = samples::box({0, 0, 0}, {length, 1000, 10});
  shape.vertices = {{0, 0, 0},  {length, 0, 0},  {length, 1000, 0},  {0, 1000, 0},
                    {0, 0, 10}, {length, 0, 10}, {length, 1000, 10}, {0, 1000, 10}};
  samples::Shell& shell = shape.shells.front();
  shell = {{{3, 2, 1, 0}}, {{1, 2, 6, 5}}, {{3, 0, 4, 7}}};
  std::vector<Index> front{4};
  std::vector<Index> back{7};
  for (int i = 1; i <= count; ++i) {
    front.push_back(static_cast<Index>(shape.vertices.size()));
    shape.vertices.push_back({static_cast<double>(i), 0, 10});
    back.push_back(static_cast<Index>(shape.vertices.size()));
    shape.vertices.push_back({static_cast<double>(i), 1000, 10});
  }
  front.push_back(5);
  back.push_back(6);
  // The roof: from the front left corner to all of the back, then from the back right corner.
  for (std::size_t i = 0; i + 1 < back.size(); ++i) {
    shell.push_back({{front.front(), back[i + 1], back[i]}});
    shell.push_back({{front[i], front[i + 1], back.back()}});
  }
  for (std::size_t i = 0; i + 1 < back.size(); ++i) {
    shell.push_back({{0, front[i + 1], front[i]}});
    shell.push_back({{3, back[i], back[i + 1]}});
  }
  shell.push_back({{0, 1, front.back()}});
  shell.push_back({{3, back.back(), 2}});
  return shape;
}

TEST_CASE("triangles of flat facets merge to the facets, rings of holes included") {
  for (const Shape& shape : {samples::box({0, 0, 0}, {5, 6, 7}), samples::tunnelled_box(),
                             samples::stairs(3), samples::schoenhardt()}) {
    const Solid solid = samples::make_solid(shape);
    const auto result = merged(in_triangles(solid));
    if (solid.facet_count() == in_triangles(solid).facet_count()) {
      CHECK_FALSE(result.has_value());
      continue;
    }
    REQUIRE(result.has_value());
    CHECK(result->solid.ring_count() - result->solid.facet_count() ==
          solid.ring_count() - solid.facet_count());
    CHECK(result->solid.facet_count() <= solid.facet_count());
    CHECK(six_volume(result->solid) == six_volume(solid));
  }
}

TEST_CASE("vertices inside a merged facet are left out") {
  const Solid cube = generated::grid_cube(4).solid();
  REQUIRE(cube.facet_count() == 96);
  const auto result = merged(cube);
  REQUIRE(result.has_value());
  CHECK(result->solid.facet_count() == 6);
  CHECK(result->solid.vertex_count() == 8 + 12 * 3);
  CHECK(six_volume(result->solid) == six_volume(cube));
  CHECK(result->source.size() == 6);
  CHECK(std::is_sorted(result->source.begin(), result->source.end()));
}

TEST_CASE("bent facets and edges of more than two facets are not merged across") {
  CHECK_FALSE(merged(samples::make_solid(samples::warped_box(3))).has_value());
  // Two pairs of walls beside the common edge of the two boxes lie in one plane each.
  CHECK_FALSE(merged(generated::boxes_touching_at_edge().solid()).has_value());
  CHECK_FALSE(merged(generated::box().solid()).has_value());
}

TEST_CASE("merged facets have the surface of those before, in solids of every kind") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    for (const generated::NamedBoundary& named : generated::all(seed)) {
      INFO(named.name << ", seed " << seed);
      const Solid solid = in_triangles(named.boundary.solid());
      const auto result = merged(solid);
      if (!result) continue;
      CHECK(result->solid.facet_count() < solid.facet_count());
      CHECK(result->solid.shell_count() == solid.shell_count());
      CHECK(six_volume(result->solid) == six_volume(solid));
      CHECK(std::abs(area(result->solid) - area(solid)) <= 1e-12 * area(solid));
      CHECK_FALSE(merged(result->solid).has_value());
    }
  }
}

TEST_CASE("a solid is proven by merged facets where its own are no faces") {
  const Solid solid = samples::make_solid(box_in_needles(40));
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  const delaunay::LadderResult result = delaunay::climb_ladder(solid, facets, nullptr, {});
  REQUIRE(result.certificate.has_value());
  CHECK(result.certificate->rung == delaunay::Rung::recovered);
  CHECK(result.certificate->has_merged_facets);
  const delaunay::Tetrahedralization& made = result.certificate->tetrahedralization;
  CHECK(made.points.size() == made.input_count);

  delaunay::LadderOptions own_facets;
  own_facets.keeps_facets = true;
  const delaunay::LadderResult kept = delaunay::climb_ladder(solid, facets, nullptr, own_facets);
  REQUIRE(kept.certificate.has_value());
  CHECK_FALSE(kept.certificate->has_merged_facets);
  CHECK(kept.certificate->tetrahedralization.input_count == solid.vertex_count());
}

TEST_CASE("the tetrahedra of merged facets fill the solid") {
  for (const std::uint64_t seed : {4U, 5U}) {
    for (const generated::NamedBoundary& named : generated::all(seed)) {
      INFO(named.name << ", seed " << seed);
      const Solid solid = in_triangles(named.boundary.solid());
      const delaunay::LadderResult result =
          delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), nullptr, {});
      if (!result.certificate || !result.certificate->has_merged_facets) continue;
      const delaunay::Certificate& certificate = *result.certificate;
      double sum = 0;
      for (std::size_t i = 0; i < certificate.tetrahedralization.tetrahedra.size(); ++i) {
        if (!certificate.is_interior[i]) continue;
        std::array<Point, 4> p{};
        for (std::size_t corner = 0; corner < 4; ++corner) {
          p[corner] = certificate.tetrahedralization
                          .points[certificate.tetrahedralization.tetrahedra[i][corner]];
        }
        const auto [a, b, c, d] = p;
        sum += (b.x - a.x) * ((c.y - a.y) * (d.z - a.z) - (c.z - a.z) * (d.y - a.y)) +
               (b.y - a.y) * ((c.z - a.z) * (d.x - a.x) - (c.x - a.x) * (d.z - a.z)) +
               (b.z - a.z) * ((c.x - a.x) * (d.y - a.y) - (c.y - a.y) * (d.x - a.x));
      }
      CHECK(std::abs(sum - six_volume(solid)) <= 1e-9 * six_volume(solid));
    }
  }
}

}  // namespace
}  // namespace watertight
