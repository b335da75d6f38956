// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/fill.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace watertight::tessellate {
namespace {

using FillKernel = CGAL::Exact_predicates_exact_constructions_kernel;

struct FillVertex {
  Index vertex = kNone;  // none for a crossing
};

struct FillFace {
  bool is_visited = false;
  bool is_inside = false;
};

using FillVertexBase = CGAL::Triangulation_vertex_base_with_info_2<FillVertex, FillKernel>;
using FillFaceBase = CGAL::Constrained_triangulation_face_base_2<
    FillKernel, CGAL::Triangulation_face_base_with_info_2<FillFace, FillKernel>>;
using FillPlane = CGAL::Constrained_triangulation_plus_2<CGAL::Constrained_Delaunay_triangulation_2<
    FillKernel, CGAL::Triangulation_data_structure_2<FillVertexBase, FillFaceBase>,
    CGAL::Exact_intersections_tag>>;

Point difference(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double squared(const Point& a) { return a.x * a.x + a.y * a.y + a.z * a.z; }

/// The plane through the first vertex of a ring, the vertex farthest from it, and the one farthest
/// from the line through both.
struct FitPlane {
  Point origin;
  Point normal;  // zero if the ring is on one line
  int axis = 2;  // of the largest component of the normal: the dropped one

  static FitPlane of(const Solid& solid, std::span<const Index> ring) {
    FitPlane plane;
    plane.origin = solid.vertices()[ring.front()];
    Point along;
    for (const Index vertex : ring) {
      const Point way = difference(solid.vertices()[vertex], plane.origin);
      if (squared(way) > squared(along)) along = way;
    }
    for (const Index vertex : ring) {
      const Point normal = cross(along, difference(solid.vertices()[vertex], plane.origin));
      if (squared(normal) > squared(plane.normal)) plane.normal = normal;
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(plane.normal[axis]) > std::abs(plane.normal[plane.axis])) plane.axis = axis;
    }
    return plane;
  }

  /// The point of the plane above a place of the projection.
  Point lift(double first, double second) const {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    Point point;
    point[u] = first;
    point[v] = second;
    point[axis] =
        origin[axis] -
        (normal[u] * (first - origin[u]) + normal[v] * (second - origin[v])) / normal[axis];
    return point;
  }
};

/// The number of pairs of edges that overlap along one axis of the projection, counted up to `most`
/// + 1.
std::uint64_t overlapping_pairs(const Solid& solid, IndexRange rings, int axis,
                                std::uint64_t most) {
  const int along = (axis + 1) % 3;
  std::vector<std::pair<double, double>> edges;  // where they begin and end
  for (Index r = rings.begin; r < rings.end; ++r) {
    const std::span<const Index> ring = solid.ring(r);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      edges.push_back(std::minmax({solid.vertices()[ring[i]][along],
                                   solid.vertices()[ring[(i + 1) % ring.size()]][along]}));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::uint64_t pairs = 0;
  for (std::size_t i = 0; i < edges.size() && pairs <= most; ++i) {
    for (std::size_t k = i + 1; k < edges.size() && edges[k].first <= edges[i].second; ++k) {
      if (++pairs > most) break;
    }
  }
  return pairs;
}

void insert_rings(FillPlane& plane, const Solid& solid, IndexRange rings, int axis) {
  const auto insert = [&](Index vertex) {
    const Point& p = solid.vertices()[vertex];
    const auto handle = plane.insert(FillKernel::Point_2(p[(axis + 1) % 3], p[(axis + 2) % 3]));
    if (handle->info().vertex == kNone) handle->info().vertex = vertex;
    return handle;
  };
  for (Index r = rings.begin; r < rings.end; ++r) {
    const std::span<const Index> ring = solid.ring(r);
    std::vector<FillPlane::Vertex_handle> handles;
    for (const Index vertex : ring) handles.push_back(insert(vertex));
    for (std::size_t i = 0; i < handles.size(); ++i) {
      const auto& next = handles[(i + 1) % handles.size()];
      if (handles[i] != next) plane.insert_constraint(handles[i], next);
    }
  }
}

/// Notes which faces are inside an odd number of rings.
void mark_inside(FillPlane& plane) {
  std::vector<FillPlane::Face_handle> open{plane.infinite_face()};
  open.front()->info().is_visited = true;
  while (!open.empty()) {
    const auto face = open.back();
    open.pop_back();
    for (int edge = 0; edge < 3; ++edge) {
      const auto next = face->neighbor(edge);
      if (next->info().is_visited) continue;
      bool is_odd = false;
      if (face->is_constrained(edge)) {
        const auto rings = plane.number_of_enclosing_constraints(
            face->vertex(FillPlane::cw(edge)), face->vertex(FillPlane::ccw(edge)));
        is_odd = rings % 2 == 1;
      }
      next->info() = {true, face->info().is_inside != is_odd};
      open.push_back(next);
    }
  }
}

/// Twice the area of a ring in the projection along an axis.
double doubled_area(const Solid& solid, std::span<const Index> ring, int axis) {
  const Point& origin = solid.vertices()[ring.front()];
  double area = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point a = difference(solid.vertices()[ring[i]], origin);
    const Point b = difference(solid.vertices()[ring[(i + 1) % ring.size()]], origin);
    area += cross(a, b)[axis];
  }
  return area;
}

}  // namespace

std::optional<FilledFacet> fill_facet(const Solid& solid, Index facet, std::uint64_t& pairs) {
  const IndexRange rings = solid.rings_of(facet);
  if (rings.size() == 0 || solid.ring(rings.begin).empty()) return FilledFacet{};
  const std::span<const Index> exterior = solid.ring(rings.begin);
  const FitPlane fit = FitPlane::of(solid, exterior);
  if (fit.normal[fit.axis] == 0) return FilledFacet{};
  const std::uint64_t own = overlapping_pairs(solid, rings, fit.axis, pairs);
  if (own > pairs) {
    pairs = 0;
    return std::nullopt;
  }
  pairs -= own;

  FillPlane plane;
  insert_rings(plane, solid, rings, fit.axis);
  if (plane.dimension() < 2) return FilledFacet{};
  mark_inside(plane);
  const bool is_mirrored = doubled_area(solid, exterior, fit.axis) < 0;
  const auto corner = [&](FillPlane::Vertex_handle vertex) {
    if (vertex->info().vertex != kNone) return solid.vertices()[vertex->info().vertex];
    return fit.lift(CGAL::to_double(vertex->point().x()), CGAL::to_double(vertex->point().y()));
  };
  FilledFacet triangles;
  for (const auto face : plane.finite_face_handles()) {
    if (!face->info().is_inside) continue;
    triangles.push_back(
        {corner(face->vertex(0)), corner(face->vertex(1)), corner(face->vertex(2))});
    if (is_mirrored) std::swap(triangles.back()[1], triangles.back()[2]);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace watertight::tessellate
