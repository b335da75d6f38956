// SPDX-License-Identifier: GPL-3.0-or-later
//
// Steps: the edges between two facets of one plane are found; facets that such edges connect form a
// group; the other edges of a group are followed around it, which gives the rings of the merged
// facet; the ring that turns as the triangles do is the exterior one.
#include "delaunay/constrained/merge_facets.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "geometry/disjoint_sets.h"
#include "geometry/mesh/edge_sides.h"
#include "geometry/mesh/facet_rings.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/predicates/predicates.h"
#include "tessellate/flatness.h"

namespace watertight::delaunay {
namespace {

class FacetMerger {
 public:
  FacetMerger(const Solid& solid, const tessellate::FacetTriangles& canonical)
      : solid_(solid), canonical_(canonical), groups_(solid.facet_count()) {}

  std::optional<MergedFacets> run() {
    if (!connect()) return std::nullopt;
    collect_rings();
    SolidArrays arrays;
    arrays.vertices.assign(solid_.vertices().begin(), solid_.vertices().end());
    std::vector<Index> source;
    for (Index shell = 0; shell < solid_.shell_count(); ++shell) {
      const IndexRange facets = solid_.facets_of(shell);
      for (Index facet = facets.begin; facet < facets.end; ++facet) {
        if (groups_.root(facet) != facet) continue;
        if (!add_facet(facet, arrays)) return std::nullopt;
        source.push_back(facet);
      }
      arrays.end_shell();
    }
    Result<Solid> merged = Solid::make(std::move(arrays), solid_.lattice(), solid_.srid());
    if (!merged) return std::nullopt;
    return MergedFacets{geometry::merge_equal_vertices(*merged).solid, std::move(source)};
  }

 private:
  /// Finds the edges inside of groups. False if there are none between two facets.
  bool connect() {
    std::vector<bool> is_flat(solid_.facet_count());
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      is_flat[facet] = tessellate::is_flat(solid_, facet);
    }
    const auto count = static_cast<Index>(canonical_.triangles.size());
    const std::vector<geometry::EdgeSide> sides =
        geometry::sides_of_triangles(canonical_.triangles, 0, count);
    inner_twin_.assign(3 * std::size_t{count}, kNone);
    bool has_found = false;
    geometry::for_each_edge(std::span(sides), [&](std::span<const geometry::EdgeSide> edge) {
      if (edge.size() != 2 || edge[0].is_downward == edge[1].is_downward) return;
      const Index first = edge[0].half_edge;
      const Index second = edge[1].half_edge;
      const Index one = canonical_.facet_of[first / 3];
      const Index other = canonical_.facet_of[second / 3];
      if (one != other && !(is_flat[one] && is_flat[other] && is_in_one_plane(first, second))) {
        return;
      }
      has_found = has_found || one != other;
      groups_.join(one, other);
      inner_twin_[first] = second;
      inner_twin_[second] = first;
    });
    return has_found;
  }

  bool is_in_one_plane(Index half_edge, Index other) const {
    const auto at = [&](Index vertex) -> const Point& { return solid_.vertices()[vertex]; };
    const auto& [a, b, c] = canonical_.triangles[half_edge / 3];
    return solid_.shell_of(canonical_.facet_of[half_edge / 3]) ==
               solid_.shell_of(canonical_.facet_of[other / 3]) &&
           tessellate::are_coplanar(at(a), at(b), at(c),
                                    at(geometry::corner_of(canonical_.triangles, other)));
  }

  void collect_rings() {
    rings_of_.resize(solid_.facet_count());
    for (geometry::FacetRing& ring : geometry::facet_rings(canonical_.triangles, inner_twin_)) {
      rings_of_[groups_.root(canonical_.facet_of[ring.triangle])].push_back(std::move(ring));
    }
  }

  /// Adds the facet of a group. False unless exactly one of its rings is an exterior one.
  bool add_facet(Index group, SolidArrays& arrays) {
    std::vector<geometry::FacetRing>& rings = rings_of_[group];
    const auto interior =
        std::stable_partition(rings.begin(), rings.end(), [&](const geometry::FacetRing& ring) {
          return turns_as_triangle(ring.vertices, canonical_.triangles[ring.triangle]);
        });
    if (interior - rings.begin() != 1) return false;
    for (const geometry::FacetRing& ring : rings) {
      arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.vertices.begin(),
                                  ring.vertices.end());
      arrays.end_ring();
    }
    arrays.end_facet();
    return true;
  }

  /// The turn of a ring is that at its extreme vertex in a projection in which the triangle has an
  /// area. A ring that runs there in a straight line is none of a simple polygon.
  bool turns_as_triangle(const std::vector<Index>& ring, const Triangle& triangle) const {
    const auto at = [&](Index vertex) -> const Point& { return solid_.vertices()[vertex]; };
    int axis = 0;
    while (axis < 2 &&
           geometry::orient2d(at(triangle[0]), at(triangle[1]), at(triangle[2]), axis) == 0) {
      ++axis;
    }
    const auto projected = [&](Index vertex) {
      return std::array{at(vertex)[(axis + 1) % 3], at(vertex)[(axis + 2) % 3]};
    };
    const std::size_t extreme =
        static_cast<std::size_t>(std::ranges::min_element(ring, {}, projected) - ring.begin());
    const Index before = ring[(extreme + ring.size() - 1) % ring.size()];
    const Index after = ring[(extreme + 1) % ring.size()];
    const int turn = geometry::orient2d(at(before), at(ring[extreme]), at(after), axis);
    return turn != 0 &&
           turn == geometry::orient2d(at(triangle[0]), at(triangle[1]), at(triangle[2]), axis);
  }

  const Solid& solid_;
  const tessellate::FacetTriangles& canonical_;
  geometry::DisjointSets groups_;  // of facets
  std::vector<Index>
      inner_twin_;  // half-edge of a triangle -> its twin in the same group, or kNone
  std::vector<std::vector<geometry::FacetRing>>
      rings_of_;  // facet that stands for a group -> rings
};

}  // namespace

std::optional<MergedFacets> merge_flat_facets(const Solid& solid,
                                              const tessellate::FacetTriangles& canonical) {
  return FacetMerger(solid, canonical).run();
}

}  // namespace watertight::delaunay
