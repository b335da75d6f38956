// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/edited_solid.h"

#include <algorithm>
#include <utility>

#include "geometry/crs/crs.h"
#include "geometry/vector3.h"

namespace watertight::repair {
namespace {

void append(SolidArrays& arrays, std::span<const EditedFacet> facets) {
  for (const EditedFacet& facet : facets) {
    for (const Ring& ring : facet.rings) {
      arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
      arrays.end_ring();
    }
    arrays.end_facet();
  }
  arrays.end_shell();
}

}  // namespace

EditedSolid edited(const Solid& solid) {
  const Solid merged = geometry::merge_equal_vertices(solid).solid;
  EditedSolid result;
  result.vertices.assign(merged.vertices().begin(), merged.vertices().end());
  result.lattice = merged.lattice();
  result.srid = merged.srid();
  for (Index shell = 0; shell < merged.shell_count(); ++shell) {
    std::vector<EditedFacet>& facets = result.shells.emplace_back();
    const IndexRange range = merged.facets_of(shell);
    for (Index facet = range.begin; facet < range.end; ++facet) {
      EditedFacet& one = facets.emplace_back();
      one.source = facet;
      const IndexRange rings = merged.rings_of(facet);
      for (Index ring = rings.begin; ring < rings.end; ++ring) {
        one.rings.emplace_back(merged.ring(ring).begin(), merged.ring(ring).end());
      }
    }
  }
  return result;
}

Result<Solid> solid_of(const EditedSolid& edited) {
  SolidArrays arrays;
  arrays.vertices = edited.vertices;
  for (const auto& facets : edited.shells) append(arrays, facets);
  return Solid::make(std::move(arrays), edited.lattice, edited.srid);
}

Result<Solid> solid_of(const EditedSolid& edited, std::span<const EditedFacet> facets) {
  SolidArrays arrays;
  arrays.vertices = edited.vertices;
  append(arrays, facets);
  return Solid::make(std::move(arrays), edited.lattice, edited.srid);
}

Result<FacetAlone> alone(const EditedSolid& edited, const EditedFacet& facet) {
  std::vector<Index> vertices;
  for (const Ring& ring : facet.rings) vertices.insert(vertices.end(), ring.begin(), ring.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  EditedFacet renumbered = facet;
  for (Ring& ring : renumbered.rings) {
    for (Index& vertex : ring) {
      const auto place = std::lower_bound(vertices.begin(), vertices.end(), vertex);
      vertex = static_cast<Index>(place - vertices.begin());
    }
  }
  SolidArrays arrays;
  for (const Index vertex : vertices) arrays.vertices.push_back(edited.vertices[vertex]);
  append(arrays, {&renumbered, 1});
  auto solid = Solid::make(std::move(arrays), edited.lattice, edited.srid);
  if (!solid) return std::move(solid).error();
  return FacetAlone{*std::move(solid), std::move(vertices)};
}

void turn_over(EditedFacet& facet) {
  for (Ring& ring : facet.rings) std::reverse(ring.begin(), ring.end());
}

std::array<double, 3> metres_per_unit(const EditedSolid& edited) {
  const Box box = box_of(edited.vertices);
  std::array<double, 3> centre{};
  if (!box.is_empty()) {
    const auto low = edited.lattice.world(box.min);
    const auto high = edited.lattice.world(box.max);
    for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = (low[axis] + high[axis]) / 2;
  }
  return geometry::axis_units(edited.srid, centre).metres_per_unit;
}

std::array<double, 3> metres_of(const EditedSolid& edited, Index vertex,
                                const std::array<double, 3>& metres_per_unit) {
  const auto place = edited.lattice.world(edited.vertices[vertex]);
  const auto origin = edited.lattice.world(edited.vertices.front());
  return {(place[0] - origin[0]) * metres_per_unit[0], (place[1] - origin[1]) * metres_per_unit[1],
          (place[2] - origin[2]) * metres_per_unit[2]};
}

std::array<double, 3> area_vector(const EditedSolid& edited, const Ring& ring,
                                  const std::array<double, 3>& metres_per_unit) {
  using namespace geometry;
  Vector3 area{};
  const Vector3 first = metres_of(edited, ring[0], metres_per_unit);
  for (std::size_t i = 2; i < ring.size(); ++i) {
    area = area + cross(metres_of(edited, ring[i - 1], metres_per_unit) - first,
                        metres_of(edited, ring[i], metres_per_unit) - first);
  }
  return area;
}

}  // namespace watertight::repair
