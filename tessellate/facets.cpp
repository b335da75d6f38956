// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: L. P. Chew, "Constrained Delaunay triangulations", Algorithmica 4 (1989); ties after
// O. Devillers and M. Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D
// triangulations" (2011), in the plane: of four points on a circle the lexicographically largest
// counts as outside. With that rule no edge is a tie, so the triangulation is unique. For a facet
// of one ring of four points that are not in one plane, a tie gives the shorter diagonal instead,
// so that the mirror image of the facet has the mirror image of its triangles. Departures: regions
// are found by winding numbers per ring instead of nesting depth, because a depth counted by edge
// crossings is wrong in a pocket that two holes enclose by touching twice.
#include "tessellate/facets.h"

#include <algorithm>
#include <utility>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

#include "geometry/predicates/predicates.h"
#include "tessellate/few_vertices.h"
#include "tessellate/flatness.h"

namespace watertight::tessellate {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using PlanePoint = Kernel::Point_2;

/// The winding numbers of a region: how often the exterior ring and the interior rings go around
/// it.
struct Winding {
  int exterior = 0;
  int interior = 0;
};

struct PlaneFace {
  std::array<Winding, 3> change{};  // the change of the winding across edge i, out of this face
  std::array<bool, 3> is_ring_edge{};
  Winding winding;
  bool is_visited = false;
};

using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<PlaneFace, Kernel>>;
using PlaneTriangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_tag>;
using VertexHandle = PlaneTriangulation::Vertex_handle;
using FaceHandle = PlaneTriangulation::Face_handle;

/// Below this number of vertices the insertion order does not matter for speed.
constexpr std::size_t kFewVertices = 32;

class FacetTriangulator {
 public:
  explicit FacetTriangulator(const Solid& solid) : solid_(solid), vertices_(solid.vertices()) {}

  /// Appends the triangles of a facet to `triangles`.
  FacetState triangulate(Index facet, std::vector<Triangle>& triangles);

 private:
  FacetState triangulate_three(std::span<const Index> ring, std::vector<Triangle>& triangles);
  bool is_even_diagonal(std::span<const Index> ring, const std::array<PlanePoint, 4>& p) const;
  bool triangulate_convex_four(std::span<const Index> ring, std::vector<Triangle>& triangles);
  bool triangulate_few(std::span<const Index> ring, std::vector<Triangle>& triangles);
  FacetState triangulate_any(IndexRange rings, std::vector<Triangle>& triangles);
  bool collect_vertices(IndexRange rings);
  bool insert_vertices(PlaneTriangulation& plane);
  bool insert_ring(PlaneTriangulation& plane, std::span<const Index> ring);
  bool label_ring(PlaneTriangulation& plane, std::span<const Index> ring, bool is_exterior);
  int turn_of_ring(std::span<const Index> ring) const;
  void append(Index a, Index b, Index c, std::vector<Triangle>& triangles) const;

  PlanePoint project(Index vertex) const {
    const Point& p = vertices_[vertex];
    return {p[(projection_.axis + 1) % 3], p[(projection_.axis + 2) % 3]};
  }
  VertexHandle handle_of(Index vertex) const {
    const auto place = std::lower_bound(used_.begin(), used_.end(), vertex);
    return handles_[static_cast<std::size_t>(place - used_.begin())];
  }

  const Solid& solid_;
  std::span<const Point> vertices_;
  Projection projection_;
  std::vector<Index> used_;            // the facet's vertices, ascending, once each
  std::vector<VertexHandle> handles_;  // the handles of the vertices in used_
  std::vector<Index> scratch_;
  std::vector<FewVertices::PlanePoint> ring_points_;
  FewVertices few_;
};

/// Appends a triangle, its smallest point first.
void FacetTriangulator::append(Index a, Index b, Index c, std::vector<Triangle>& triangles) const {
  if (vertices_[b] < vertices_[a] && vertices_[b] < vertices_[c]) {
    triangles.push_back({b, c, a});
  } else if (vertices_[c] < vertices_[a] && vertices_[c] < vertices_[b]) {
    triangles.push_back({c, a, b});
  } else {
    triangles.push_back({a, b, c});
  }
}

FacetState FacetTriangulator::triangulate_three(std::span<const Index> ring,
                                                std::vector<Triangle>& triangles) {
  if (ring[0] == ring[1] || ring[1] == ring[2] || ring[2] == ring[0]) return FacetState::degenerate;
  if (geometry::are_collinear(vertices_[ring[0]], vertices_[ring[1]], vertices_[ring[2]])) {
    return FacetState::degenerate;
  }
  append(ring[0], ring[1], ring[2], triangles);
  return FacetState::triangulated;
}

/// For four points whose projections are on a circle: true if the diagonal 0-2 is chosen. If the
/// points are not in one plane, the shorter diagonal in space is chosen, which is the same for the
/// mirror image, for every numbering and from both sides of the facet. Coordinates decide between
/// equal diagonals, and in flat facets, where the choice makes no difference.
bool FacetTriangulator::is_even_diagonal(std::span<const Index> ring,
                                         const std::array<PlanePoint, 4>& p) const {
  const auto at = [&](std::size_t i) -> const Point& { return vertices_[ring[i]]; };
  if (!are_coplanar(at(0), at(1), at(2), at(3))) {
    const auto q = [&](std::size_t i) { return Kernel::Point_3(at(i).x, at(i).y, at(i).z); };
    const auto order = Kernel().compare_distance_3_object()(q(0), q(2), q(1), q(3));
    if (order != CGAL::EQUAL) return order == CGAL::SMALLER;
  }
  return (std::max_element(p.begin(), p.end()) - p.begin()) % 2 == 1;
}

/// Appends the two triangles of a strictly convex quadrilateral. False, and no triangles, for
/// others.
bool FacetTriangulator::triangulate_convex_four(std::span<const Index> ring,
                                                std::vector<Triangle>& triangles) {
  std::array<PlanePoint, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = project(ring[i]);
  const auto turn = CGAL::orientation(p[0], p[1], p[2]);
  if (turn == CGAL::COLLINEAR) return false;
  for (std::size_t i = 1; i < 4; ++i) {
    if (CGAL::orientation(p[i], p[(i + 1) % 4], p[(i + 2) % 4]) != turn) return false;
  }
  auto side = CGAL::side_of_oriented_circle(p[0], p[1], p[2], p[3]);
  if (turn == CGAL::RIGHT_TURN) side = -side;
  bool is_even = side == CGAL::ON_NEGATIVE_SIDE;  // vertex 3 is outside: diagonal 0-2
  if (side == CGAL::ON_ORIENTED_BOUNDARY) is_even = is_even_diagonal(ring, p);
  if (is_even) {
    append(ring[0], ring[1], ring[2], triangles);
    append(ring[0], ring[2], ring[3], triangles);
  } else {
    append(ring[0], ring[1], ring[3], triangles);
    append(ring[1], ring[2], ring[3], triangles);
  }
  return true;
}

/// Appends the triangles of a simple ring of few vertices. False, and no triangles, for others.
bool FacetTriangulator::triangulate_few(std::span<const Index> ring,
                                        std::vector<Triangle>& triangles) {
  if (ring.size() > FewVertices::kMost) return false;
  ring_points_.clear();
  for (const Index vertex : ring) {
    const PlanePoint point = project(vertex);
    ring_points_.push_back({point.x(), point.y()});
  }
  const auto found = few_.triangulate(ring_points_);
  for (auto [a, b, c] : found) {
    if (projection_.is_mirrored) std::swap(b, c);
    append(ring[a], ring[b], ring[c], triangles);
  }
  return !found.empty();
}

/// Collects the vertices of the facet. False if a ring is too short or passes a vertex twice.
bool FacetTriangulator::collect_vertices(IndexRange rings) {
  used_.clear();
  for (Index r = rings.begin; r < rings.end; ++r) {
    const std::span<const Index> ring = solid_.ring(r);
    if (ring.size() < 3) return false;
    scratch_.assign(ring.begin(), ring.end());
    std::sort(scratch_.begin(), scratch_.end());
    if (std::adjacent_find(scratch_.begin(), scratch_.end()) != scratch_.end()) return false;
    used_.insert(used_.end(), ring.begin(), ring.end());
  }
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  return true;
}

/// Inserts the vertices into the triangulation. False if two of them have the same projection.
bool FacetTriangulator::insert_vertices(PlaneTriangulation& plane) {
  std::vector<PlanePoint> points;
  std::vector<std::size_t> order;
  points.reserve(used_.size());
  for (const Index vertex : used_) {
    order.push_back(points.size());
    points.push_back(project(vertex));
  }
  if (order.size() > kFewVertices) {
    const auto map = CGAL::make_property_map(points);
    CGAL::hilbert_sort(order.begin(), order.end(),
                       CGAL::Spatial_sort_traits_adapter_2<Kernel, decltype(map)>(map));
  }
  handles_.assign(used_.size(), VertexHandle());
  FaceHandle near;
  for (const std::size_t i : order) {
    const std::size_t before = plane.number_of_vertices();
    handles_[i] = plane.insert(points[i], near);
    if (plane.number_of_vertices() == before) return false;
    handles_[i]->info() = used_[i];
    near = handles_[i]->face();
  }
  return true;
}

/// Inserts the edges of a ring. False if an edge crosses an edge inserted before.
bool FacetTriangulator::insert_ring(PlaneTriangulation& plane, std::span<const Index> ring) {
  VertexHandle from = handle_of(ring.back());
  for (const Index vertex : ring) {
    const VertexHandle to = handle_of(vertex);
    try {
      plane.insert_constraint(from, to);
    } catch (const PlaneTriangulation::Intersection_of_constraints_exception&) {
      return false;
    }
    from = to;
  }
  return true;
}

/// +1 if the ring turns left, -1 if right, 0 if it has a spike at its smallest vertex.
int FacetTriangulator::turn_of_ring(std::span<const Index> ring) const {
  std::size_t smallest = 0;
  for (std::size_t i = 1; i < ring.size(); ++i) {
    if (project(ring[i]) < project(ring[smallest])) smallest = i;
  }
  const std::size_t count = ring.size();
  return CGAL::orientation(project(ring[(smallest + count - 1) % count]), project(ring[smallest]),
                           project(ring[(smallest + 1) % count]));
}

/// Notes for each edge of a ring how the winding changes across it. False if an edge of the ring is
/// not an edge of the triangulation (a vertex lies on it) or is also an edge of another ring.
bool FacetTriangulator::label_ring(PlaneTriangulation& plane, std::span<const Index> ring,
                                   bool is_exterior) {
  const int turn = turn_of_ring(ring);
  if (turn == 0) return false;
  VertexHandle from = handle_of(ring.back());
  for (const Index vertex : ring) {
    const VertexHandle to = handle_of(vertex);
    FaceHandle face;
    int edge = 0;
    if (!plane.is_edge(from, to, face, edge) || !face->is_constrained(edge)) return false;
    const bool is_left = face->vertex(PlaneTriangulation::ccw(edge)) == from;
    const FaceHandle mirror = face->neighbor(edge);
    const auto here = static_cast<std::size_t>(edge);
    const auto there = static_cast<std::size_t>(plane.mirror_index(face, edge));
    if (face->info().is_ring_edge[here]) return false;
    face->info().is_ring_edge[here] = mirror->info().is_ring_edge[there] = true;
    // Leaving the left side of a left-turning ring means leaving its inside.
    const int leave = is_left ? -turn : turn;
    face->info().change[here] = is_exterior ? Winding{leave, 0} : Winding{0, leave};
    mirror->info().change[there] = is_exterior ? Winding{-leave, 0} : Winding{0, -leave};
    from = to;
  }
  return true;
}

/// Sets every face's winding. False if an interior ring is outside the exterior or inside another.
bool flood(PlaneTriangulation& plane) {
  std::vector<FaceHandle> open{plane.infinite_face()};
  open.front()->info().is_visited = true;
  while (!open.empty()) {
    const FaceHandle face = open.back();
    open.pop_back();
    const PlaneFace& info = face->info();
    for (int edge = 0; edge < 3; ++edge) {
      const FaceHandle next = face->neighbor(edge);
      if (next->info().is_visited) continue;
      const Winding& change = info.change[static_cast<std::size_t>(edge)];
      const Winding winding{info.winding.exterior + change.exterior,
                            info.winding.interior + change.interior};
      if (winding.interior > winding.exterior || winding.interior > 1) return false;
      next->info().winding = winding;
      next->info().is_visited = true;
      open.push_back(next);
    }
  }
  return true;
}

FacetState FacetTriangulator::triangulate_any(IndexRange rings, std::vector<Triangle>& triangles) {
  if (!collect_vertices(rings)) return FacetState::not_simple;
  PlaneTriangulation plane;
  if (!insert_vertices(plane) || plane.dimension() < 2) return FacetState::not_simple;
  for (Index r = rings.begin; r < rings.end; ++r) {
    if (!insert_ring(plane, solid_.ring(r))) return FacetState::not_simple;
  }
  for (Index r = rings.begin; r < rings.end; ++r) {
    if (!label_ring(plane, solid_.ring(r), r == rings.begin)) return FacetState::not_simple;
  }
  if (!flood(plane)) return FacetState::not_simple;

  for (const FaceHandle face : plane.finite_face_handles()) {
    const Winding& winding = face->info().winding;
    if (winding.exterior != 1 || winding.interior != 0) continue;
    Index b = face->vertex(1)->info();
    Index c = face->vertex(2)->info();
    if (projection_.is_mirrored) std::swap(b, c);
    append(face->vertex(0)->info(), b, c, triangles);
  }
  return FacetState::triangulated;
}

FacetState FacetTriangulator::triangulate(Index facet, std::vector<Triangle>& triangles) {
  const IndexRange rings = solid_.rings_of(facet);
  if (rings.size() == 0) return FacetState::degenerate;
  const std::span<const Index> exterior = solid_.ring(rings.begin);
  if (exterior.size() < 3) return FacetState::degenerate;
  if (rings.size() == 1 && exterior.size() == 3) return triangulate_three(exterior, triangles);

  projection_ = facet_projection(solid_, facet);
  if (projection_.is_degenerate) return FacetState::degenerate;
  if (rings.size() == 1 && exterior.size() == 4 && triangulate_convex_four(exterior, triangles)) {
    return FacetState::triangulated;
  }
  if (rings.size() == 1 && triangulate_few(exterior, triangles)) return FacetState::triangulated;
  return triangulate_any(rings, triangles);
}

FacetTriangles triangulate_each(const Solid& solid) {
  FacetTriangles result;
  result.state.reserve(solid.facet_count());
  result.first.reserve(std::size_t{solid.facet_count()} + 1);
  FacetTriangulator triangulator(solid);
  const std::span<const Point> vertices = solid.vertices();
  const auto by_points = [&](const Triangle& a, const Triangle& b) {
    return std::tie(vertices[a[0]], vertices[a[1]], vertices[a[2]]) <
           std::tie(vertices[b[0]], vertices[b[1]], vertices[b[2]]);
  };
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    const auto first = static_cast<std::ptrdiff_t>(result.triangles.size());
    result.state.push_back(triangulator.triangulate(facet, result.triangles));
    std::sort(result.triangles.begin() + first, result.triangles.end(), by_points);
    result.facet_of.resize(result.triangles.size(), facet);
    result.first.push_back(static_cast<Index>(result.triangles.size()));
  }
  return result;
}

/// The facets with several rings that bound no region unless vertices split their edges.
std::vector<Index> facets_to_divide(const Solid& solid, const FacetTriangles& facets) {
  std::vector<Index> list;
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    const bool is_simple = facets.state[facet] != FacetState::not_simple;
    if (!is_simple && solid.rings_of(facet).size() > 1) list.push_back(facet);
  }
  return list;
}

/// Removes the touches of facets whose rings bound no region even when they are divided.
void keep_triangulated(const Solid& solid, const FacetTriangles& facets,
                       std::vector<geometry::RingTouch>& touches) {
  Index facet = 0;
  std::erase_if(touches, [&](const geometry::RingTouch& touch) {
    const auto end_of = [&](Index f) { return solid.arrays().ring_offsets[solid.rings_of(f).end]; };
    while (touch.corner >= end_of(facet)) ++facet;
    return facets.state[facet] != FacetState::triangulated;
  });
}

}  // namespace

FacetTriangles triangulate_facets(const Solid& solid) {
  FacetTriangles whole = triangulate_each(solid);
  const std::vector<Index> facets = facets_to_divide(solid, whole);
  if (facets.empty()) return whole;
  std::vector<geometry::RingTouch> touches = geometry::ring_touches(solid, facets);
  if (touches.empty()) return whole;
  FacetTriangles divided = triangulate_each(geometry::divide_rings(solid, touches).solid);
  keep_triangulated(solid, divided, touches);
  if (!touches.empty()) divided.divided = geometry::divide_rings(solid, touches);
  return divided;
}

}  // namespace watertight::tessellate
