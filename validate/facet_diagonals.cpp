// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/facet_diagonals.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "delaunay/canonical/sort_by_vertices.h"
#include "geometry/predicates/predicates.h"
#include "tessellate/flatness.h"

namespace watertight::validate {
namespace {

/// An edge of one triangle.
struct Side {
  Triangle key{};  // the smaller vertex, the larger vertex, the facet
  Index triangle = 0;
  bool is_same_segment(const Side& other) const {
    return key[0] == other.key[0] && key[1] == other.key[1];
  }
};

/// Appends the pairs of triangles at one segment of a shell. The first facet of which the segment
/// is a diagonal (a side of two of its triangles) is paired with every other facet at the segment.
/// Requires the sides of one shell at one segment, sorted by facet.
void append_pairs(std::span<const Side> sides, std::vector<geometry::IntersectingPair>& pairs) {
  const auto diagonal = std::adjacent_find(
      sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key == b.key; });
  if (diagonal == sides.end()) return;
  for (const Side& other : sides) {
    if (other.key == diagonal->key) continue;
    for (const Index own : {diagonal->triangle, std::next(diagonal)->triangle}) {
      pairs.push_back({std::min(own, other.triangle), std::max(own, other.triangle),
                       geometry::ContactClass::edge_overlap});
    }
  }
}

bool have_same_ends(const FacetEdge& a, const FacetEdge& b) {
  return a.low == b.low && a.high == b.high;
}

}  // namespace

std::vector<FacetEdge> facet_edges(const tessellate::FacetTriangles& facets, Index facet) {
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

std::vector<geometry::IntersectingPair> diagonal_contacts(
    const Solid& solid, const tessellate::FacetTriangles& facets) {
  std::vector<geometry::IntersectingPair> pairs;
  const auto& facet_of = facets.facet_of;
  if (std::adjacent_find(facet_of.begin(), facet_of.end()) == facet_of.end()) return pairs;
  std::vector<Side> sides;
  sides.reserve(3 * facets.triangles.size());
  for (Index t = 0; t < facets.triangles.size(); ++t) {
    const auto& [a, b, c] = facets.triangles[t];
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      sides.push_back({{std::min(from, to), std::max(from, to), facet_of[t]}, t});
    }
  }
  delaunay::sort_by_vertices(sides, solid.vertex_count(),
                             [](const Side& side) { return side.key; });
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].is_same_segment(sides[begin])) ++end;
    // Facets are numbered shell by shell.
    while (end - begin > 2) {
      const Index last = solid.facets_of(solid.shell_of(sides[begin].key[2])).end;
      std::size_t next = begin;
      while (next < end && sides[next].key[2] < last) ++next;
      append_pairs(std::span(sides).subspan(begin, next - begin), pairs);
      begin = next;
    }
    begin = end;
  }
  return pairs;
}

std::vector<Diagonal> other_diagonals(const Solid& solid, const tessellate::FacetTriangles& facets,
                                      Index facet) {
  const auto at = [&](Index vertex) -> const Point& { return solid.vertices()[vertex]; };
  const auto corner = [&](Index triangle, Index low, Index high) {
    const Triangle& t = facets.triangles[triangle];
    std::size_t k = 0;
    while (t[k] == low || t[k] == high) ++k;
    return k;
  };
  const int axis = tessellate::facet_projection(solid, facet).axis;
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
    const int turn = geometry::orient2d(at(d.left), at(d.right), at(d.u), axis);
    if (turn == 0 || geometry::orient2d(at(d.left), at(d.right), at(d.v), axis) != -turn) continue;
    if (tessellate::are_coplanar(at(d.u), at(d.v), at(d.left), at(d.right))) continue;
    result.push_back(d);
  }
  return result;
}

}  // namespace watertight::validate
