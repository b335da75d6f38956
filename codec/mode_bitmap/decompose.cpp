// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: Verbree & Si 2008, "Validation and storage of polyhedra through constrained Delaunay
// tetrahedralization", section 4.1, decomposition steps 1-7.
// Departures: without a certificate, step 1 takes a triangulation of the facets with as many
// Delaunay faces as it finds instead of a CDT, so that no Steiner vertex is stored; coordinates
// that are integers of the lattice are stored as integers; the bitmap may be arithmetic coded;
// facets come back as polygons.
#include "codec/mode_bitmap/decompose.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "codec/mode_bitmap/face_marks.h"
#include "codec/sections/coordinates.h"
#include "delaunay/canonical/follow_delaunay.h"
#include "tessellate/facets.h"

namespace watertight::codec::bitmap {
namespace {

// An insphere determinant is of degree 5: for coordinates in these bounds no product leaves the
// exponent range of a double.
constexpr double kLeastMagnitude = 0x1p-100;
constexpr double kLargestMagnitude = 0x1p100;

Error not_encodable(std::string message) { return {ErrorCode::not_encodable, std::move(message)}; }

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Collects the triangles of all facets: the canonical triangles of each facet for which
/// `takes_canonical` is true, else the triangles that follow the Delaunay tetrahedralization.
void collect_triangles(const delaunay::FollowingTriangles& following,
                       const tessellate::FacetTriangles& facets,
                       const std::vector<bool>& takes_canonical, BoundaryComplex& complex) {
  complex.triangles.clear();
  complex.facet_of.clear();
  for (Index facet = 0; facet < takes_canonical.size(); ++facet) {
    const auto& first = takes_canonical[facet] ? facets.first : following.first;
    const auto& triangles = takes_canonical[facet] ? facets.triangles : following.triangles;
    for (Index i = first[facet]; i < first[facet + 1]; ++i) {
      complex.triangles.push_back(sorted(triangles[i]));
      complex.facet_of.push_back(facet);
    }
  }
}

Result<BoundaryComplex> follow(const geometry::CanonicalSolid& canonical,
                               const CancelPoll& is_cancelled) {
  const Solid& solid = canonical.boundary.solid();
  BoundaryComplex complex;
  complex.points.assign(solid.vertices().begin(), solid.vertices().end());
  complex.vertex_count = solid.vertex_count();
  if (!has_storable_delaunay(complex.points)) {
    return not_encodable(
        "mode bitmap codes only coordinates that are 0 or of magnitude 2^-100 to 2^100");
  }
  auto delaunay = create_delaunay(complex, is_cancelled);
  if (!delaunay) return delaunay.error();
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  const delaunay::FollowingTriangles following =
      delaunay::follow_delaunay(facets.divided_solid(solid), facets, *delaunay);
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    if (following.first[facet] == following.first[facet + 1]) {
      return not_encodable("facet " + std::to_string(canonical.order.facet[facet]) +
                           " has no triangulation");
    }
  }
  // Two facets that are not planar may follow the same Delaunay face; their canonical triangles
  // differ wherever the solid is valid. Each round adds a facet to `takes_canonical`, so the loop
  // ends.
  std::vector<bool> takes_canonical(solid.facet_count(), false);
  do {
    collect_triangles(following, facets, takes_canonical, complex);
  } while (delaunay::part_equal_triangles(complex.triangles, complex.facet_of, takes_canonical));
  complex.delaunay = std::move(delaunay).value();
  return complex;
}

std::vector<Index> inverse_of(const std::vector<Index>& order) {
  std::vector<Index> inverse(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) inverse[order[i]] = static_cast<Index>(i);
  return inverse;
}

/// Does step 1 with a certificate of the solid in its source order.
Result<BoundaryComplex> conform(const geometry::CanonicalSolid& canonical,
                                const delaunay::Certificate& certificate) {
  const Solid& solid = canonical.boundary.solid();
  const delaunay::Tetrahedralization& mesh = certificate.tetrahedralization;
  const Error foreign = not_encodable("the certificate belongs to another solid");
  if (certificate.has_merged_facets) {
    return not_encodable("the certificate is about merged facets (LadderOptions::keeps_facets)");
  }
  if (mesh.input_count != solid.vertex_count() || mesh.points.size() < mesh.input_count) {
    return foreign;
  }
  // source vertex -> canonical vertex
  std::vector<Index> canonical_vertex = inverse_of(canonical.order.vertex);
  for (Index i = 0; i < mesh.input_count; ++i) {
    if (mesh.points[i] != solid.vertices()[canonical_vertex[i]]) return foreign;
  }
  std::vector<Index> steiner(mesh.points.size() - mesh.input_count);
  std::iota(steiner.begin(), steiner.end(), mesh.input_count);
  std::sort(steiner.begin(), steiner.end(),
            [&](Index a, Index b) { return mesh.points[a] < mesh.points[b]; });

  BoundaryComplex complex;
  complex.points.assign(solid.vertices().begin(), solid.vertices().end());
  complex.vertex_count = solid.vertex_count();
  canonical_vertex.resize(mesh.points.size());
  for (const Index vertex : steiner) {
    canonical_vertex[vertex] = static_cast<Index>(complex.points.size());
    Point p = mesh.points[vertex];
    for (int axis = 0; axis < 3; ++axis) p[axis] += 0.0;  // -0 becomes +0
    complex.points.push_back(p);
  }
  if (!has_storable_delaunay(complex.points)) {
    return not_encodable(
        "mode bitmap codes only coordinates that are 0 or of magnitude 2^-100 to 2^100");
  }
  const std::vector<Index> canonical_facet = inverse_of(canonical.order.facet);
  for (const delaunay::ConstrainedFace& face : mesh.constrained) {
    if (face.facet >= canonical_facet.size()) return foreign;
    Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (face.vertices[i] >= canonical_vertex.size()) return foreign;
      triangle[i] = canonical_vertex[face.vertices[i]];
    }
    complex.triangles.push_back(sorted(triangle));
    complex.facet_of.push_back(canonical_facet[face.facet]);
  }
  return complex;
}

}  // namespace

bool has_storable_delaunay(std::span<const Point> points) {
  for (const Point& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      const double magnitude = std::fabs(p[axis]);
      if (magnitude > kLargestMagnitude) return false;
      if (magnitude != 0 && magnitude < kLeastMagnitude) return false;
    }
  }
  return true;
}

std::uint64_t storable_tetrahedra(std::size_t point_count) {
  return std::uint64_t{64} * point_count + 4096;
}

Result<BoundaryComplex> create_cdt(const geometry::CanonicalSolid& solid,
                                   const delaunay::Certificate* certificate,
                                   const CancelPoll& is_cancelled) {
  return certificate != nullptr ? conform(solid, *certificate) : follow(solid, is_cancelled);
}

void store_nodes(const BoundaryComplex& complex, Decomposition& result) {
  const std::span<const Point> points(complex.points);
  result.vertices = write_vertices(points.first(complex.vertex_count));
  if (points.size() > complex.vertex_count) {
    result.steiner = write_steiner_vertices(points.subspan(complex.vertex_count));
  }
}

Result<MarkedFaces> mark_cdt_faces(const BoundaryComplex& complex) {
  std::vector<Index> order(complex.triangles.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return complex.triangles[a] != complex.triangles[b]
               ? complex.triangles[a] < complex.triangles[b]
               : a < b;
  });
  MarkedFaces marked;
  for (const Index i : order) {
    if (!marked.triangles.empty() && marked.triangles.back() == complex.triangles[i]) {
      return not_encodable("two triangles of the boundary coincide");
    }
    marked.triangles.push_back(complex.triangles[i]);
    marked.facet_of.push_back(complex.facet_of[i]);
  }
  return marked;
}

Result<delaunay::CanonicalDelaunay> create_delaunay(const BoundaryComplex& complex,
                                                    const CancelPoll& is_cancelled) {
  if (complex.delaunay) return *complex.delaunay;
  auto delaunay = delaunay::canonical_delaunay(
      complex.points, storable_tetrahedra(complex.points.size()), is_cancelled);
  if (!delaunay) return not_encodable(delaunay.error().message);
  if (delaunay->tetrahedra.empty()) return not_encodable("the vertices span no volume");
  return delaunay;
}

std::vector<bool> mark_delaunay_faces(const MarkedFaces& marked,
                                      const delaunay::CanonicalDelaunay& delaunay) {
  std::vector<bool> marks(delaunay.faces.size(), false);
  std::size_t face = 0;
  for (const Triangle& triangle : marked.triangles) {
    while (face < delaunay.faces.size() && delaunay.faces[face] < triangle) ++face;
    if (face < delaunay.faces.size() && delaunay.faces[face] == triangle) marks[face] = true;
  }
  return marks;
}

void store_bitmap(const delaunay::CanonicalDelaunay& delaunay, const std::vector<bool>& marks,
                  Decomposition& result) {
  result.bitmap = write_marks(BitCoding::plain, delaunay, marks);
  result.bitmap_coding = BitCoding::plain;
  Bytes coded = write_marks(BitCoding::arithmetic, delaunay, marks);
  if (coded.size() < result.bitmap.size()) {
    result.bitmap = std::move(coded);
    result.bitmap_coding = BitCoding::arithmetic;
  }
}

void store_unrecovered_faces(const MarkedFaces& marked, const delaunay::CanonicalDelaunay& delaunay,
                             Decomposition& result) {
  std::vector<Triangle> unrecovered;
  std::set_difference(marked.triangles.begin(), marked.triangles.end(), delaunay.faces.begin(),
                      delaunay.faces.end(), std::back_inserter(unrecovered));
  if (!unrecovered.empty()) result.unrecovered = write_face_list(unrecovered);
}

Result<Decomposition> decompose(const geometry::CanonicalSolid& solid,
                                const delaunay::Certificate* certificate,
                                const CancelPoll& is_cancelled) {
  Decomposition result;
  auto complex = create_cdt(solid, certificate, is_cancelled);
  if (!complex) return complex.error();
  store_nodes(*complex, result);
  auto marked = mark_cdt_faces(*complex);
  if (!marked) return marked.error();
  auto delaunay = create_delaunay(*complex, is_cancelled);
  if (!delaunay) return delaunay.error();
  const std::vector<bool> marks = mark_delaunay_faces(*marked, *delaunay);
  store_bitmap(*delaunay, marks, result);
  store_unrecovered_faces(*marked, *delaunay, result);
  result.facets = write_facet_structure(complex->points, *marked, solid.boundary.solid());
  const auto found = static_cast<Index>(std::count(marks.begin(), marks.end(), true));
  result.counts = {static_cast<Index>(complex->points.size()) - complex->vertex_count,
                   static_cast<Index>(delaunay->faces.size()), found,
                   static_cast<Index>(marked->triangles.size()) - found};
  return result;
}

}  // namespace watertight::codec::bitmap
