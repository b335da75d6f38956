// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mode walk: codes the columns, then the triangles of the boundary among the Delaunay faces, then
// the facets. Based on: Verbree & Si 2008, section 4.1, in spirit: vertices first, then their
// Delaunay tetrahedralization determines most of the boundary.
#include <algorithm>
#include <cstddef>
#include <utility>

#include "codec/mode_walk/columns.h"
#include "codec/mode_walk/facet_flags.h"
#include "codec/mode_walk/families.h"
#include "codec/mode_walk/walk.h"
#include "codec/page/modes.h"
#include "delaunay/canonical/follow_delaunay.h"
#include "tessellate/facets.h"

namespace watertight::codec::walk {
namespace {

/// The most tetrahedra for a number of points: more than solids have, so that hostile vertices
/// cannot take much time. (Solids of the test data have up to 8.5 tetrahedra for each vertex.)
std::uint64_t max_tetrahedra(std::size_t points) { return std::uint64_t{24} * points + 4096; }

/// The vertices relative to the smallest corner of their box.
std::vector<Point> points_of(const std::vector<GridPoint>& vertices) {
  GridPoint min = vertices.front();
  for (const GridPoint& v : vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) min[axis] = std::min(min[axis], v[axis]);
  }
  std::vector<Point> points;
  points.reserve(vertices.size());
  for (const GridPoint& v : vertices) {
    points.push_back({static_cast<double>(v[0] - min[0]), static_cast<double>(v[1] - min[1]),
                      static_cast<double>(v[2] - min[2])});
  }
  return points;
}

/// The solid with these points as vertices, for triangulate_facets() and follow_delaunay().
Result<Solid> solid_on(const std::vector<Point>& points, const IntegerSolid& solid) {
  SolidArrays arrays;
  arrays.vertices = points;
  arrays.ring_vertices = solid.ring_vertices;
  arrays.ring_offsets = solid.ring_offsets;
  arrays.facet_offsets = solid.facet_offsets;
  arrays.shell_offsets = solid.shell_offsets;
  const Limits none{.vertices = kNone, .facets = kNone, .rings = kNone, .shells = kNone};
  return Solid::make(std::move(arrays), Lattice{}, 0, none);
}

/// For writing: the triangles of all facets, along the Delaunay faces, shell by shell. facet_of[i]
/// is the facet of triangle i.
Result<BoundaryMesh> triangulate(const std::vector<Point>& points, const IntegerSolid& integer,
                                 const delaunay::CanonicalDelaunay& delaunay,
                                 std::vector<Index>& facet_of) {
  const Error refused{ErrorCode::not_encodable, "a facet has no triangulation"};
  const auto solid = solid_on(points, integer);
  if (!solid) return refused;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(*solid);
  if (facets.divided) {
    return Error{ErrorCode::not_encodable,
                 "mode walk finds rings by the edges of triangles; a vertex of a ring lies inside "
                 "an edge of another ring of its facet"};
  }
  delaunay::FollowingTriangles following = delaunay::follow_delaunay(*solid, facets, delaunay);
  BoundaryMesh mesh;
  for (Index facet = 0; facet < solid->facet_count(); ++facet) {
    if (following.first[facet] == following.first[facet + 1]) return refused;
  }
  for (Index shell = 0; shell < solid->shell_count(); ++shell) {
    mesh.component_first.push_back(following.first[integer.shell_offsets[shell + 1]]);
  }
  mesh.triangles = std::move(following.triangles);
  facet_of = std::move(following.facet_of);
  return mesh;
}

}  // namespace

const ModelLayout& model_layout() {
  static constexpr ModelLayout layout{kFamilies, kNumbers};
  return layout;
}

Status code_solid(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                  IntegerSolid& solid, const WriterChoice& /*choice*/, const Limits& limits) {
  if (!stream.is_reading() && solid.vertices.size() < 4) {
    return Error{ErrorCode::not_encodable, "the vertices span no volume"};
  }
  if (Status status = code_columns(stream, models, memory, solid.vertices, limits); !status) {
    return status;
  }
  const ErrorCode failure = stream.is_reading() ? ErrorCode::malformed : ErrorCode::not_encodable;
  if (stream.failed()) return Error{failure, "the columns of the vertices"};
  const std::vector<Point> points = points_of(solid.vertices);
  for (const Point& p : points) {
    if (p.x >= 0x1p30 || p.y >= 0x1p30 || p.z >= 0x1p30) {
      return Error{failure, "the solid is too large for its grid"};
    }
  }
  const auto delaunay =
      delaunay::canonical_delaunay(points, max_tetrahedra(points.size()), limits.poll());
  if (!delaunay) return Error{failure, delaunay.error().message};
  if (delaunay->tetrahedra.empty()) return Error{failure, "the vertices span no volume"};

  BoundaryMesh mesh;
  std::vector<Index> given_facet_of;
  if (!stream.is_reading()) {
    auto triangulated = triangulate(points, solid, *delaunay, given_facet_of);
    if (!triangulated) return triangulated.error();
    mesh = std::move(triangulated).value();
  }
  stream.enter(StreamPart::connectivity);
  if (Status status = code_boundary_walk(stream, models, points, *delaunay, mesh); !status) {
    return status;
  }
  if (mesh.component_count() > limits.shells || mesh.triangles.size() > 4 * limits.facets) {
    return Error{ErrorCode::limit_exceeded, "too many facets"};
  }
  std::vector<Index> facet_of;
  for (const Index source : mesh.source) facet_of.push_back(given_facet_of[source]);
  return code_facets(stream, models, points, mesh, facet_of, solid);
}

}  // namespace watertight::codec::walk
