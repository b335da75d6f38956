// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <map>

#include "delaunay/canonical/follow_delaunay.h"
#include "delaunay/canonical_delaunay.h"
#include "delaunay/certificate.h"
#include "unit/delaunay/sample_solids.h"

namespace watertight {
namespace {

using samples::Shape;

/// A solid with a tetrahedralization made without any engine.
struct Case {
  Solid solid;
  tessellate::FacetTriangles canonical;
  delaunay::Tetrahedralization tetrahedralization;

  delaunay::CertificateRefusal judge() const { return full().refusal; }
  delaunay::CertificateResult full() const {
    return delaunay::check_certificate(solid, canonical, tetrahedralization,
                                       delaunay::Rung::delaunay);
  }
};

/// A case from the canonical Delaunay tetrahedralization; requires that facets are unions of its
/// faces.
Case delaunay_case(const Shape& shape) {
  Solid solid = samples::make_solid(shape);
  tessellate::FacetTriangles canonical = tessellate::triangulate_facets(solid);
  Result<delaunay::CanonicalDelaunay> delaunay = delaunay::canonical_delaunay(solid.vertices());
  REQUIRE(delaunay.has_value());
  const delaunay::FollowingTriangles following =
      delaunay::follow_delaunay(solid, canonical, *delaunay);
  REQUIRE(following.missing_total == 0);
  delaunay::Tetrahedralization own;
  own.points.assign(solid.vertices().begin(), solid.vertices().end());
  own.input_count = solid.vertex_count();
  own.tetrahedra = delaunay->tetrahedra;
  for (std::size_t t = 0; t < following.triangles.size(); ++t) {
    own.constrained.push_back({delaunay->faces[following.delaunay_face[t]], following.facet_of[t]});
  }
  return {std::move(solid), std::move(canonical), std::move(own)};
}

/// The cube with one Steiner point, with the Delaunay tetrahedralization of the nine points.
Case cube_with_steiner_point(const Point& steiner, Index facet_of_steiner) {
  const Shape shape = samples::box({0, 0, 0}, {64, 64, 64});
  Solid solid = samples::make_solid(shape);
  tessellate::FacetTriangles canonical = tessellate::triangulate_facets(solid);
  std::vector<Point> points = shape.vertices;
  points.push_back(steiner);
  Result<delaunay::CanonicalDelaunay> delaunay = delaunay::canonical_delaunay(points);
  REQUIRE(delaunay.has_value());
  delaunay::Tetrahedralization own;
  own.points = points;
  own.input_count = 8;
  own.tetrahedra = delaunay->tetrahedra;
  for (const Triangle& face : delaunay->faces) {
    for (Index facet = 0; facet < 6; ++facet) {
      const auto ring = solid.ring(facet);
      const bool is_in = std::all_of(face.begin(), face.end(), [&](Index v) {
        return (v == 8 && facet == facet_of_steiner) ||
               std::find(ring.begin(), ring.end(), v) != ring.end();
      });
      if (is_in) own.constrained.push_back({face, facet});
    }
  }
  return {std::move(solid), std::move(canonical), std::move(own)};
}

Shape cube() { return samples::box({0, 0, 0}, {64, 64, 64}); }

Shape box_with_cavity() {
  Shape shape = samples::box({0, 0, 0}, {90, 90, 90});
  samples::add_box(shape, {30, 30, 30}, {60, 60, 60}, true);
  return shape;
}

TEST_CASE("certificate accepts solids whose boundary is in the Delaunay tetrahedralization") {
  for (const Shape& shape : {cube(), box_with_cavity(), samples::tunnelled_box(),
                             samples::warped_box(1), samples::prism({{0, 0}, {9, 1}, {4, 8}}, 5)}) {
    const delaunay::CertificateResult result = delaunay_case(shape).full();
    INFO(result.detail);
    REQUIRE(delaunay::to_string(result.refusal) == "none");
    CHECK(result.certificate.rung == delaunay::Rung::delaunay);
    CHECK(result.certificate.largest_deviation == 0);
    CHECK(std::count(result.certificate.is_interior.begin(), result.certificate.is_interior.end(),
                     true) > 0);
  }
}

TEST_CASE("certificate names a facet that is not planar and is filled otherwise") {
  CHECK(delaunay_case(cube()).full().certificate.refilled_facets.empty());
  // The roof of the warped box has two triangulations, of which exactly one is canonical.
  Case up = delaunay_case(samples::warped_box(1));
  const delaunay::CertificateResult result = up.full();
  REQUIRE(result.refusal == delaunay::CertificateRefusal::none);
  std::vector<Index> expected;
  for (Index facet = 0; facet < up.solid.facet_count(); ++facet) {
    std::vector<Triangle> canonical;
    std::vector<Triangle> own;
    for (Index t = up.canonical.first[facet]; t < up.canonical.first[facet + 1]; ++t) {
      Triangle triangle = up.canonical.triangles[t];
      std::sort(triangle.begin(), triangle.end());
      canonical.push_back(triangle);
    }
    for (const delaunay::ConstrainedFace& face : up.tetrahedralization.constrained) {
      if (face.facet == facet) own.push_back(face.vertices);
    }
    std::sort(canonical.begin(), canonical.end());
    std::sort(own.begin(), own.end());
    const bool is_warped = facet == 1 || facet == 3 || facet == 5;  // the facets of vertex 7
    if (canonical != own && is_warped && facet == 1) expected.push_back(facet);
  }
  CHECK(result.certificate.refilled_facets == expected);
}

TEST_CASE("certificate accepts a Steiner point on a facet and measures its deviation") {
  const Case exact = cube_with_steiner_point({20, 24, 0}, 0);
  const delaunay::CertificateResult result = exact.full();
  INFO(result.detail);
  REQUIRE(result.refusal == delaunay::CertificateRefusal::none);
  CHECK(result.certificate.largest_deviation == 0);

  const double tiny = 64 * 0x1p-52;
  const delaunay::CertificateResult rounded = cube_with_steiner_point({20, 24, -tiny}, 0).full();
  INFO(rounded.detail);
  REQUIRE(rounded.refusal == delaunay::CertificateRefusal::none);
  CHECK(rounded.certificate.largest_deviation == tiny);
}

TEST_CASE("certificate refuses a Steiner point off its facet") {
  CHECK(cube_with_steiner_point({20, 24, -0.001}, 0).judge() ==
        delaunay::CertificateRefusal::facet_not_conforming);
  CHECK(cube_with_steiner_point({20, 24, 1e-9}, 0).judge() ==
        delaunay::CertificateRefusal::facet_not_conforming);
}

TEST_CASE("certificate refuses a missing, a doubled and a foreign face") {
  for (const Shape& shape : {cube(), box_with_cavity(), samples::tunnelled_box()}) {
    const Case good = delaunay_case(shape);
    for (std::size_t i = 0; i < good.tetrahedralization.constrained.size(); ++i) {
      Case bad = good;
      bad.tetrahedralization.constrained.erase(bad.tetrahedralization.constrained.begin() +
                                               long(i));
      CHECK(bad.judge() == delaunay::CertificateRefusal::facet_not_conforming);

      bad = good;
      bad.tetrahedralization.constrained.push_back(bad.tetrahedralization.constrained[i]);
      CHECK(bad.judge() == delaunay::CertificateRefusal::facet_not_conforming);

      bad = good;
      bad.tetrahedralization.constrained[i].facet =
          (bad.tetrahedralization.constrained[i].facet + 1) % bad.solid.facet_count();
      CHECK(bad.judge() == delaunay::CertificateRefusal::facet_not_conforming);

      bad = good;
      bad.tetrahedralization.constrained[i].facet = bad.solid.facet_count();
      CHECK(bad.judge() == delaunay::CertificateRefusal::foreign_face);
    }
  }
}

TEST_CASE("certificate refuses an inner face with a facet number") {
  const Case good = delaunay_case(box_with_cavity());
  for (const geometry::Tetrahedron& t : good.tetrahedralization.tetrahedra) {
    Triangle face{t[0], t[1], t[2]};
    std::sort(face.begin(), face.end());
    const auto& constrained = good.tetrahedralization.constrained;
    if (std::any_of(constrained.begin(), constrained.end(),
                    [&](const delaunay::ConstrainedFace& c) { return c.vertices == face; })) {
      continue;
    }
    Case bad = good;
    bad.tetrahedralization.constrained.push_back({face, 0});
    CHECK(bad.judge() == delaunay::CertificateRefusal::facet_not_conforming);
  }
}

TEST_CASE("certificate refuses a bubble: the three other faces of a tetrahedron") {
  // A face of a facet is replaced by the other three faces of its tetrahedron: the boundary stays
  // closed.
  const Case good = delaunay_case(cube());
  int bubbles = 0;
  for (const geometry::Tetrahedron& t : good.tetrahedralization.tetrahedra) {
    for (std::size_t skipped = 0; skipped < 4; ++skipped) {
      std::array<Triangle, 4> faces{};
      for (std::size_t f = 0; f < 4; ++f) {
        for (std::size_t i = 0, used = 0; i < 4; ++i) {
          if (i != f) faces[f][used++] = t[i];
        }
        std::sort(faces[f].begin(), faces[f].end());
      }
      Case bad = good;
      auto& constrained = bad.tetrahedralization.constrained;
      const auto at = std::find_if(constrained.begin(), constrained.end(),
                                   [&](const auto& c) { return c.vertices == faces[skipped]; });
      if (at == constrained.end()) continue;
      const Index facet = at->facet;
      constrained.erase(at);
      for (std::size_t f = 0; f < 4; ++f) {
        if (f != skipped) constrained.push_back({faces[f], facet});
      }
      ++bubbles;
      CHECK(bad.judge() == delaunay::CertificateRefusal::facet_not_conforming);
    }
  }
  CHECK(bubbles >= 12);
}

TEST_CASE("certificate refuses a bubble through a Steiner point") {
  // The Steiner point is above the middle of the facet, and the faces of the facet pass through it.
  Case bad = cube_with_steiner_point({32, 32, 8}, 0);
  CHECK(bad.judge() == delaunay::CertificateRefusal::facet_not_conforming);
}

TEST_CASE("certificate refuses flipped, dropped, doubled and strange tetrahedra") {
  const Case good = delaunay_case(box_with_cavity());
  const std::size_t count = good.tetrahedralization.tetrahedra.size();
  for (std::size_t i = 0; i < count; ++i) {
    Case bad = good;
    std::swap(bad.tetrahedralization.tetrahedra[i][0], bad.tetrahedralization.tetrahedra[i][1]);
    CHECK(bad.judge() == delaunay::CertificateRefusal::not_a_complex);

    bad = good;
    bad.tetrahedralization.tetrahedra.erase(bad.tetrahedralization.tetrahedra.begin() + long(i));
    CHECK(bad.judge() != delaunay::CertificateRefusal::none);

    bad = good;
    bad.tetrahedralization.tetrahedra.push_back(bad.tetrahedralization.tetrahedra[i]);
    CHECK(bad.judge() == delaunay::CertificateRefusal::not_a_complex);

    bad = good;
    bad.tetrahedralization.tetrahedra[i][2] = 1000;
    CHECK(bad.judge() == delaunay::CertificateRefusal::not_a_complex);

    bad = good;
    bad.tetrahedralization.tetrahedra[i][2] = bad.tetrahedralization.tetrahedra[i][1];
    CHECK(bad.judge() == delaunay::CertificateRefusal::not_a_complex);
  }
  Case bad = good;
  bad.tetrahedralization.tetrahedra.clear();
  CHECK(bad.judge() == delaunay::CertificateRefusal::vertex_missing);
}

TEST_CASE("certificate refuses moved, dropped and additional vertices") {
  const Case good = delaunay_case(cube());
  for (Index v = 0; v < 8; ++v) {
    Case bad = good;
    bad.tetrahedralization.points[v].x += bad.tetrahedralization.points[v].x == 0 ? -1 : 1;
    CHECK(bad.judge() == delaunay::CertificateRefusal::vertex_missing);
  }
  Case bad = good;
  bad.tetrahedralization.points.push_back({32, 32, 32});
  CHECK(bad.judge() == delaunay::CertificateRefusal::vertex_missing);
  bad = good;
  bad.tetrahedralization.input_count = 7;
  CHECK(bad.judge() == delaunay::CertificateRefusal::vertex_missing);
}

TEST_CASE("certificate refuses an outer surface that is no convex hull") {
  // Two tetrahedra with a common face do not fill the convex hull of the five points.
  Shape shape;
  shape.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {3, 3, 9}, {20, 20, -1}};
  shape.shells = {{{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}}};
  const Solid solid = samples::make_solid(shape);
  const tessellate::FacetTriangles canonical = tessellate::triangulate_facets(solid);
  delaunay::Tetrahedralization own;
  own.points = shape.vertices;
  own.input_count = 5;
  own.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  const delaunay::CertificateResult result =
      delaunay::check_certificate(solid, canonical, own, delaunay::Rung::tetgen);
  CHECK(result.refusal == delaunay::CertificateRefusal::not_convex);
}

TEST_CASE("certificate refuses a complex that winds twice around an edge") {
  // Eight positive wedges around the z axis, of 90 degrees each, cover the square twice.
  Shape shape;
  shape.vertices = {{0, 0, -8}, {0, 0, 8}};
  const std::vector<Point> ring = {{9, 0, 0}, {0, 9, 0},  {-9, 0, 0},  {0, -9, 0},
                                   {8, 1, 0}, {-1, 8, 0}, {-8, -1, 0}, {1, -8, 0}};
  shape.vertices.insert(shape.vertices.end(), ring.begin(), ring.end());
  shape.shells = {{{{0, 2, 1}}}};
  const Solid solid = samples::make_solid(shape);
  const tessellate::FacetTriangles canonical = tessellate::triangulate_facets(solid);
  delaunay::Tetrahedralization own;
  own.points = shape.vertices;
  own.input_count = 10;
  const std::vector<Index> order = {2, 3, 4, 5, 6, 7, 8, 9};
  for (std::size_t i = 0; i < 8; ++i) {
    own.tetrahedra.push_back({0, 1, order[i], order[(i + 1) % 8]});
  }
  const delaunay::CertificateResult result =
      delaunay::check_certificate(solid, canonical, own, delaunay::Rung::tetgen);
  INFO(result.detail);
  CHECK(result.refusal == delaunay::CertificateRefusal::not_convex);
}

TEST_CASE("certificate finds facets and solids that are turned inside out") {
  Shape flipped = cube();
  std::reverse(flipped.shells[0][3][0].begin(), flipped.shells[0][3][0].end());
  const delaunay::CertificateResult one = delaunay_case(flipped).full();
  CHECK(one.refusal == delaunay::CertificateRefusal::wrong_orientation);
  CHECK(one.facet == 3);

  Shape inside_out;
  samples::add_box(inside_out, {0, 0, 0}, {8, 8, 8}, true);
  CHECK(delaunay_case(inside_out).judge() == delaunay::CertificateRefusal::wrong_orientation);

  Shape cavity = samples::box({0, 0, 0}, {90, 90, 90});
  samples::add_box(cavity, {30, 30, 30}, {60, 60, 60}, false);
  CHECK(delaunay_case(cavity).judge() == delaunay::CertificateRefusal::wrong_orientation);
}

TEST_CASE("certificate finds a disconnected interior") {
  Shape beside = cube();
  samples::add_box_facets(beside, {100, 0, 0}, {164, 64, 64}, false);
  CHECK(delaunay_case(beside).judge() == delaunay::CertificateRefusal::interior_disconnected);

  Shape nested = box_with_cavity();  // a solid inside the cavity
  samples::add_box(nested, {40, 40, 40}, {50, 50, 50}, false);
  CHECK(delaunay_case(nested).judge() == delaunay::CertificateRefusal::interior_disconnected);
}

/// Two boxes with a common vertex: the corner of the first one where all coordinates are greatest.
Shape boxes_sharing_a_vertex() {
  Shape shape = samples::box({0, 0, 0}, {8, 8, 8});
  samples::add_box_facets(shape, {8, 8, 8}, {16, 16, 16}, false);
  for (samples::Facet& facet : shape.shells[0]) {
    for (samples::Ring& ring : facet) {
      for (Index& v : ring) {
        if (v == 8) v = 7;
        if (v > 8) --v;
      }
    }
  }
  shape.vertices.erase(shape.vertices.begin() + 8);
  return shape;
}

TEST_CASE("certificate finds bodies that touch in a vertex only") {
  CHECK(delaunay_case(boxes_sharing_a_vertex()).judge() ==
        delaunay::CertificateRefusal::interior_disconnected);
}

TEST_CASE("certificate accepts cavities that touch in a vertex") {
  Shape shape = samples::box({-30, -30, -30}, {46, 46, 46});
  const Shape pair = boxes_sharing_a_vertex();
  const auto first = Index(shape.vertices.size());
  shape.vertices.insert(shape.vertices.end(), pair.vertices.begin(), pair.vertices.end());
  for (std::size_t half = 0; half < 2; ++half) {
    samples::Shell shell;
    for (std::size_t f = 0; f < 6; ++f) {
      samples::Facet facet = pair.shells[0][6 * half + f];
      std::reverse(facet[0].begin(), facet[0].end());
      for (Index& v : facet[0]) v += first;
      shell.push_back(facet);
    }
    shape.shells.push_back(shell);
  }
  const delaunay::CertificateResult result = delaunay_case(shape).full();
  INFO(result.detail);
  CHECK(result.refusal == delaunay::CertificateRefusal::none);

  // The two cavities are declared as one interior shell.
  Shape merged = shape;
  merged.shells[1].insert(merged.shells[1].end(), merged.shells[2].begin(), merged.shells[2].end());
  merged.shells.pop_back();
  CHECK(delaunay_case(merged).judge() == delaunay::CertificateRefusal::cavity_mismatch);
}

TEST_CASE("certificate finds shells that are declared wrongly") {
  Shape swapped = box_with_cavity();
  std::swap(swapped.shells[0], swapped.shells[1]);
  CHECK(delaunay_case(swapped).judge() == delaunay::CertificateRefusal::cavity_mismatch);

  Shape joined = box_with_cavity();  // the exterior shell gets the facets of the cavity
  joined.shells[0].insert(joined.shells[0].end(), joined.shells[1].begin(), joined.shells[1].end());
  joined.shells.pop_back();
  CHECK(delaunay_case(joined).judge() == delaunay::CertificateRefusal::cavity_mismatch);
}

/// The boundary of some unit cubes as one shell: the facets that belong to one cube only.
Shape cubes(const std::vector<std::array<int, 3>>& cells) {
  Shape shape;
  shape.shells.emplace_back();
  std::map<std::array<int, 3>, Index> number;
  const auto index_of = [&](const std::array<int, 3>& at) {
    const auto [place, is_new] = number.try_emplace(at, Index(shape.vertices.size()));
    if (is_new) shape.vertices.push_back({at[0] * 8.0, at[1] * 8.0, at[2] * 8.0});
    return place->second;
  };
  for (const std::array<int, 3>& cell : cells) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> next = cell;
        next[axis] += side == 1 ? 1 : -1;
        if (std::find(cells.begin(), cells.end(), next) != cells.end()) continue;
        std::vector<Index> ring;
        for (const auto& [u, v] :
             {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
          std::array<int, 3> corner = cell;
          corner[axis] += side;
          corner[(axis + 1) % 3] += u;
          corner[(axis + 2) % 3] += v;
          ring.push_back(index_of(corner));
        }
        if (side == 0) std::reverse(ring.begin(), ring.end());
        shape.shells[0].push_back({ring});
      }
    }
  }
  return shape;
}

TEST_CASE("certificate refuses a shell that touches itself in an edge or a vertex") {
  // The feet of an arch touch; its interior is connected over the top.
  const std::vector<std::array<int, 3>> in_an_edge{
      {0, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}};
  CHECK(delaunay_case(cubes(in_an_edge)).judge() == delaunay::CertificateRefusal::not_a_manifold);
  const std::vector<std::array<int, 3>> in_a_vertex{{0, 0, 0}, {1, 1, 1}, {0, 0, 1},
                                                    {0, 0, 2}, {1, 0, 2}, {1, 1, 2}};
  CHECK(delaunay_case(cubes(in_a_vertex)).judge() == delaunay::CertificateRefusal::not_a_manifold);
}

TEST_CASE("certificate finds an open boundary") {
  Shape open = cube();
  open.shells[0].pop_back();
  CHECK(delaunay_case(open).judge() == delaunay::CertificateRefusal::not_a_boundary);
}

}  // namespace
}  // namespace watertight
