// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/valid_solid.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "geometry/divided_rings.h"

namespace watertight::geometry {
namespace {

Error not_encodable(std::string message) { return {ErrorCode::not_encodable, std::move(message)}; }

/// A directed edge of a ring. Its name is the same in both directions.
struct DirectedEdge {
  std::uint64_t name;  // the smaller vertex in the high 32 bits, the larger vertex in the low ones
  Index position;      // the index of the edge among all edges of the rings
  bool is_forward;     // true if the edge runs from the smaller to the larger vertex
};

std::uint64_t edge_name(Index a, Index b) {
  return (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
}

Status check_structure(const Solid& solid) {
  if (solid.facet_count() == 0) return not_encodable("the solid has no facets");
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    if (solid.facets_of(shell).size() == 0) {
      return not_encodable("shell " + std::to_string(shell) + " has no facets");
    }
  }
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    if (solid.rings_of(facet).size() == 0) {
      return not_encodable("facet " + std::to_string(facet) + " has no rings");
    }
  }
  return Done{};
}

Status check_rings(const Solid& solid) {
  std::vector<Index> last_ring(solid.vertex_count(), kNone);
  for (Index ring = 0; ring < solid.ring_count(); ++ring) {
    if (solid.ring(ring).size() < 3) {
      return not_encodable("ring " + std::to_string(ring) + " has fewer than 3 vertices");
    }
    for (const Index vertex : solid.ring(ring)) {
      if (last_ring[vertex] == ring) {
        return not_encodable("ring " + std::to_string(ring) + " visits vertex " +
                             std::to_string(vertex) + " twice");
      }
      last_ring[vertex] = ring;
    }
  }
  return Done{};
}

Status check_distinct(std::span<const Point> vertices) {
  std::vector<Index> by_point(vertices.size());
  std::iota(by_point.begin(), by_point.end(), Index{0});
  std::sort(by_point.begin(), by_point.end(), [&](Index a, Index b) {
    const auto order = vertices[a] <=> vertices[b];
    return order != 0 ? order < 0 : a < b;
  });
  const auto twin = std::adjacent_find(by_point.begin(), by_point.end(), [&](Index a, Index b) {
    return vertices[a] == vertices[b];
  });
  if (twin == by_point.end()) return Done{};
  return not_encodable("vertices " + std::to_string(*twin) + " and " + std::to_string(*(twin + 1)) +
                       " are equal and have not been merged");
}

Status check_closed(const Solid& solid) {
  std::vector<DirectedEdge> edges;
  edges.reserve(solid.arrays().ring_vertices.size());
  for (Index ring = 0; ring < solid.ring_count(); ++ring) {
    const auto vertices = solid.ring(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Index from = vertices[i];
      const Index to = vertices[i + 1 == vertices.size() ? 0 : i + 1];
      edges.push_back({edge_name(from, to), static_cast<Index>(edges.size()), from < to});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
    return a.name != b.name ? a.name < b.name : a.position < b.position;
  });

  const DirectedEdge* first_unmatched = nullptr;
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin;
    std::int64_t balance = 0;
    for (; end < edges.size() && edges[end].name == edges[begin].name; ++end) {
      balance += edges[end].is_forward ? 1 : -1;
    }
    for (std::size_t i = begin; balance != 0 && i < end; ++i) {
      if (edges[i].is_forward != (balance > 0)) continue;
      if (!first_unmatched || edges[i].position < first_unmatched->position) {
        first_unmatched = &edges[i];
      }
      break;
    }
    begin = end;
  }
  if (!first_unmatched) return Done{};
  Index from = static_cast<Index>(first_unmatched->name >> 32U);
  Index to = static_cast<Index>(first_unmatched->name & 0xffffffffU);
  if (!first_unmatched->is_forward) std::swap(from, to);
  return not_encodable("the edge from vertex " + std::to_string(from) + " to vertex " +
                       std::to_string(to) + " is not matched by its reverse");
}

}  // namespace

Result<OrientedBoundary> OrientedBoundary::make(Solid solid) {
  if (auto status = check_structure(solid); !status) return status.error();
  if (auto status = check_rings(solid); !status) return status.error();
  if (auto status = check_distinct(solid.vertices()); !status) return status.error();
  if (auto status = check_closed(solid); !status) {
    const std::vector<RingTouch> touches = ring_touches(solid);
    if (touches.empty()) return status.error();
    if (auto again = check_closed(divide_rings(solid, touches).solid); !again) {
      return again.error();
    }
  }
  return OrientedBoundary(std::move(solid));
}

}  // namespace watertight::geometry
