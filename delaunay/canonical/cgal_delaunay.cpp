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
#include "delaunay/canonical/growing_delaunay.h"

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

geometry::Tetrahedron vertices_of(Delaunay::Cell_handle cell) {
  return {cell->vertex(0)->info(), cell->vertex(1)->info(), cell->vertex(2)->info(),
          cell->vertex(3)->info()};
}

CanonicalDelaunay list(const Delaunay& delaunay) {
  if (delaunay.dimension() < 3) return CanonicalDelaunay{};
  std::vector<geometry::Tetrahedron> tetrahedra;
  for (auto cell = delaunay.finite_cells_begin(); cell != delaunay.finite_cells_end(); ++cell) {
    tetrahedra.push_back(vertices_of(cell));
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
                          static_cast<Index>(delaunay.number_of_vertices()));
}

Error too_many_tetrahedra(std::uint64_t max_tetrahedra) {
  return {ErrorCode::limit_exceeded, "the Delaunay tetrahedralization has more than " +
                                         std::to_string(max_tetrahedra) + " tetrahedra"};
}

}  // namespace

struct GrowingDelaunay::State {
  Delaunay delaunay;
  std::vector<Delaunay::Vertex_handle> vertices;
  std::vector<bool> is_changed;  // vertex -> it has new neighbours
};

GrowingDelaunay::GrowingDelaunay() : state_(std::make_unique<State>()) {
  state_->delaunay.infinite_vertex()->info() = kNone;
}

GrowingDelaunay::~GrowingDelaunay() = default;

Status GrowingDelaunay::insert(std::span<const Point> points, std::uint64_t max_tetrahedra,
                               const CancelPoll& is_cancelled) {
  Delaunay& delaunay = state_->delaunay;
  const std::size_t first = state_->vertices.size();
  if (points.size() >= kNone - first) {
    return Error{ErrorCode::limit_exceeded, "too many points for a Delaunay tetrahedralization"};
  }
  std::vector<Kernel::Point_3> converted;
  converted.reserve(points.size());
  for (const Point& p : points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return Error{ErrorCode::invalid_argument,
                   "a point of a Delaunay tetrahedralization is not finite"};
    }
    converted.emplace_back(p.x, p.y, p.z);
  }
  state_->vertices.resize(first + points.size());
  state_->is_changed.resize(first + points.size(), true);
  Cancellation cancellation(is_cancelled);
  Delaunay::Vertex_handle hint;
  std::vector<Delaunay::Vertex_handle> neighbours;
  for (const std::size_t i : insertion_order(converted)) {
    // The number of new cells decides when to ask: in degenerate sets each point makes many.
    const std::size_t cells = delaunay.tds().number_of_cells();
    const std::size_t before = delaunay.number_of_vertices();
    hint = delaunay.insert(converted[i], hint);
    if (delaunay.number_of_vertices() == before) {
      return Error{ErrorCode::invalid_argument,
                   "two points of a Delaunay tetrahedralization are equal"};
    }
    hint->info() = static_cast<Index>(first + i);
    state_->vertices[first + i] = hint;
    // The count includes infinite cells: at most about as many as finite cells and 2 n.
    if (delaunay.tds().number_of_cells() / 2 > max_tetrahedra) {
      return too_many_tetrahedra(max_tetrahedra);
    }
    if (first > 0 && delaunay.dimension() == 3) {
      neighbours.clear();
      delaunay.finite_adjacent_vertices(hint, std::back_inserter(neighbours));
      for (const auto& vertex : neighbours) state_->is_changed[vertex->info()] = true;
    }
    const std::size_t cells_now = delaunay.tds().number_of_cells();
    if (cancellation.is_due_and_wanted(cells_now > cells ? 1 + cells_now - cells : 1)) {
      return Error{ErrorCode::cancelled, "cancelled by the caller"};
    }
  }
  if (delaunay.dimension() == 3 && delaunay.number_of_finite_cells() > max_tetrahedra) {
    return too_many_tetrahedra(max_tetrahedra);
  }
  return Done{};
}

bool GrowingDelaunay::has_edge(Index a, Index b) const {
  Delaunay::Cell_handle cell;
  int i = 0;
  int j = 0;
  return state_->delaunay.is_edge(state_->vertices[a], state_->vertices[b], cell, i, j);
}

std::vector<bool> GrowingDelaunay::changed() {
  return std::exchange(state_->is_changed, std::vector<bool>(state_->vertices.size(), false));
}

CanonicalDelaunay GrowingDelaunay::listed() const { return list(state_->delaunay); }

Result<CanonicalDelaunay> cgal_delaunay(std::span<const Point> points, std::uint64_t max_tetrahedra,
                                        const CancelPoll& is_cancelled) {
  GrowingDelaunay delaunay;
  if (Status inserted = delaunay.insert(points, max_tetrahedra, is_cancelled); !inserted) {
    return std::move(inserted).error();
  }
  return delaunay.listed();
}

}  // namespace watertight::delaunay
