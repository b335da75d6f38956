// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_polygon/surface.h"

#include <algorithm>
#include <utility>

namespace watertight::codec::polygon {
namespace {

struct PairedEdge {
  Index shell = 0;
  Index low = 0;
  Index high = 0;
  bool is_forward = false;
  Index half = 0;
  friend auto operator<=>(const PairedEdge&, const PairedEdge&) = default;
};

/// Half-edges between the same vertices of a shell: those of one direction, then of the other.
std::vector<PairedEdge> sorted_edges(const PolygonSurface& surface,
                                     const std::vector<Index>& vertices) {
  std::vector<PairedEdge> edges;
  edges.reserve(vertices.size());
  for (Index shell = 0; shell + 1 < surface.shell_offsets.size(); ++shell) {
    const Index first = surface.ring_offsets[surface.facet_offsets[surface.shell_offsets[shell]]];
    const Index last =
        surface.ring_offsets[surface.facet_offsets[surface.shell_offsets[shell + 1]]];
    for (Index half = first; half < last; ++half) {
      const Index from = vertices[half];
      const Index to = vertices[surface.next(half)];
      edges.push_back({shell, std::min(from, to), std::max(from, to), from < to, half});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

bool pair_twins(PolygonSurface& surface, const std::vector<Index>& vertices) {
  const std::vector<PairedEdge> edges = sorted_edges(surface, vertices);
  surface.twin.assign(vertices.size(), kNone);
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t middle = begin;
    std::size_t end = begin;
    for (; end < edges.size() && edges[end].shell == edges[begin].shell &&
           edges[end].low == edges[begin].low && edges[end].high == edges[begin].high;
         ++end) {
      middle += edges[end].is_forward ? 0U : 1U;
    }
    if (2 * (middle - begin) != end - begin) return false;
    for (std::size_t i = begin; i < middle; ++i) {
      const Index one = edges[i].half;
      const Index other = edges[i - begin + middle].half;
      surface.twin[one] = other;
      surface.twin[other] = one;
    }
    begin = end;
  }
  return true;
}

/// Numbers the fans: around its vertex, a half-edge is followed by the twin of its predecessor.
void number_fans(SurfaceTruth& truth, const std::vector<Index>& vertices) {
  PolygonSurface& surface = truth.surface;
  surface.vertex.assign(vertices.size(), kNone);
  for (Index start = 0; start < vertices.size(); ++start) {
    if (surface.vertex[start] != kNone) continue;
    const auto fan = static_cast<Index>(truth.vertex_of.size());
    Index degree = 0;
    for (Index half = start; surface.vertex[half] == kNone;
         half = surface.twin[surface.previous(half)]) {
      surface.vertex[half] = fan;
      ++degree;
    }
    truth.vertex_of.push_back(vertices[start]);
    surface.degree.push_back(degree);
    surface.out_half.push_back(start);
  }
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

/// Where the walk begins in its first facet: in the column of an earlier solid that is
/// nearest to the last position, else at its smallest vertex.
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
  if (!pair_twins(surface, solid.ring_vertices)) {
    return Error{ErrorCode::not_encodable,
                 "the ring edges of a shell are not matched by those of the same shell"};
  }
  number_fans(truth, solid.ring_vertices);
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    truth.first_half.push_back(first_half(solid, first_facet(solid, shell), memory));
  }
  return truth;
}

}  // namespace watertight::codec::polygon
