// SPDX-License-Identifier: GPL-3.0-or-later
//
// The second half of rung 1: edges are divided until all are Delaunay, then facets are inserted.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <set>
#include <vector>

#include "delaunay/certificate.h"
#include "delaunay/constrained/constrained_delaunay.h"
#include "delaunay/constrained/perturbed_sphere.h"
#include "delaunay/constrained/protect_edges.h"
#include "delaunay/constrained/wrap_cavity.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/predicates/predicates.h"
#include "sample_solids.h"
#include "tessellate/facets.h"

namespace watertight {
namespace {

using samples::Shape;

/// The shape under a map of determinant 1 that makes needles: few of its edges are Delaunay.
Shape sheared(Shape shape) {
  for (Point& p : shape.vertices) p = {p.x + 3 * p.y, p.y + 5 * p.z, p.z};
  for (Point& p : shape.vertices) p = {p.x, p.y, p.z + 4 * p.x - p.y};
  return shape;
}

std::vector<Shape> hard_shapes() {
  return {samples::schoenhardt(), sheared(samples::schoenhardt()),
          sheared(samples::tunnelled_box()), sheared(samples::stairs(6)), samples::warped_box(3)};
}

Result<delaunay::ConstrainedDelaunay> constrained(const Solid& solid, const CancelPoll& poll = {}) {
  return delaunay::constrained_delaunay(solid, tessellate::triangulate_facets(solid), {}, poll);
}

/// The certificate's answer for a constrained Delaunay tetrahedralization.
delaunay::CertificateResult judged(const Solid& solid, delaunay::ConstrainedDelaunay constrained) {
  delaunay::Tetrahedralization own;
  own.points = std::move(constrained.points);
  own.input_count = solid.vertex_count();
  own.tetrahedra = std::move(constrained.tetrahedra);
  for (std::size_t i = 0; i < constrained.triangles.size(); ++i) {
    own.constrained.push_back(
        {delaunay::sorted(constrained.triangles[i]), constrained.facet_of[i]});
  }
  std::sort(own.constrained.begin(), own.constrained.end());
  return delaunay::check_certificate(solid, tessellate::triangulate_facets(solid), std::move(own),
                                     delaunay::Rung::recovered);
}

TEST_CASE("solids without a tetrahedralization of their own vertices get a constrained one") {
  for (const Shape& shape : hard_shapes()) {
    const Solid solid = samples::make_solid(shape);
    Result<delaunay::ConstrainedDelaunay> result = constrained(solid);
    REQUIRE(result.has_value());
    CHECK(result->missing == 0);
    const delaunay::CertificateResult judgement = judged(solid, *std::move(result));
    INFO(judgement.detail);
    CHECK(judgement.refusal == delaunay::CertificateRefusal::none);
    CHECK(judgement.certificate.refilled_facets.empty());
  }
}

TEST_CASE("protected edges are Delaunay, and Steiner vertices lie exactly on them") {
  for (const Shape& shape : hard_shapes()) {
    const Solid solid = samples::make_solid(shape);
    const auto divided = delaunay::protect_edges(solid, tessellate::triangulate_facets(solid), {});
    REQUIRE(divided.has_value());
    std::set<delaunay::VertexPair> present;
    for (const Triangle& face : divided->delaunay.faces) {
      for (const delaunay::VertexPair& edge : delaunay::edges_of(face)) present.insert(edge);
    }
    const auto points = divided->solid.vertices();
    for (Index r = 0; r < divided->solid.ring_count(); ++r) {
      const auto ring = divided->solid.ring(r);
      Index last_given = *std::find_if(ring.rbegin(), ring.rend(),
                                       [&](Index v) { return v < solid.vertex_count(); });
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Index next = ring[(i + 1) % ring.size()];
        CHECK(present.contains(delaunay::pair_of(ring[i], next)));
        if (ring[i] < solid.vertex_count()) {
          last_given = ring[i];
          continue;
        }
        const Index next_given = [&] {
          std::size_t j = i;
          while (ring[j % ring.size()] >= solid.vertex_count()) ++j;
          return ring[j % ring.size()];
        }();
        CHECK(geometry::is_on_segment(points[last_given], points[next_given], points[ring[i]]));
      }
    }
  }
}

TEST_CASE("the constrained tetrahedralization does not depend on the numbering of the solid") {
  const auto tetrahedra_of = [](const Shape& shape) {
    const Result<delaunay::ConstrainedDelaunay> result = constrained(samples::make_solid(shape));
    REQUIRE(result.has_value());
    std::vector<std::vector<Point>> tetrahedra;
    for (const geometry::Tetrahedron& t : result->tetrahedra) {
      std::vector<Point>& corners = tetrahedra.emplace_back();
      for (const Index v : t) corners.push_back(result->points[v]);
      std::sort(corners.begin(), corners.end());
    }
    std::sort(tetrahedra.begin(), tetrahedra.end());
    return tetrahedra;
  };
  for (const Shape& shape : hard_shapes()) {
    const auto expected = tetrahedra_of(shape);
    for (unsigned seed = 0; seed < 4; ++seed) {
      CHECK(tetrahedra_of(samples::shuffled(shape, seed)) == expected);
    }
  }
}

TEST_CASE("a solid that is stretched along an axis needs no more Steiner vertices") {
  for (Shape shape : hard_shapes()) {
    const auto expected = constrained(samples::make_solid(shape));
    REQUIRE(expected.has_value());
    for (Point& p : shape.vertices) p.x *= 1024;
    const auto result = constrained(samples::make_solid(shape));
    REQUIRE(result.has_value());
    REQUIRE(result->points.size() == expected->points.size());
    CHECK(result->tetrahedra.size() == expected->tetrahedra.size());
    CHECK(judged(samples::make_solid(shape), *result).refusal ==
          delaunay::CertificateRefusal::none);
  }
}

TEST_CASE("a constrained tetrahedralization can be cancelled at every question") {
  const Solid solid = samples::make_solid(sheared(samples::stairs(6)));
  int questions = 0;
  REQUIRE(constrained(solid, [&] {
            ++questions;
            return false;
          }).has_value());
  REQUIRE(questions > 2);
  for (int last = 1; last < questions; last += 1 + questions / 16) {
    int asked = 0;
    const auto result = constrained(solid, [&] { return ++asked >= last; });
    REQUIRE_FALSE(result.has_value());
    CHECK(result.error().code == ErrorCode::cancelled);
  }
}

TEST_CASE("an edge that doubles cannot divide is a limit, not a wrong answer") {
  Shape shape = samples::schoenhardt();
  // Odd coordinates near 2^53: hardly a point between two vertices is a double.
  for (Point& p : shape.vertices) {
    p = {p.x + 0x1p52 + 1, p.y + 0x1p52 + 3, p.z + 0x1p52 + (p.z == 0 ? 0 : 1)};
  }
  const Solid solid = samples::make_solid(shape);
  const auto result = constrained(solid);
  if (result.has_value()) {
    CHECK(judged(solid, *result).refusal == delaunay::CertificateRefusal::none);
  } else {
    CHECK(result.error().code == ErrorCode::limit_exceeded);
  }
}

TEST_CASE("gift wrapping fills a box, and no cavity without a tetrahedralization") {
  const auto wrapped = [](const Shape& shape, delaunay::TestBudget& budget) {
    const Solid solid = samples::make_solid(shape);
    std::vector<Triangle> front;
    for (const Triangle& t : tessellate::triangulate_facets(solid).triangles) {
      front.push_back({t[0], t[2], t[1]});
    }
    return delaunay::wrap_cavity(solid.vertices(), front, budget);
  };
  const CancelPoll never;
  delaunay::TestBudget enough(100'000, never);
  CHECK(wrapped(samples::box({0, 0, 0}, {5, 6, 7}), enough).size() >= 5);
  CHECK(wrapped(samples::schoenhardt(), enough).empty());
  CHECK_FALSE(enough.is_used_up());
  delaunay::TestBudget few(2, never);
  CHECK(wrapped(samples::stairs(4), few).empty());
  CHECK(few.is_used_up());
  CHECK_FALSE(few.is_cancelled());
}

TEST_CASE("five points on a sphere are decided as in the canonical tetrahedralization") {
  // The corners of a cube: of the lifted points the greatest one is outside.
  const Point a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1}, greatest{1, 1, 1};
  const std::array<const Point*, 4> sphere{&a, &b, &c, &d};
  CHECK(geometry::orient3d(a, b, c, d) > 0);
  CHECK_FALSE(delaunay::is_in_perturbed_sphere(sphere, greatest));
  const Point inside{0.5, 0.5, 0.5};
  CHECK(delaunay::is_in_perturbed_sphere(sphere, inside));
  // The greatest corner of the sphere moves away: the sphere grows over points beyond it.
  const std::array<const Point*, 4> other{&a, &b, &c, &greatest};
  CHECK(geometry::orient3d(a, b, c, greatest) > 0);
  CHECK(delaunay::is_in_perturbed_sphere(other, d));
}

}  // namespace
}  // namespace watertight
