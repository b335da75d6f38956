// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/facet_diagonals.h"

#include <algorithm>
#include <tuple>

#include "delaunay/sort_by_vertices.h"
#include "geometry/predicates.h"
#include "tessellate/flatness.h"

namespace watertight {
namespace {

bool have_same_ends(const FacetEdge& a, const FacetEdge& b) {
  return a.low == b.low && a.high == b.high;
}

/// The edges of all facets' triangles whose ends are ends of diagonals, grouped by segment and, as
/// facets are numbered shell by shell, by shell.
std::vector<FacetEdge> edges_at_diagonals(const Solid& solid, const FacetTriangles& facets) {
  std::vector<bool> is_end(solid.vertex_count(), false);
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    if (facets.first[facet + 1] - facets.first[facet] < 2) continue;
    for (const FacetEdge& edge : facet_edges(facets, facet)) {
      if (edge.is_diagonal()) is_end[edge.low] = is_end[edge.high] = true;
    }
  }
  std::vector<FacetEdge> edges;
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    for (const FacetEdge& edge : facet_edges(facets, facet)) {
      if (is_end[edge.low] && is_end[edge.high]) edges.push_back(edge);
    }
  }
  sort_by_vertices(edges, solid.vertex_count(), [](const FacetEdge& edge) {
    return Triangle{edge.low, edge.high, edge.facet};
  });
  return edges;
}

/// Pairs every other facet at the segment with the first that has it as a diagonal.
void append_pairs(std::span<const FacetEdge> at_segment, std::vector<IntersectingPair>& pairs) {
  const auto diagonal = std::find_if(at_segment.begin(), at_segment.end(),
                                     [](const FacetEdge& edge) { return edge.is_diagonal(); });
  if (diagonal == at_segment.end()) return;
  for (const FacetEdge& other : at_segment) {
    if (other.facet == diagonal->facet) continue;
    for (const Index a : diagonal->triangles) {
      for (const Index b : other.triangles) {
        if (b == kNone) continue;
        pairs.push_back({std::min(a, b), std::max(a, b), ContactClass::edge_overlap});
      }
    }
  }
}

}  // namespace

std::vector<FacetEdge> facet_edges(const FacetTriangles& facets, Index facet) {
  std::vector<FacetEdge> sides;
  for (Index t = facets.first[facet]; t < facets.first[facet + 1]; ++t) {
    const Triangle& corners = facets.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % 3]);
      sides.push_back({low, high, facet, {t, kNone}});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const FacetEdge& a, const FacetEdge& b) {
    return std::tie(a.low, a.high, a.triangles) < std::tie(b.low, b.high, b.triangles);
  });
  std::vector<FacetEdge> edges;
  for (const FacetEdge& side : sides) {
    if (!edges.empty() && have_same_ends(edges.back(), side)) {
      edges.back().triangles[1] = side.triangles[0];
    } else {
      edges.push_back(side);
    }
  }
  return edges;
}

std::vector<IntersectingPair> diagonal_contacts(const Solid& solid, const FacetTriangles& facets) {
  std::vector<IntersectingPair> pairs;
  const auto& facet_of = facets.facet_of;
  if (std::adjacent_find(facet_of.begin(), facet_of.end()) == facet_of.end()) return pairs;
  const std::vector<FacetEdge> edges = edges_at_diagonals(solid, facets);
  for (std::size_t begin = 0; begin < edges.size();) {
    const Index shell_end = solid.facets_of(solid.shell_of(edges[begin].facet)).end;
    std::size_t end = begin + 1;
    while (end < edges.size() && have_same_ends(edges[begin], edges[end]) &&
           edges[end].facet < shell_end) {
      ++end;
    }
    append_pairs(std::span(edges).subspan(begin, end - begin), pairs);
    begin = end;
  }
  return pairs;
}

std::vector<Diagonal> other_diagonals(const Solid& solid, const FacetTriangles& facets,
                                      Index facet) {
  const auto at = [&](Index vertex) -> const Point& { return solid.vertices()[vertex]; };
  const auto corner = [&](Index triangle, Index low, Index high) {
    const Triangle& t = facets.triangles[triangle];
    std::size_t k = 0;
    while (t[k] == low || t[k] == high) ++k;
    return k;
  };
  const int axis = facet_projection(solid, facet).axis;
  std::vector<Diagonal> result;
  for (const FacetEdge& edge : facet_edges(facets, facet)) {
    if (!edge.is_diagonal()) continue;
    const auto [first, second] = edge.triangles;
    const Triangle& t = facets.triangles[first];
    const std::size_t apex = corner(first, edge.low, edge.high);
    const Diagonal d{t[(apex + 1) % 3],
                     t[(apex + 2) % 3],
                     t[apex],
                     facets.triangles[second][corner(second, edge.low, edge.high)],
                     first,
                     second};
    const int turn = orient2d(at(d.left), at(d.right), at(d.u), axis);
    if (turn == 0 || orient2d(at(d.left), at(d.right), at(d.v), axis) != -turn) continue;
    if (are_coplanar(at(d.u), at(d.v), at(d.left), at(d.right))) continue;
    result.push_back(d);
  }
  return result;
}

}  // namespace watertight
