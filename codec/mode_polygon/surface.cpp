// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_polygon/surface.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "geometry/mesh/edge_sides.h"
#include "geometry/mesh/fans.h"

namespace watertight::codec::polygon {
namespace {

/// The twin of each half-edge, in the same shell. Returns nothing if a shell is not closed.
std::optional<std::vector<Index>> twins_of(const IntegerSolid& solid) {
  std::vector<Index> twin;
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const Index first = solid.facet_offsets[solid.shell_offsets[shell]];
    const Index last = solid.facet_offsets[solid.shell_offsets[shell + 1]];
    const auto sides =
        geometry::sides_of_rings(solid.ring_vertices, solid.ring_offsets, first, last);
    const auto twins = geometry::paired(sides, solid.ring_offsets[first]);
    if (!twins) return std::nullopt;
    twin.insert(twin.end(), twins->begin(), twins->end());
  }
  return twin;
}

/// The facet at which the walk of a shell begins: the one whose highest vertex is lowest; of equals
/// the one with most vertices, then the first.
Index first_facet(const IntegerSolid& solid, Index shell) {
  Index best = solid.shell_offsets[shell];
  std::int64_t best_height = 0;
  Index best_size = 0;
  for (Index facet = best; facet < solid.shell_offsets[shell + 1]; ++facet) {
    const auto ring = solid.ring(solid.facet_offsets[facet]);
    std::int64_t highest = INT64_MIN;
    for (const Index vertex : ring) highest = std::max(highest, solid.vertices[vertex][2]);
    const auto size = static_cast<Index>(ring.size());
    if (facet != solid.shell_offsets[shell] &&
        (highest > best_height || (highest == best_height && size <= best_size))) {
      continue;
    }
    best = facet;
    best_height = highest;
    best_size = size;
  }
  return best;
}

/// The half-edge at which the walk begins in its first facet: at the vertex in a column of an
/// earlier solid that is nearest to the last position, else at the smallest vertex of the facet.
Index first_half(const IntegerSolid& solid, Index facet, const PageMemory& memory) {
  const Index ring = solid.facet_offsets[facet];
  Index best = solid.ring_offsets[ring];
  std::uint64_t best_distance = UINT64_MAX;
  for (Index half = best; half < solid.ring_offsets[ring + 1]; ++half) {
    const GridPoint& point = solid.vertices[solid.ring_vertices[half]];
    const std::array<std::int64_t, 2> column{point[0], point[1]};
    const bool is_known = std::binary_search(memory.columns.begin(), memory.columns.end(), column);
    std::uint64_t distance = 0;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::int64_t offset = column[axis] - memory.last_position[axis];
      distance += static_cast<std::uint64_t>(offset < 0 ? -offset : offset);
    }
    if (!is_known || distance >= best_distance) continue;
    best = half;
    best_distance = distance;
  }
  return best;
}

}  // namespace

Result<SurfaceTruth> surface_of(const IntegerSolid& solid, const PageMemory& memory) {
  SurfaceTruth truth;
  PolygonSurface& surface = truth.surface;
  surface.ring_offsets = solid.ring_offsets;
  surface.facet_offsets = solid.facet_offsets;
  surface.shell_offsets = solid.shell_offsets;
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    for (Index ring = solid.facet_offsets[facet]; ring < solid.facet_offsets[facet + 1]; ++ring) {
      surface.facet_of.push_back(facet);
      surface.ring_of.insert(surface.ring_of.end(), surface.ring_size(ring), ring);
    }
  }
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    if (solid.shell_offsets[shell] != solid.shell_offsets[shell + 1]) continue;
    return Error{ErrorCode::not_encodable, "a shell has no facets"};
  }
  auto twins = twins_of(solid);
  if (!twins) {
    return Error{ErrorCode::not_encodable,
                 "the ring edges of a shell are not matched by those of the same shell"};
  }
  surface.twin = std::move(*twins);
  geometry::Fans fans = geometry::number_fans(
      surface.twin, [&surface](Index half) { return surface.previous(half); });
  for (const Index half : fans.first) truth.vertex_of.push_back(solid.ring_vertices[half]);
  surface.vertex = std::move(fans.fan_of);
  surface.out_half = std::move(fans.first);
  surface.degree = std::move(fans.size);
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    truth.first_half.push_back(first_half(solid, first_facet(solid, shell), memory));
  }
  return truth;
}

}  // namespace watertight::codec::polygon
