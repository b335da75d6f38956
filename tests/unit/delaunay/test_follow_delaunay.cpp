// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "delaunay/canonical/follow_delaunay.h"
#include "geometry/predicates/predicates.h"
#include "unit/delaunay/sample_solids.h"

namespace watertight {
namespace {

using samples::Shape;

struct Followed {
  Solid solid;
  tessellate::FacetTriangles canonical;
  delaunay::CanonicalDelaunay delaunay;
  delaunay::FollowingTriangles following;
};

Followed follow(const Shape& shape) {
  Solid solid = samples::make_solid(shape);
  tessellate::FacetTriangles canonical = tessellate::triangulate_facets(solid);
  Result<delaunay::CanonicalDelaunay> delaunay = delaunay::canonical_delaunay(solid.vertices());
  REQUIRE(delaunay.has_value());
  delaunay::FollowingTriangles following = delaunay::follow_delaunay(solid, canonical, *delaunay);
  return {std::move(solid), std::move(canonical), std::move(*delaunay), std::move(following)};
}

/// Checks each facet: its triangles turn as the facet does, and their edges cancel to exactly its
/// rings.
void check_facets(const Followed& f) {
  REQUIRE(f.following.first.size() == std::size_t{f.solid.facet_count()} + 1);
  Index missing_total = 0;
  for (Index facet = 0; facet < f.solid.facet_count(); ++facet) {
    const tessellate::Projection projection = tessellate::facet_projection(f.solid, facet);
    std::map<std::pair<Index, Index>, int> edges;
    Index missing = 0;
    for (Index t = f.following.first[facet]; t < f.following.first[facet + 1]; ++t) {
      const Triangle& triangle = f.following.triangles[t];
      CHECK(f.following.facet_of[t] == facet);
      const int turn =
          geometry::orient2d(f.solid.vertices()[triangle[0]], f.solid.vertices()[triangle[1]],
                             f.solid.vertices()[triangle[2]], projection.axis);
      CHECK((projection.is_mirrored ? -turn : turn) == 1);
      for (std::size_t k = 0; k < 3; ++k) {
        ++edges[{triangle[k], triangle[(k + 1) % 3]}];
        --edges[{triangle[(k + 1) % 3], triangle[k]}];
      }
      Triangle sorted = triangle;
      std::sort(sorted.begin(), sorted.end());
      const bool found =
          std::binary_search(f.delaunay.faces.begin(), f.delaunay.faces.end(), sorted);
      CHECK(found == (f.following.delaunay_face[t] != kNone));
      if (found) CHECK(f.delaunay.faces[f.following.delaunay_face[t]] == sorted);
      if (!found) ++missing;
    }
    for (Index r = f.solid.rings_of(facet).begin; r < f.solid.rings_of(facet).end; ++r) {
      const auto ring = f.solid.ring(r);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        --edges[{ring[i], ring[(i + 1) % ring.size()]}];
        ++edges[{ring[(i + 1) % ring.size()], ring[i]}];
      }
    }
    for (const auto& [edge, count] : edges) CHECK(count == 0);
    CHECK(f.following.missing[facet] == missing);
    missing_total += missing;
  }
  CHECK(f.following.missing_total == missing_total);
}

/// The set of triangles, each as a sorted triple of points.
std::set<std::array<Point, 3>> as_points(const Followed& f) {
  std::set<std::array<Point, 3>> result;
  for (const Triangle& t : f.following.triangles) {
    std::array<Point, 3> corners{f.solid.vertices()[t[0]], f.solid.vertices()[t[1]],
                                 f.solid.vertices()[t[2]]};
    std::sort(corners.begin(), corners.end());
    result.insert(corners);
  }
  return result;
}

/// A wheel with `teeth` teeth; their tips and the gaps between them lie on approximate circles.
Shape gear(int teeth) {
  std::vector<std::array<double, 2>> polygon;
  for (int i = 0; i < 2 * teeth; ++i) {
    const double angle = 3.14159265358979 * i / teeth;
    const double radius = i % 2 == 0 ? 10000 : 4000 + 37 * (i % 11);
    polygon.push_back({std::round(radius * std::cos(angle)), std::round(radius * std::sin(angle))});
  }
  return samples::prism(polygon, 1500);
}

std::vector<Shape> shapes() {
  Shape cavity = samples::box({0, 0, 0}, {90, 80, 70});
  samples::add_box(cavity, {20, 30, 10}, {50, 60, 40}, true);
  return {samples::box({0, 0, 0}, {10, 10, 10}),
          cavity,
          samples::tunnelled_box(),
          samples::schoenhardt(),
          samples::stairs(6),
          samples::warped_box(1),
          samples::warped_box(20),
          gear(12),
          gear(45)};
}

TEST_CASE("following triangles tile every facet") {
  for (const Shape& shape : shapes()) check_facets(follow(shape));
}

TEST_CASE("following triangles do not depend on the numbering") {
  for (const Shape& shape : shapes()) {
    const auto expected = as_points(follow(shape));
    for (unsigned seed = 0; seed < 5; ++seed) {
      CHECK(as_points(follow(samples::shuffled(shape, seed))) == expected);
    }
  }
}

TEST_CASE("facets that are unions of Delaunay faces are found whole") {
  CHECK(follow(samples::box({0, 0, 0}, {10, 10, 10})).following.missing_total == 0);
  CHECK(follow(samples::tunnelled_box()).following.missing_total == 0);
  CHECK(follow(samples::warped_box(1)).following.missing_total == 0);
  CHECK(follow(samples::shuffled(samples::tunnelled_box(), 3)).following.missing_total == 0);
}

TEST_CASE("a facet that is no union of Delaunay faces keeps the least number of other triangles") {
  // The tetrahedra of the six vertices surround one of the three reflex diagonals; the other two
  // diagonals are no Delaunay edges, and each of them belongs to two triangles.
  const Followed f = follow(samples::schoenhardt());
  CHECK(f.following.missing_total == 4);
}

TEST_CASE("following is never worse than the canonical triangulation") {
  for (const Shape& shape : shapes()) {
    const Followed f = follow(shape);
    Index canonical_missing = 0;
    for (Triangle t : f.canonical.triangles) {
      std::sort(t.begin(), t.end());
      if (!std::binary_search(f.delaunay.faces.begin(), f.delaunay.faces.end(), t)) {
        ++canonical_missing;
      }
    }
    CHECK(f.following.missing_total <= canonical_missing);
  }
}

}  // namespace
}  // namespace watertight
