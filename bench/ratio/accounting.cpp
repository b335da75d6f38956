// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/ratio/accounting.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "delaunay/canonical/follow_delaunay.h"
#include "delaunay/canonical_delaunay.h"
#include "tessellate/facets.h"

namespace watertight {
namespace {

Triangle sorted(Triangle triangle) {
  std::sort(triangle.begin(), triangle.end());
  return triangle;
}

/// The border of the faces of one facet: for each vertex, its neighbours along edges that only one
/// face uses.
using Border = std::map<Index, std::vector<Index>>;

std::vector<Border> facet_borders(const delaunay::Tetrahedralization& cdt, Index facet_count) {
  std::vector<std::map<std::pair<Index, Index>, int>> uses(facet_count);
  for (const delaunay::ConstrainedFace& face : cdt.constrained) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(face.vertices[static_cast<std::size_t>(i)],
                                           face.vertices[static_cast<std::size_t>((i + 1) % 3)]);
      ++uses[face.facet][{low, high}];
    }
  }
  std::vector<Border> borders(facet_count);
  for (Index facet = 0; facet < facet_count; ++facet) {
    for (const auto& [edge, count] : uses[facet]) {
      if (count != 1) continue;
      borders[facet][edge.first].push_back(edge.second);
      borders[facet][edge.second].push_back(edge.first);
    }
  }
  return borders;
}

/// The Steiner points on the border of a facet between two neighbours in a ring.
std::vector<Index> chain_between(const Border& border, Index input_count, Index from, Index to) {
  const auto start = border.find(from);
  if (start == border.end()) return {};
  for (const Index first : start->second) {
    std::vector<Index> chain;
    Index previous = from;
    Index current = first;
    while (current >= input_count && chain.size() < border.size()) {
      chain.push_back(current);
      const auto& next = border.at(current);
      if (next.size() != 2) break;
      const Index following = next[0] == previous ? next[1] : next[0];
      previous = current;
      current = following;
    }
    if (current == to) return chain;
  }
  return {};
}

std::set<Index> choose_points(const std::set<Index>& on_edges,
                              const delaunay::Tetrahedralization& cdt, double density) {
  std::vector<Index> points(on_edges.begin(), on_edges.end());
  std::sort(points.begin(), points.end(),
            [&](Index a, Index b) { return cdt.points[a] < cdt.points[b]; });
  std::set<Index> chosen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto step = static_cast<double>(i);
    if (std::floor((step + 1) * density) > std::floor(step * density)) chosen.insert(points[i]);
  }
  return chosen;
}

}  // namespace

Accounting& Accounting::operator+=(const Accounting& other) {
  solids += other.solids;
  steiner += other.steiner;
  triangles += other.triangles;
  delaunay_faces += other.delaunay_faces;
  unrecovered += other.unrecovered;
  return *this;
}

std::optional<Accounting> account_following(const Solid& solid) {
  const auto delaunay = delaunay::canonical_delaunay(solid.vertices());
  if (!delaunay || delaunay->tetrahedra.empty()) return std::nullopt;
  const delaunay::FollowingTriangles following =
      delaunay::follow_delaunay(solid, tessellate::triangulate_facets(solid), *delaunay);
  return Accounting{1, 0, following.triangles.size(), delaunay->faces.size(),
                    following.missing_total};
}

std::optional<Accounting> account_certificate(const delaunay::Certificate& certificate) {
  const delaunay::Tetrahedralization& cdt = certificate.tetrahedralization;
  const auto delaunay = delaunay::canonical_delaunay(cdt.points);
  if (!delaunay || delaunay->tetrahedra.empty()) return std::nullopt;
  Accounting accounting{1, cdt.points.size() - cdt.input_count, cdt.constrained.size(),
                        delaunay->faces.size(), 0};
  for (const delaunay::ConstrainedFace& face : cdt.constrained) {
    accounting.unrecovered +=
        std::binary_search(delaunay->faces.begin(), delaunay->faces.end(), sorted(face.vertices))
            ? 0U
            : 1U;
  }
  return accounting;
}

std::optional<Accounting> account_refined(const Solid& solid,
                                          const delaunay::Certificate& certificate,
                                          double density) {
  const delaunay::Tetrahedralization& cdt = certificate.tetrahedralization;
  const std::vector<Border> borders = facet_borders(cdt, solid.facet_count());
  const auto each_edge = [&](const auto& visit) {
    for (Index facet = 0; facet < solid.facet_count(); ++facet) {
      for (Index ring = solid.rings_of(facet).begin; ring < solid.rings_of(facet).end; ++ring) {
        const auto vertices = solid.ring(ring);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
          const Index to = vertices[(i + 1) % vertices.size()];
          visit(vertices[i], chain_between(borders[facet], cdt.input_count, vertices[i], to));
        }
        visit(kNone, {});
      }
      visit(kNone - 1, {});
    }
  };
  std::set<Index> on_edges;
  each_edge(
      [&](Index, const std::vector<Index>& chain) { on_edges.insert(chain.begin(), chain.end()); });
  const std::set<Index> chosen = choose_points(on_edges, cdt, density);

  SolidArrays arrays;
  arrays.vertices.assign(solid.vertices().begin(), solid.vertices().end());
  std::map<Index, Index> refined_index;
  for (const Index point : chosen) {
    refined_index[point] = static_cast<Index>(arrays.vertices.size());
    arrays.vertices.push_back(cdt.points[point]);
  }
  Index facet = 0;
  Index shell = 0;
  each_edge([&](Index vertex, const std::vector<Index>& chain) {
    if (vertex == kNone) {
      arrays.end_ring();
    } else if (vertex == kNone - 1) {
      arrays.end_facet();
      if (++facet == solid.facets_of(shell).end) {
        arrays.end_shell();
        ++shell;
      }
    } else {
      arrays.ring_vertices.push_back(vertex);
      for (const Index point : chain) {
        if (chosen.count(point) != 0) arrays.ring_vertices.push_back(refined_index[point]);
      }
    }
  });
  const auto refined = Solid::make(std::move(arrays), solid.lattice(), solid.srid());
  if (!refined) return std::nullopt;
  auto accounting = account_following(*refined);
  if (accounting) accounting->steiner = chosen.size();
  return accounting;
}

}  // namespace watertight
