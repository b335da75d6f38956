// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes the polygons of a solid from the triangles of its boundary, given which edges lie inside
// facets and how the triangles turn: all other edges form the rings. This is the end of composition
// steps 5 and 7 of the paper. For the facet section of mode bitmap.
#pragma once

#include <span>
#include <vector>

#include "base/result.h"
#include "geometry/disjoint_sets.h"
#include "geometry/solid.h"

namespace watertight::codec::bitmap {

/// An edge at which exactly two triangles meet. An edge at which more meet (touching shells) is
/// none.
struct Joint {
  Index from = 0;  // the smaller vertex of the edge
  Index to = 0;
  Index triangles[2] = {0, 0};  // the two triangles, the smaller first
  Index corners[2] = {0, 0};    // the vertex of each triangle that is not on the edge
};

/// A ring of a facet, without Steiner vertices, smallest vertex first.
using VertexRing = std::vector<Index>;

class BoundarySurface {
 public:
  /// Requires strictly increasing triangles, each of three increasing vertices. Vertices from
  /// `vertex_count` on are Steiner vertices. Cost: O(n log n).
  BoundarySurface(std::span<const Triangle> triangles, Index vertex_count);

  /// All joints, sorted by (from, to).
  std::span<const Joint> joints() const { return joints_; }
  /// Components are connected through joints and numbered by their smallest triangle.
  Index component_count() const { return static_cast<Index>(components_.first.size()); }
  Index component_of(Index triangle) const { return components_.set_of[triangle]; }

  /// Notes which joints lie inside a facet. Facets are connected through these joints and numbered
  /// by their smallest triangle.
  void set_interior(std::vector<bool> is_interior);
  Index facet_count() const { return static_cast<Index>(facets_.first.size()); }
  Index first_triangle_of(Index facet) const { return facets_.first[facet]; }

  /// Orients every component by its smallest triangle, which turns as its sorted vertices do, or
  /// the other way round if `is_flipped` of the component is true. Errors: malformed if a component
  /// cannot be oriented.
  Status orient(const std::vector<bool>& is_flipped);

  /// The rings of each facet, sorted. Requires set_interior() and orient(). A walk along the edge
  /// of a facet that visits a vertex twice is split there, so that holes that touch come apart.
  /// Cost: O(n log n).
  std::vector<std::vector<VertexRing>> rings_of_facets() const;

  /// The arrays of the solid, without vertices. Each component is a shell, and `exterior_component`
  /// comes first; in each facet, the ring at index `exterior_ring[facet]` comes first.
  SolidArrays assemble(const std::vector<std::vector<VertexRing>>& rings, Index exterior_component,
                       const std::vector<Index>& exterior_ring) const;

 private:
  void find_joints();
  void find_components();
  Index half_edge_of(Index triangle, Index corner_vertex) const;
  std::vector<Index> interior_twins() const;

  std::vector<Triangle> triangles_;
  Index vertex_count_;
  std::vector<Joint> joints_;
  std::vector<std::vector<Index>> joints_of_;  // triangle -> at most three joints
  geometry::NumberedSets components_;          // sets of triangles
  std::vector<bool> is_interior_;              // joint -> whether it lies inside a facet
  geometry::NumberedSets facets_;              // sets of triangles
  std::vector<Triangle> turned_;
};

}  // namespace watertight::codec::bitmap
