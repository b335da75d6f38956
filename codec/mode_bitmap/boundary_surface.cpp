// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: Verbree & Si 2008, section 4.1, composition steps 5 and 7.
// Departures: the paper composes triangles; here the facets' polygons come back, by one flag per
// edge, and Steiner vertices leave the rings.
#include "codec/mode_bitmap/boundary_surface.h"

#include <algorithm>
#include <utility>

#include "geometry/mesh/edge_sides.h"
#include "geometry/mesh/facet_rings.h"
#include "geometry/mesh/half_edges.h"

namespace watertight::codec::bitmap {
namespace {

Index other_of(const Joint& joint, Index triangle) {
  return joint.triangles[0] == triangle ? joint.triangles[1] : joint.triangles[0];
}

/// True if the triangle, in its own direction, has the edge from -> to.
bool runs_forward(const Triangle& t, Index from, Index to) {
  return (t[0] == from && t[1] == to) || (t[1] == from && t[2] == to) ||
         (t[2] == from && t[0] == to);
}

}  // namespace

BoundarySurface::BoundarySurface(std::span<const Triangle> triangles, Index vertex_count)
    : triangles_(triangles.begin(), triangles.end()), vertex_count_(vertex_count) {
  find_joints();
  find_components();
}

void BoundarySurface::find_joints() {
  const auto count = static_cast<Index>(triangles_.size());
  const std::vector<geometry::EdgeSide> sides = geometry::sides_of_triangles(triangles_, 0, count);
  joints_of_.assign(count, {});
  geometry::for_each_edge(
      std::span<const geometry::EdgeSide>(sides), [&](std::span<const geometry::EdgeSide> edge) {
        if (edge.size() != 2) return;
        const Index first = std::min(edge[0].half_edge, edge[1].half_edge);
        const Index second = std::max(edge[0].half_edge, edge[1].half_edge);
        const auto joint = static_cast<Index>(joints_.size());
        joints_.push_back(
            {edge[0].low,
             edge[0].high,
             {first / 3, second / 3},
             {geometry::corner_of(triangles_, first), geometry::corner_of(triangles_, second)}});
        joints_of_[first / 3].push_back(joint);
        joints_of_[second / 3].push_back(joint);
      });
}

void BoundarySurface::find_components() {
  geometry::DisjointSets components(triangles_.size());
  for (const Joint& joint : joints_) components.join(joint.triangles[0], joint.triangles[1]);
  components_ = components.numbered();
}

void BoundarySurface::set_interior(std::vector<bool> is_interior) {
  is_interior_ = std::move(is_interior);
  geometry::DisjointSets facets(triangles_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (is_interior_[i]) facets.join(joints_[i].triangles[0], joints_[i].triangles[1]);
  }
  facets_ = facets.numbered();
}

Status BoundarySurface::orient(const std::vector<bool>& is_flipped) {
  turned_ = triangles_;
  std::vector<bool> is_turned(triangles_.size(), false);
  std::vector<Index> stack;
  for (Index component = 0; component < component_count(); ++component) {
    const Index first = components_.first[component];
    if (is_flipped[component]) std::swap(turned_[first][1], turned_[first][2]);
    is_turned[first] = true;
    stack.push_back(first);
    while (!stack.empty()) {
      const Index triangle = stack.back();
      stack.pop_back();
      for (const Index index : joints_of_[triangle]) {
        const Joint& joint = joints_[index];
        const Index next = other_of(joint, triangle);
        const bool is_same = runs_forward(turned_[triangle], joint.from, joint.to) ==
                             runs_forward(turned_[next], joint.from, joint.to);
        if (is_turned[next]) {
          if (!is_same) continue;
          return Error{ErrorCode::malformed, "the marked faces form a surface without two sides"};
        }
        if (is_same) std::swap(turned_[next][1], turned_[next][2]);
        is_turned[next] = true;
        stack.push_back(next);
      }
    }
  }
  return Done{};
}

Index BoundarySurface::half_edge_of(Index triangle, Index corner_vertex) const {
  const Triangle& t = turned_[triangle];
  const Index corner = t[0] == corner_vertex ? 0 : t[1] == corner_vertex ? 1 : 2;
  return geometry::next_half_edge(triangle * 3 + corner);  // the half-edge opposite to the corner
}

std::vector<Index> BoundarySurface::interior_twins() const {
  std::vector<Index> twin(triangles_.size() * 3, kNone);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!is_interior_[i]) continue;
    const Joint& joint = joints_[i];
    const Index first = half_edge_of(joint.triangles[0], joint.corners[0]);
    const Index second = half_edge_of(joint.triangles[1], joint.corners[1]);
    twin[first] = second;
    twin[second] = first;
  }
  return twin;
}

std::vector<std::vector<VertexRing>> BoundarySurface::rings_of_facets() const {
  std::vector<std::vector<VertexRing>> rings(facet_count());
  for (geometry::FacetRing& ring : geometry::facet_rings(turned_, interior_twins())) {
    std::erase_if(ring.vertices, [&](Index vertex) { return vertex >= vertex_count_; });
    rings[facets_.set_of[ring.triangle]].push_back(std::move(ring.vertices));
  }
  for (auto& facet : rings) std::sort(facet.begin(), facet.end());
  return rings;
}

SolidArrays BoundarySurface::assemble(const std::vector<std::vector<VertexRing>>& rings,
                                      Index exterior_component,
                                      const std::vector<Index>& exterior_ring) const {
  std::vector<std::vector<Index>> facets_of(component_count());
  for (Index facet = 0; facet < facet_count(); ++facet) {
    facets_of[components_.set_of[facets_.first[facet]]].push_back(facet);
  }
  SolidArrays arrays;
  const auto add_ring = [&](const VertexRing& ring) {
    arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
    arrays.end_ring();
  };
  const auto add_shell = [&](Index component) {
    for (const Index facet : facets_of[component]) {
      const auto& all = rings[facet];
      if (!all.empty()) add_ring(all[exterior_ring[facet]]);
      for (Index i = 0; i < all.size(); ++i) {
        if (i != exterior_ring[facet]) add_ring(all[i]);
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  };
  if (component_count() > 0) add_shell(exterior_component);
  for (Index component = 0; component < component_count(); ++component) {
    if (component != exterior_component) add_shell(component);
  }
  return arrays;
}

}  // namespace watertight::codec::bitmap
