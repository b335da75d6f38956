// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/without_holes.h"

#include <span>
#include <string>
#include <utility>

#include "tessellate/facets.h"

namespace watertight::tessellate {
namespace {

void append_ring(SolidArrays& arrays, std::span<const Index> ring) {
  arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
  arrays.end_ring();
}

}  // namespace

Result<Solid> without_holes(const Solid& source) {
  const Solid solid = geometry::merge_equal_vertices(source).solid;
  const FacetTriangles triangles = triangulate_facets(solid);
  SolidArrays arrays;
  arrays.vertices.assign(solid.vertices().begin(), solid.vertices().end());
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const IndexRange facets = solid.facets_of(shell);
    for (Index facet = facets.begin; facet < facets.end; ++facet) {
      const IndexRange rings = solid.rings_of(facet);
      if (rings.size() <= 1) {
        for (Index ring = rings.begin; ring < rings.end; ++ring) {
          append_ring(arrays, solid.ring(ring));
        }
        arrays.end_facet();
        continue;
      }
      if (triangles.state[facet] != FacetState::triangulated) {
        return Error{ErrorCode::not_encodable,
                     "facet " + std::to_string(facet) +
                         " has holes that cannot be triangulated (its rings are not simple)"};
      }
      for (Index i = triangles.first[facet]; i < triangles.first[facet + 1]; ++i) {
        append_ring(arrays, triangles.triangles[i]);
        arrays.end_facet();
      }
    }
    arrays.end_shell();
  }
  return Solid::make(std::move(arrays), solid.lattice(), solid.srid());
}

}  // namespace watertight::tessellate
