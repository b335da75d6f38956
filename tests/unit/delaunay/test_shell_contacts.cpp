// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests shells that touch inside each other's facets and edges: valid solids whose
// tetrahedralization must contain the contacts in the facets.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <set>
#include <string>

#include "delaunay/ladder.h"
#include "delaunay/shell_contacts.h"
#include "geometry/intersection/triangle_triangle.h"
#include "geometry/measures.h"
#include "unit/delaunay/sample_solids.h"

namespace watertight {
namespace {

using samples::Shape;

delaunay::EngineWorkers& contact_engines() {
  static delaunay::EngineWorkers workers;
  return workers;
}

/// Adds a cavity. Its facets are given by indices into `points` and face out of the cavity. A point
/// that is a vertex of the shape already is used again.
void add_cavity(Shape& shape, const std::vector<Point>& points,
                const std::vector<std::vector<std::size_t>>& facets) {
  std::vector<Index> number;
  for (const Point& p : points) {
    const auto place = std::find(shape.vertices.begin(), shape.vertices.end(), p);
    number.push_back(Index(place - shape.vertices.begin()));
    if (place == shape.vertices.end()) shape.vertices.push_back(p);
  }
  samples::Shell shell;
  for (const std::vector<std::size_t>& facet : facets) {
    samples::Ring ring;
    for (const std::size_t v : facet) ring.push_back(number[v]);
    std::reverse(ring.begin(), ring.end());
    shell.push_back({ring});
  }
  shape.shells.push_back(shell);
}

/// Adds a cavity that is a tetrahedron of four points, in whichever orientation they are.
void add_tetrahedron(Shape& shape, const std::vector<Point>& p) {
  std::vector<Point> points = p;
  const std::vector<Triangle> facets{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  if (geometry::volume_sign(points, facets) < 0) std::swap(points[0], points[1]);
  add_cavity(shape, points, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

Shape block() { return samples::box({0, 0, 0}, {200, 200, 200}); }

Shape tip_on_wall(const Point& tip) {
  Shape shape = block();
  add_tetrahedron(shape, {{100, 50, 100}, {150, 100, 90}, {50, 150, 100}, tip});
  return shape;
}

Shape edge_on_wall(const Point& from, const Point& to) {
  Shape shape = block();
  add_tetrahedron(shape, {{90, 70, 100}, {110, 130, 110}, from, to});
  return shape;
}

/// A block with a cavity whose square rim runs around the walls at half height.
Shape divided() {
  Shape shape = block();
  add_cavity(
      shape,
      {{0, 0, 100}, {200, 0, 100}, {200, 200, 100}, {0, 200, 100}, {100, 100, 140}, {100, 100, 60}},
      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}});
  return shape;
}

std::vector<Shape> touching() {
  std::vector<Shape> shapes{
      tip_on_wall({100, 100, 200}),                 // a tip on the diagonal of a wall
      tip_on_wall({100, 60, 200}),                  // a tip beside the diagonal
      tip_on_wall({110, 0, 200}),                   // a tip in an edge of two walls
      edge_on_wall({30, 50, 200}, {170, 90, 200}),  // an edge inside a wall, across its diagonal
      edge_on_wall({0, 50, 200}, {200, 90, 200}),   // an edge from edge to edge of a wall
      edge_on_wall({0, 0, 200}, {200, 200, 200}),   // an edge on one diagonal of a wall
      edge_on_wall({0, 200, 200}, {200, 0, 200}),   // an edge on the other diagonal
      edge_on_wall({40, 0, 200}, {160, 0, 200}),    // an edge in an edge of two walls
      edge_on_wall({0, 0, 200}, {100, 30, 200})};   // an edge from a vertex of the block
  Shape two = tip_on_wall({100, 100, 200});         // two cavities on one wall
  add_tetrahedron(two, {{60, 60, 60}, {130, 60, 60}, {90, 130, 50}, {100, 100, 10}});
  add_tetrahedron(two, {{120, 30, 150}, {160, 30, 150}, {150, 10, 120}, {140, 25, 200}});
  shapes.push_back(two);
  Shape cavities = block();  // a tip of a cavity on another cavity
  samples::add_box(cavities, {40, 40, 40}, {120, 120, 80}, true);
  add_tetrahedron(cavities, {{60, 60, 120}, {100, 60, 130}, {80, 110, 120}, {70, 90, 80}});
  shapes.push_back(cavities);
  return shapes;
}

delaunay::LadderResult climb_contacts(const Shape& shape, const delaunay::LadderOptions& options) {
  const Solid solid = samples::make_solid(shape);
  return delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), &contact_engines(),
                                options);
}

std::string contact_attempts(const delaunay::LadderResult& result) {
  std::string text;
  for (const delaunay::RungAttempt& attempt : result.attempts) {
    text.append("[").append(delaunay::to_string(attempt.rung)).append(": ");
    text.append(attempt.outcome).append("]");
  }
  return text;
}

TEST_CASE("a cavity may touch a facet of another shell from within, on every rung") {
  const std::vector<Shape> shapes = touching();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (const delaunay::Rung rung : {delaunay::Rung::delaunay, delaunay::Rung::patch,
                                      delaunay::Rung::triangles_scaled, delaunay::Rung::tetgen}) {
      if (rung == delaunay::Rung::tetgen && contact_engines().tetgen() == nullptr) continue;
      delaunay::LadderOptions options;
      options.first_rung = rung;
      const delaunay::LadderResult result = climb_contacts(shapes[i], options);
      INFO("shape " << i << " from " << delaunay::to_string(rung) << ": "
                    << contact_attempts(result));
      CHECK(result.certificate.has_value());
      CHECK(result.obstacle.empty());
      if (rung != delaunay::Rung::delaunay) CHECK(result.attempts.size() == 1);
    }
  }
}

TEST_CASE("the Delaunay tetrahedralization alone proves a contact where it has the faces") {
  delaunay::LadderOptions options;
  options.last_rung = delaunay::Rung::delaunay;
  const delaunay::LadderResult result = climb_contacts(tip_on_wall({100, 100, 200}), options);
  INFO(contact_attempts(result));
  CHECK(result.certificate.has_value());
}

TEST_CASE("a cavity that touches the walls all around divides the interior") {
  for (const delaunay::Rung rung : {delaunay::Rung::delaunay, delaunay::Rung::patch,
                                    delaunay::Rung::triangles_scaled, delaunay::Rung::tetgen}) {
    if (rung == delaunay::Rung::tetgen && contact_engines().tetgen() == nullptr) continue;
    delaunay::LadderOptions options;
    options.first_rung = rung;
    const delaunay::LadderResult result = climb_contacts(divided(), options);
    INFO(contact_attempts(result));
    CHECK(delaunay::to_string(result.property) == "interior-disconnected");
  }
}

TEST_CASE("edges of different shells that cross in no vertex are named") {
  // The edge of a cavity goes from the upper floor of a step over the edge of the step.
  Shape shape =
      samples::prism({{0, 0}, {200, 0}, {200, 200}, {100, 200}, {100, 100}, {0, 100}}, 200);
  add_tetrahedron(shape, {{150, 40, 60}, {160, 40, 120}, {50, 100, 100}, {150, 100, 103}});
  const delaunay::LadderResult result = climb_contacts(shape, {});
  INFO(contact_attempts(result));
  CHECK(result.obstacle.find("cross in a point that is not a vertex") != std::string::npos);
  CHECK(result.property == delaunay::CertificateRefusal::none);
}

Point mean(const std::vector<Point>& points) {
  Point sum{0, 0, 0};
  const double count = double(points.size());
  for (const Point& p : points) sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z};
  return {sum.x / count, sum.y / count, sum.z / count};
}

TEST_CASE("a roof that is not planar may be touched on its triangles, but not across its fold") {
  int valleys = 0;
  for (const double corner : {260.0, 140.0}) {
    Shape warped = block();
    for (Point& p : warped.vertices) {
      if (p == Point{200, 200, 200}) p.z = corner;
    }
    const Solid solid = samples::make_solid(warped);
    const auto& points = solid.vertices();
    std::vector<Triangle> roof;
    for (const Triangle& t : tessellate::triangulate_facets(solid).triangles) {
      if (points[t[0]].z > 0 && points[t[1]].z > 0 && points[t[2]].z > 0) roof.push_back(t);
    }
    REQUIRE(roof.size() == 2);
    std::vector<Point> fold;
    std::vector<Point> apexes;
    for (const Triangle& t : roof) {
      const Point tip =
          // Exact, because the weights are quarters.
          mean({points[t[0]], points[t[0]], points[t[1]], points[t[2]]});
      Shape touched = warped;
      add_tetrahedron(touched, {{100, 50, 90}, {150, 100, 80}, {50, 150, 90}, tip});
      const delaunay::LadderResult result = climb_contacts(touched, {});
      INFO(contact_attempts(result));
      CHECK(result.certificate.has_value());
      CHECK(result.obstacle.empty());
      const Triangle& other = &t == &roof[0] ? roof[1] : roof[0];
      for (const Index v : t) {
        const bool is_common = std::find(other.begin(), other.end(), v) != other.end();
        if (!is_common) apexes.push_back(points[v]);
        if (is_common && &t == &roof[0]) fold.push_back(points[v]);
      }
    }
    const Point middle = mean(fold);
    // The fold is a ridge: an edge across it would leave the block.
    if (middle.z > mean(apexes).z) continue;
    ++valleys;
    const double dx = apexes[0].x > apexes[1].x ? 20 : -20;
    const double dy = apexes[0].y > apexes[1].y ? 20 : -20;
    Shape crossed = warped;
    add_tetrahedron(crossed, {{100, 80, 90},
                              {110, 120, 80},
                              {middle.x + dx, middle.y + dy, middle.z},
                              {middle.x - dx, middle.y - dy, middle.z}});
    const delaunay::LadderResult result = climb_contacts(crossed, {});
    INFO(contact_attempts(result));
    CHECK(result.obstacle.find("(or folds) cross") != std::string::npos);
    CHECK(result.property == delaunay::CertificateRefusal::none);
  }
  CHECK(valleys == 1);
}

TEST_CASE("triangles divided at contacts are the same surface") {
  int number = -1;
  for (const Shape& shape : touching()) {
    ++number;
    const Solid solid = samples::make_solid(shape);
    const tessellate::FacetTriangles canonical = tessellate::triangulate_facets(solid);
    const auto divided = delaunay::divide_at_contacts(solid, canonical);
    REQUIRE(divided);
    REQUIRE(divided->has_contacts());
    CHECK(divided->triangles.first.size() == canonical.first.size());
    CHECK(geometry::six_volume(solid.vertices(), divided->triangles.triangles) ==
          geometry::six_volume(solid.vertices(), canonical.triangles));
    // Triangles of different shells meet in common vertices and edges only.
    const auto& triangles = divided->triangles.triangles;
    for (Index a = 0; a < triangles.size(); ++a) {
      for (Index b = a + 1; b < triangles.size(); ++b) {
        INFO(number << ": " << a << " " << b);
        CHECK_FALSE(geometry::is_intersection(
            geometry::classify_contact(solid.vertices(), triangles[a], triangles[b])));
      }
    }
  }
}

TEST_CASE("shells without contacts, and single shells, are left as they are") {
  Shape apart = block();
  samples::add_box(apart, {50, 50, 50}, {100, 100, 100}, true);
  for (const Shape& shape : {apart, block()}) {
    const Solid solid = samples::make_solid(shape);
    const auto divided = delaunay::divide_at_contacts(solid, tessellate::triangulate_facets(solid));
    REQUIRE(divided);
    CHECK_FALSE(divided->has_contacts());
  }
}

TEST_CASE("a vertex that is not exactly on the facet is no contact") {
  // The proof of a solid with a tip on the wall must not hold for a solid whose tip is one unit, or
  // the least double, off the wall.
  const delaunay::LadderResult result = climb_contacts(tip_on_wall({100, 60, 200}), {});
  REQUIRE(result.certificate.has_value());
  const double below = 200 - 0x1p-45;
  for (const Point tip : {Point{100, 60, 199}, Point{100, 60, below}}) {
    const Solid off = samples::make_solid(tip_on_wall(tip));
    delaunay::Tetrahedralization data = result.certificate->tetrahedralization;
    std::copy(off.vertices().begin(), off.vertices().end(), data.points.begin());
    const delaunay::CertificateResult checked = delaunay::check_certificate(
        off, tessellate::triangulate_facets(off), std::move(data), delaunay::Rung::patch);
    CHECK(checked.refusal != delaunay::CertificateRefusal::none);
  }
}

TEST_CASE("a facet's faces must reach its own edge where another shell touches it") {
  // A face of a wall is given to the neighbouring wall, at a contact in their common edge.
  const Solid solid = samples::make_solid(tip_on_wall({110, 0, 200}));
  const tessellate::FacetTriangles canonical = tessellate::triangulate_facets(solid);
  const delaunay::LadderResult result =
      delaunay::climb_ladder(solid, canonical, &contact_engines(), {});
  REQUIRE(result.certificate.has_value());
  const delaunay::Tetrahedralization& proof = result.certificate->tetrahedralization;
  for (std::size_t i = 0; i < proof.constrained.size(); ++i) {
    delaunay::Tetrahedralization damaged = proof;
    damaged.constrained[i].facet = (damaged.constrained[i].facet + 1) % solid.facet_count();
    CHECK(delaunay::check_certificate(solid, canonical, damaged, delaunay::Rung::patch).refusal ==
          delaunay::CertificateRefusal::facet_not_conforming);
    damaged = proof;
    damaged.constrained.erase(damaged.constrained.begin() + std::ptrdiff_t(i));
    CHECK(delaunay::check_certificate(solid, canonical, damaged, delaunay::Rung::patch).refusal ==
          delaunay::CertificateRefusal::facet_not_conforming);
  }
}

}  // namespace
}  // namespace watertight
