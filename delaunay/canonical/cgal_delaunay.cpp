// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: Devillers & Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D
// triangulations" (2011), section 3, as CGAL's Delaunay_triangulation_3 implements it: of five
// cospherical points the lexicographically largest are moved outward on the lifted paraboloid
// first. The perturbation is a function of the coordinates alone, and infinite cells are decided
// by the same rule in the plane of their hull face, so the result does not depend on the order of
// insertion; the insertion order below is for speed only.
// Departures: none.
#include "delaunay/canonical/cgal_delaunay.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "delaunay/cancellation.h"
#include "delaunay/canonical/canonical_order.h"

namespace watertight::delaunay {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>;
using CellBase = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
using DataStructure = CGAL::Triangulation_data_structure_3<VertexBase, CellBase>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, DataStructure>;

/// The order of the points along a Hilbert curve: neighbours in space follow each other.
std::vector<std::size_t> insertion_order(const std::vector<Kernel::Point_3>& points) {
  using Map = CGAL::Pointer_property_map<Kernel::Point_3>::const_type;
  using Traits = CGAL::Spatial_sort_traits_adapter_3<Kernel, Map>;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (points.empty()) return order;
  CGAL::spatial_sort(order.begin(), order.end(), Traits(CGAL::make_property_map(points)));
  return order;
}

Status insert_all(std::span<const Point> points, std::uint64_t max_tetrahedra,
                  const CancelPoll& is_cancelled, Delaunay& delaunay) {
  std::vector<Kernel::Point_3> converted;
  converted.reserve(points.size());
  for (const Point& p : points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return Error{ErrorCode::invalid_argument,
                   "a point of a Delaunay tetrahedralization is not finite"};
    }
    converted.emplace_back(p.x, p.y, p.z);
  }
  Cancellation cancellation(is_cancelled);
  Delaunay::Vertex_handle hint;
  for (const std::size_t i : insertion_order(converted)) {
    // The number of new cells decides when to ask: in degenerate sets each point makes many.
    const std::size_t cells = delaunay.tds().number_of_cells();
    const std::size_t before = delaunay.number_of_vertices();
    hint = delaunay.insert(converted[i], hint);
    if (delaunay.number_of_vertices() == before) {
      return Error{ErrorCode::invalid_argument,
                   "two points of a Delaunay tetrahedralization are equal"};
    }
    hint->info() = static_cast<Index>(i);
    // The count includes infinite cells: at most about as many as finite cells and 2 n.
    if (delaunay.tds().number_of_cells() / 2 > max_tetrahedra) {
      return Error{ErrorCode::limit_exceeded, "the Delaunay tetrahedralization has more than " +
                                                  std::to_string(max_tetrahedra) + " tetrahedra"};
    }
    const std::size_t cells_now = delaunay.tds().number_of_cells();
    if (cancellation.is_due_and_wanted(cells_now > cells ? 1 + cells_now - cells : 1)) {
      return Error{ErrorCode::cancelled, "cancelled by the caller"};
    }
  }
  return Done{};
}

geometry::Tetrahedron vertices_of(Delaunay::Cell_handle cell) {
  return {cell->vertex(0)->info(), cell->vertex(1)->info(), cell->vertex(2)->info(),
          cell->vertex(3)->info()};
}

}  // namespace

Result<CanonicalDelaunay> cgal_delaunay(std::span<const Point> points, std::uint64_t max_tetrahedra,
                                        const CancelPoll& is_cancelled) {
  if (points.size() >= kNone) {
    return Error{ErrorCode::limit_exceeded, "too many points for a Delaunay tetrahedralization"};
  }
  Delaunay delaunay;
  delaunay.infinite_vertex()->info() = kNone;
  if (Status inserted = insert_all(points, max_tetrahedra, is_cancelled, delaunay); !inserted) {
    return std::move(inserted).error();
  }
  if (delaunay.dimension() < 3) return CanonicalDelaunay{};
  std::vector<geometry::Tetrahedron> tetrahedra;
  for (auto cell = delaunay.finite_cells_begin(); cell != delaunay.finite_cells_end(); ++cell) {
    tetrahedra.push_back(vertices_of(cell));
  }
  if (tetrahedra.size() > max_tetrahedra) {
    return Error{ErrorCode::limit_exceeded, "the Delaunay tetrahedralization has more than " +
                                                std::to_string(max_tetrahedra) + " tetrahedra"};
  }
  std::vector<ListedFace> faces;
  for (auto facet = delaunay.finite_facets_begin(); facet != delaunay.finite_facets_end();
       ++facet) {
    const bool is_outside = delaunay.is_infinite(facet->first);
    const auto [cell, corner] = is_outside ? delaunay.mirror_facet(*facet) : *facet;
    const Index beyond = delaunay.mirror_vertex(cell, corner)->info();
    faces.push_back(face_opposite(vertices_of(cell), static_cast<std::size_t>(corner), beyond));
  }
  return list_canonically(std::move(tetrahedra), std::move(faces),
                          static_cast<Index>(points.size()));
}

}  // namespace watertight::delaunay
