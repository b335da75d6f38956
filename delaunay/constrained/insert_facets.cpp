// SPDX-License-Identifier: GPL-3.0-or-later
//
// Steps: the missing triangles of each facet become Delaunay in its plane, by exchanges of
// diagonals; the missing triangles that lack a common edge form a region; the tetrahedra that the
// inside of a region crosses are taken away; the cavity above and that below the region are filled
// by gift wrapping.
#include "delaunay/constrained/insert_facets.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "delaunay/constrained/perturbed_sphere.h"
#include "delaunay/constrained/test_budget.h"
#include "delaunay/constrained/wrap_cavity.h"
#include "delaunay/recovery/section.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

/// Those of hard solids take up to 700 tests for each triangle.
constexpr std::size_t kTestsPerTriangle = 2048;
constexpr std::size_t kFewTests = std::size_t{1} << 20U;

using TrianglesAtEdge = std::map<VertexPair, std::vector<std::size_t>>;

Index opposite(const Triangle& triangle, const VertexPair& edge) {
  return *std::find_if(triangle.begin(), triangle.end(),
                       [&](Index v) { return v != edge[0] && v != edge[1]; });
}

class Insertion {
 public:
  Insertion(std::span<const Point> points, std::vector<geometry::Tetrahedron> tetrahedra,
            std::vector<FlatFacet> facets, const CancelPoll& is_cancelled)
      : points_(points),
        mesh_(std::move(tetrahedra), points.size()),
        facets_(std::move(facets)),
        budget_(kFewTests, is_cancelled) {}

  Result<InsertedFacets> run() {
    for (FlatFacet& facet : facets_) {
      budget_.add(kTestsPerTriangle * facet.triangles.size());
      make_delaunay(facet);
      wanted_.insert(facet.triangles.begin(), facet.triangles.end());
    }
    std::size_t missing = 0;
    for (const FlatFacet& facet : facets_) {
      for (const std::vector<Triangle>& region : missing_regions(facet)) {
        if (!insert(region)) missing += region.size();
        if (budget_.is_cancelled()) return Error{ErrorCode::cancelled, "cancelled by the caller"};
      }
    }
    return InsertedFacets{mesh_.take(), std::move(facets_), missing};
  }

 private:
  /// The numbers of tetrahedra of a connected set, each once.
  template <class Belongs>
  void flood(std::vector<Index>& found, const Belongs& belongs) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const Index other = mesh_.neighbour(found[i], corner);
        if (other != kNone && mark(other) && belongs(other)) found.push_back(other);
      }
    }
  }
  void begin_marks() {
    mark_of_.resize(mesh_.places(), 0);
    ++mark_;
  }
  /// False if the tetrahedron has been marked since the last begin_marks().
  bool mark(Index t) { return std::exchange(mark_of_[t], mark_) != mark_; }

  std::vector<Index> star(Index vertex) {
    begin_marks();
    std::vector<Index> found{mesh_.at_vertex(vertex)};
    mark(found[0]);
    flood(found, [&](Index t) { return has_vertex(mesh_.tetrahedron(t), vertex); });
    return found;
  }

  bool is_face(const Triangle& triangle) {
    return std::ranges::any_of(star(triangle[0]), [&](Index t) {
      return has_vertex(mesh_.tetrahedron(t), triangle[1]) &&
             has_vertex(mesh_.tetrahedron(t), triangle[2]);
    });
  }
  bool is_edge(const VertexPair& edge) {
    return std::ranges::any_of(star(edge[0]),
                               [&](Index t) { return has_vertex(mesh_.tetrahedron(t), edge[1]); });
  }

  int side(const Triangle& plane, Index v) const {
    if (has_vertex(plane, v)) return 0;
    return geometry::orient3d(points_[plane[0]], points_[plane[1]], points_[plane[2]], points_[v]);
  }
  /// The least and the largest side of vertices.
  template <class Vertices>
  std::array<int, 2> sides(const Triangle& plane, const Vertices& vertices) const {
    std::array<int, 2> range{1, -1};
    for (const Index v : vertices) {
      const int own = side(plane, v);
      range = {std::min(range[0], own), std::max(range[1], own)};
    }
    return range;
  }

  std::vector<std::size_t> missing_of(const FlatFacet& facet) {
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < facet.triangles.size(); ++i) {
      if (!is_face(facet.triangles[i])) missing.push_back(i);
    }
    return missing;
  }

  static TrianglesAtEdge edges_of_all(const FlatFacet& facet,
                                      const std::vector<std::size_t>& triangles) {
    TrianglesAtEdge at_edge;
    for (const std::size_t i : triangles) {
      for (const VertexPair& edge : edges_of(facet.triangles[i])) at_edge[edge].push_back(i);
    }
    return at_edge;
  }

  /// Exchanges diagonals between missing triangles of a facet until these are Delaunay in its
  /// plane. Each pass exchanges the diagonals of quads that have no triangle in common.
  void make_delaunay(FlatFacet& facet) {
    const std::vector<std::size_t> missing = missing_of(facet);
    if (missing.size() < 2) return;
    const Index off = vertex_off(facet.triangles[missing[0]]);
    bool is_changed = off != kNone;
    while (is_changed) {
      is_changed = false;
      std::vector<bool> is_new(facet.triangles.size());
      for (const auto& [edge, pair] : edges_of_all(facet, missing)) {
        if (pair.size() != 2 || is_new[pair[0]] || is_new[pair[1]] || !budget_.take()) continue;
        Triangle& first = facet.triangles[pair[0]];
        Triangle& second = facet.triangles[pair[1]];
        const Index p = opposite(first, edge);
        const Index q = opposite(second, edge);
        if (!is_other_diagonal_delaunay(edge, p, q, off)) continue;
        first = sorted({p, q, edge[0]});
        second = sorted({p, q, edge[1]});
        is_new[pair[0]] = is_new[pair[1]] = is_changed = true;
      }
    }
    std::sort(facet.triangles.begin(), facet.triangles.end());
  }

  /// A vertex near a triangle that is not in its plane, or kNone.
  Index vertex_off(const Triangle& plane) {
    for (const Index t : star(plane[0])) {
      for (const Index v : mesh_.tetrahedron(t)) {
        if (side(plane, v) != 0) return v;
      }
    }
    return kNone;
  }

  /// True if pq is inside the quad of two triangles with a common edge, and Delaunay there. `off`
  /// is any vertex outside of their plane.
  bool is_other_diagonal_delaunay(const VertexPair& edge, Index p, Index q, Index off) const {
    const auto turn = [&](Index a, Index b, Index c) {
      return geometry::orient3d(points_[a], points_[b], points_[c], points_[off]);
    };
    const int first = turn(p, q, edge[0]);
    const int second = turn(p, q, edge[1]);
    if (first == 0 || second == 0 || first == second) return false;
    std::array<const Point*, 4> sphere{&points_[edge[0]], &points_[edge[1]], &points_[p],
                                       &points_[off]};
    if (turn(edge[0], edge[1], p) < 0) std::swap(sphere[0], sphere[1]);
    return is_in_perturbed_sphere(sphere, points_[q]);
  }

  /// The missing triangles of a facet: those with a common edge that is missing too are together.
  std::vector<std::vector<Triangle>> missing_regions(const FlatFacet& facet) {
    const std::vector<std::size_t> missing = missing_of(facet);
    const TrianglesAtEdge at_edge = edges_of_all(facet, missing);
    std::vector<bool> is_taken(facet.triangles.size());
    std::vector<std::vector<Triangle>> regions;
    for (const std::size_t start : missing) {
      if (is_taken[start]) continue;
      is_taken[start] = true;
      std::vector<Triangle>& region = regions.emplace_back();
      region.push_back(facet.triangles[start]);
      for (std::size_t i = 0; i < region.size(); ++i) {
        for (const VertexPair& edge : edges_of(region[i])) {
          if (at_edge.at(edge).size() < 2 || is_edge(edge)) continue;
          for (const std::size_t other : at_edge.at(edge)) {
            if (is_taken[other]) continue;
            is_taken[other] = true;
            region.push_back(facet.triangles[other]);
          }
        }
      }
    }
    return regions;
  }

  /// The tetrahedra with corners on both sides of a region that its inside crosses.
  std::vector<Index> crossed_by(const std::vector<Triangle>& region) {
    const auto is_crossed = [&](Index t) {
      const geometry::Tetrahedron& tetrahedron = mesh_.tetrahedron(t);
      const auto [least, most] = sides(region[0], tetrahedron);
      return least < 0 && most > 0 && std::ranges::any_of(region, [&](const Triangle& triangle) {
               return budget_.take() && Section(points_, triangle, tetrahedron).meets_inside();
             });
    };
    std::vector<Index> crossed;
    for (const Triangle& triangle : region) {
      for (const Index v : triangle) {
        const std::vector<Index> around = star(v);
        std::ranges::copy_if(around, std::back_inserter(crossed), is_crossed);
      }
    }
    std::sort(crossed.begin(), crossed.end());
    crossed.erase(std::unique(crossed.begin(), crossed.end()), crossed.end());
    begin_marks();
    for (const Index t : crossed) mark(t);
    flood(crossed, is_crossed);
    std::sort(crossed.begin(), crossed.end());
    return crossed;
  }

  /// The triangles around the cavities below and above a region, without those of the region. None
  /// if a triangle is on both sides.
  std::optional<std::array<std::vector<Triangle>, 2>> fronts_of(
      const std::vector<Index>& crossed, const std::vector<Triangle>& region) const {
    std::array<std::vector<Triangle>, 2> fronts;
    for (const Index t : crossed) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const Index other = mesh_.neighbour(t, corner);
        const Triangle face = inward_face(mesh_.tetrahedron(t), corner);
        const bool is_inside = std::binary_search(crossed.begin(), crossed.end(), other);
        if (is_inside && !wanted_.contains(sorted(face))) continue;
        const auto [least, most] = sides(region[0], face);
        const bool is_on_one_side = (most > 0) != (least < 0);
        if (!is_on_one_side) return std::nullopt;
        fronts[most > 0 ? 1 : 0].push_back(face);
      }
    }
    return fronts;
  }

  bool insert(const std::vector<Triangle>& region) {
    const std::vector<Index> crossed = crossed_by(region);
    auto fronts = fronts_of(crossed, region);
    if (budget_.is_used_up() || !fronts || (*fronts)[0].empty() || (*fronts)[1].empty())
      return false;
    auto& [below, above] = *fronts;
    const Index top =
        *std::ranges::find_if(above.front(), [&](Index v) { return side(region[0], v) != 0; });
    for (const Triangle& triangle : region) {
      const Triangle upward = side(triangle, top) > 0 ? triangle : reversed(triangle);
      above.push_back(upward);
      below.push_back(reversed(upward));
    }
    std::vector<geometry::Tetrahedron> filling = wrap_cavity(points_, above, budget_);
    const std::vector<geometry::Tetrahedron> lower = wrap_cavity(points_, below, budget_);
    if (filling.empty() || lower.empty()) return false;
    filling.insert(filling.end(), lower.begin(), lower.end());
    mesh_.replace(crossed, filling);
    return true;
  }

  std::span<const Point> points_;
  TetrahedronMesh mesh_;
  std::vector<FlatFacet> facets_;
  std::set<Triangle> wanted_;  // the triangles of all facets
  std::vector<std::uint32_t> mark_of_;
  std::uint32_t mark_ = 0;
  TestBudget budget_;
};

}  // namespace

Result<InsertedFacets> insert_facets(std::span<const Point> points,
                                     std::vector<geometry::Tetrahedron> tetrahedra,
                                     std::vector<FlatFacet> facets,
                                     const CancelPoll& is_cancelled) {
  return Insertion(points, std::move(tetrahedra), std::move(facets), is_cancelled).run();
}

}  // namespace watertight::delaunay
