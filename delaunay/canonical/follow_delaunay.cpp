// SPDX-License-Identifier: GPL-3.0-or-later
//
// A set of triangles whose projections all turn as the facet does, and whose edges cancel to
// exactly the facet's rings, covers each point of the projection as often as the rings wind around
// it: once between the rings, never outside. So neither the walk nor the dynamic programme below
// tests segments for crossing; both only take positive triangles and balance edges.
//
// Within a facet, vertices are numbered by their coordinates, which makes every tie independent of
// the numbering of the input.
#include "delaunay/canonical/follow_delaunay.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory_resource>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "base/assert.h"
#include "delaunay/cancellation.h"
#include "delaunay/canonical/sort_by_vertices.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

/// Rings with more vertices are not given to the cubic dynamic programme.
constexpr std::size_t kLargestMeasuredRing = 60;
/// The most flips on a facet, for each of its vertices.
constexpr std::size_t kFlipsPerVertex = 3;

using Edge = std::pair<Index, Index>;

/// Finds Delaunay faces by an edge, or by their vertices.
class DelaunayFaces {
 public:
  DelaunayFaces(const CanonicalDelaunay& delaunay, std::size_t vertex_count)
      : faces_(delaunay.faces), vertex_count_(vertex_count), first_(vertex_count + 1) {
    for (const Triangle& face : faces_) ++first_[face[0] + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }

  /// The index of a face in the sorted list, or kNone.
  Index find(const Triangle& triangle) const {
    const auto [a, b, c] = sorted(triangle);
    const auto rest = [](const Triangle& face) { return std::uint64_t{face[1]} << 32U | face[2]; };
    const std::uint64_t wanted = std::uint64_t{b} << 32U | c;
    const auto own = faces_.subspan(first_[a], first_[a + 1] - first_[a]);
    const auto at = std::ranges::lower_bound(own, wanted, {}, rest);
    if (at == own.end() || rest(*at) != wanted) return kNone;
    return static_cast<Index>(&*at - faces_.data());
  }

  /// Calls `visit` with the third vertex of each face at an edge, in any order. The table is built
  /// on first use: solids made of triangles never need it.
  template <class Visit>
  void for_each_around(Index a, Index b, const Visit& visit) {
    if (by_edge_.empty()) build();
    const auto [low, high] = std::minmax(a, b);
    const std::span own(by_edge_.data() + first_edge_[low],
                        first_edge_[low + 1] - first_edge_[low]);
    auto at = own.begin();
    if (own.size() > kFewFaces) at = std::ranges::lower_bound(own, Edge{high, 0});
    for (; at != own.end(); ++at) {
      if (at->first == high) visit(at->second);
      if (at->first > high && own.size() > kFewFaces) break;
    }
  }

 private:
  /// Up to so many entries of a vertex are looked at one by one.
  static constexpr std::size_t kFewFaces = 64;

  void build() {
    first_edge_.assign(vertex_count_ + 1, 0);
    for (const auto& [a, b, c] : faces_) {
      first_edge_[a + 1] += 2;
      first_edge_[b + 1] += 1;
    }
    std::partial_sum(first_edge_.begin(), first_edge_.end(), first_edge_.begin());
    by_edge_.resize(3 * faces_.size());
    std::vector<std::size_t> next(first_edge_.begin(), first_edge_.end() - 1);
    for (const auto& [a, b, c] : faces_) {
      by_edge_[next[a]++] = {b, c};
      by_edge_[next[a]++] = {c, b};
      by_edge_[next[b]++] = {c, a};
    }
    for (Index v = 0; v < vertex_count_; ++v) {
      const std::span own(by_edge_.data() + first_edge_[v], first_edge_[v + 1] - first_edge_[v]);
      if (own.size() > kFewFaces) std::ranges::sort(own);
    }
  }

  std::span<const Triangle> faces_;
  std::size_t vertex_count_;
  std::vector<Index> first_;  // vertex -> the first face that has it as its smallest
  // The lower end of an edge -> its entries: the higher end and the third vertex of a face. The
  // entries of a vertex with many are sorted.
  std::vector<std::size_t> first_edge_;
  std::vector<Edge> by_edge_;
};

/// True if the projected triangle turns as the facet does, and has area.
bool is_positive(const Point& a, const Point& b, const Point& c,
                 const tessellate::Projection& projection) {
  const int turn = geometry::orient2d(a, b, c, projection.axis);
  return projection.is_mirrored ? turn < 0 : turn > 0;
}

/// One facet with its vertices numbered 0, 1, ... by coordinates.
struct LocalFacet {
  std::vector<Index> global;  // local vertex -> vertex of the solid
  std::vector<std::vector<Index>> rings;
  std::vector<Edge> boundary;  // directed: the ring edges, divided where other shells touch them
  std::vector<Triangle> canonical;
  std::span<const Point> points;
  tessellate::Projection projection;
  std::size_t triangle_count = 0;

  Triangle to_global(const Triangle& t) const { return {global[t[0]], global[t[1]], global[t[2]]}; }
  bool is_positive(Index a, Index b, Index c) const {
    return delaunay::is_positive(points[global[a]], points[global[b]], points[global[c]],
                                 projection);
  }
};

/// The directed edges that have a triangle on one side only, sorted.
std::vector<Edge> boundary_of(std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> boundary;
  std::copy_if(edges.begin(), edges.end(), std::back_inserter(boundary), [&](const Edge& edge) {
    return !std::binary_search(edges.begin(), edges.end(), Edge{edge.second, edge.first});
  });
  return boundary;
}

LocalFacet localize(const Solid& solid, Index facet, std::span<const Triangle> canonical,
                    std::vector<Index>& local_of) {
  LocalFacet local;
  local.points = solid.vertices();
  local.projection = tessellate::facet_projection(solid, facet);
  local.triangle_count = canonical.size();
  const IndexRange rings = solid.rings_of(facet);
  local.global.reserve(3 * canonical.size());
  for (const Triangle& t : canonical) {
    local.global.insert(local.global.end(), t.begin(), t.end());
  }
  std::sort(local.global.begin(), local.global.end(), [&](Index a, Index b) {
    return std::pair(local.points[a], a) < std::pair(local.points[b], b);
  });
  local.global.erase(std::unique(local.global.begin(), local.global.end()), local.global.end());
  for (Index i = 0; i < local.global.size(); ++i) local_of[local.global[i]] = i;
  for (Index ring = rings.begin; ring < rings.end; ++ring) {
    std::vector<Index>& vertices = local.rings.emplace_back();
    vertices.reserve(solid.ring(ring).size());
    for (const Index vertex : solid.ring(ring)) vertices.push_back(local_of[vertex]);
    std::rotate(vertices.begin(), std::min_element(vertices.begin(), vertices.end()),
                vertices.end());
  }
  local.canonical.reserve(canonical.size());
  for (const Triangle& t : canonical) {
    local.canonical.push_back({local_of[t[0]], local_of[t[1]], local_of[t[2]]});
  }
  local.boundary = boundary_of(local.canonical);
  return local;
}

/// Memory for the containers of one facet, which is given back with them. Most facets are small and
/// need what is here.
class LocalMemory {
 public:
  std::pmr::memory_resource* resource() { return &resource_; }

 private:
  std::array<std::byte, 8192> first_;
  std::pmr::monotonic_buffer_resource resource_{first_.data(), first_.size()};
};

/// Collects the Delaunay faces on the inner side of each edge, from the rings inward. Finds nothing
/// if an edge has no such face, or has two (possible only in facets that are not exactly planar).
class Walk {
 public:
  Walk(const LocalFacet& facet, DelaunayFaces& faces, const std::vector<Index>& local_of)
      : facet_(facet), faces_(faces), local_of_(local_of) {}

  std::optional<std::vector<Triangle>> run() {
    open_.insert(facet_.boundary.begin(), facet_.boundary.end());
    std::vector<Triangle> triangles;
    while (!open_.empty()) {
      if (triangles.size() == facet_.triangle_count) return std::nullopt;
      const auto [a, b] = *open_.begin();
      const std::optional<Index> third = third_vertex(a, b);
      if (!third) return std::nullopt;
      open_.erase(open_.begin());
      if (!close({b, *third}) || !close({*third, a})) return std::nullopt;
      triangles.push_back({a, b, *third});
    }
    return triangles;
  }

 private:
  std::optional<Index> third_vertex(Index a, Index b) const {
    Index found = kNone;
    bool is_unique = true;
    faces_.for_each_around(facet_.global[a], facet_.global[b], [&](Index vertex) {
      const Index third = local_of_[vertex];
      if (third == kNone || !facet_.is_positive(a, b, third)) return;
      is_unique = found == kNone;
      found = third;
    });
    if (found == kNone || !is_unique) return std::nullopt;
    return found;
  }

  /// Accounts for an edge of a new triangle: it closes an open edge, or its reverse becomes open.
  bool close(const Edge& edge) {
    if (open_.erase(edge) > 0) return true;
    return open_.insert({edge.second, edge.first}).second;
  }

  const LocalFacet& facet_;
  DelaunayFaces& faces_;
  const std::vector<Index>& local_of_;
  LocalMemory memory_;
  // Directed edges whose left side is not covered yet.
  std::pmr::set<Edge> open_{memory_.resource()};
};

/// Finds, by Klincsek's dynamic programme, the triangulation of one ring with the fewest triangles
/// that are not Delaunay faces; of equals, the one with the third vertices that come first in the
/// ring.
std::vector<Triangle> fewest_missing(const LocalFacet& facet, const DelaunayFaces& faces) {
  const std::vector<Index>& ring = facet.rings[0];
  const std::size_t n = ring.size();
  constexpr Index kImpossible = kNone / 4;
  std::vector<Index> cost(n * n, kImpossible);
  std::vector<std::size_t> apex(n * n, 0);
  for (std::size_t i = 0; i + 1 < n; ++i) cost[i * n + i + 1] = 0;
  for (std::size_t length = 2; length < n; ++length) {
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      for (std::size_t k = i + 1; k < j; ++k) {
        const Index parts = cost[i * n + k] + cost[k * n + j];
        if (parts >= cost[i * n + j] || !facet.is_positive(ring[i], ring[k], ring[j])) continue;
        const bool found = faces.find(facet.to_global({ring[i], ring[k], ring[j]})) != kNone;
        const Index total = parts + (found ? 0 : 1);
        if (total >= cost[i * n + j]) continue;
        cost[i * n + j] = total;
        apex[i * n + j] = k;
      }
    }
  }
  std::vector<Triangle> triangles;
  if (cost[n - 1] >= kImpossible) return triangles;
  std::vector<std::pair<std::size_t, std::size_t>> pending{{0, n - 1}};
  while (!pending.empty()) {
    const auto [i, j] = pending.back();
    pending.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = apex[i * n + j];
    triangles.push_back({ring[i], ring[k], ring[j]});
    pending.push_back({i, k});
    pending.push_back({k, j});
  }
  return triangles;
}

/// Flips diagonals of the canonical triangulation while that makes more Delaunay faces.
class DiagonalFlips {
 public:
  DiagonalFlips(const LocalFacet& facet, const DelaunayFaces& faces)
      : facet_(facet), faces_(faces), triangles_(facet.canonical) {
    // The numbering of the triangles is the caller's: sorting gives the flips a defined order.
    for (Triangle& t : triangles_)
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles_.begin(), triangles_.end());
    for (std::size_t t = 0; t < triangles_.size(); ++t) connect(t);
  }

  std::vector<Triangle> run() {
    std::pmr::set<Edge> pending(memory_.resource());
    for (const auto& [edge, triangle] : side_) {
      if (edge.first < edge.second && side_.contains({edge.second, edge.first}))
        pending.insert(edge);
    }
    std::size_t left = kFlipsPerVertex * facet_.global.size();
    while (!pending.empty() && left > 0) {
      const Edge edge = *pending.begin();
      pending.erase(pending.begin());
      if (!flip_if_better(edge)) continue;
      --left;
      // Other diagonals of the four outer edges may have become worth a flip.
      for (const std::size_t t :
           {side_.at(flipped_), side_.at({flipped_.second, flipped_.first})}) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto [low, high] = std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3]);
          if (Edge{low, high} != flipped_ && side_.contains({low, high}) &&
              side_.contains({high, low})) {
            pending.insert({low, high});
          }
        }
      }
    }
    return std::move(triangles_);
  }

 private:
  void connect(std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      side_[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = t;
    }
  }
  Index opposite(std::size_t t, const Edge& edge) const {
    for (const Index vertex : triangles_[t]) {
      if (vertex != edge.first && vertex != edge.second) return vertex;
    }
    return kNone;
  }
  int is_face(Index a, Index b, Index c) const {
    return faces_.find(facet_.to_global({a, b, c})) != kNone ? 1 : 0;
  }

  bool flip_if_better(const Edge& edge) {
    const auto [a, b] = edge;
    const std::size_t left = side_.at(edge);
    const std::size_t right = side_.at({b, a});
    const Index c = opposite(left, edge);
    const Index d = opposite(right, edge);
    if (is_face(a, d, c) + is_face(d, b, c) <= is_face(a, b, c) + is_face(b, a, d)) return false;
    if (!facet_.is_positive(a, d, c) || !facet_.is_positive(d, b, c)) return false;
    side_.erase({a, b});
    side_.erase({b, a});
    triangles_[left] = {a, d, c};
    triangles_[right] = {d, b, c};
    connect(left);
    connect(right);
    flipped_ = std::minmax(c, d);
    return true;
  }

  const LocalFacet& facet_;
  const DelaunayFaces& faces_;
  std::vector<Triangle> triangles_;
  LocalMemory memory_;
  // Directed edge -> the triangle on its left.
  std::pmr::map<Edge, std::size_t> side_{memory_.resource()};
  Edge flipped_{};
};

std::vector<Triangle> follow_locally(const LocalFacet& facet, DelaunayFaces& faces,
                                     const std::vector<Index>& local_of) {
  if (auto found = Walk(facet, faces, local_of).run()) return std::move(*found);
  if (facet.rings.size() == 1 && facet.rings[0].size() <= kLargestMeasuredRing) {
    std::vector<Triangle> found = fewest_missing(facet, faces);
    if (found.size() == facet.canonical.size()) return found;
  }
  return DiagonalFlips(facet, faces).run();
}

/// Chooses the diagonal of a facet with four vertices as the functions above would: with the fewest
/// triangles that are not Delaunay faces; of equals, the one that does not end in the vertex that
/// comes first by coordinates.
std::array<Triangle, 2> follow_quad(const Solid& merged, Index facet,
                                    std::span<const Triangle> canonical,
                                    const DelaunayFaces& faces) {
  const std::span<const Point> points = merged.vertices();
  std::array<Index, 4> v{};
  std::ranges::copy(merged.ring(merged.rings_of(facet).begin), v.begin());
  std::rotate(v.begin(), std::ranges::min_element(v, {}, [&](Index i) { return points[i]; }),
              v.end());
  const std::array<Triangle, 2> first{{{v[0], v[1], v[3]}, {v[1], v[2], v[3]}}};
  const std::array<Triangle, 2> second{{{v[0], v[2], v[3]}, {v[0], v[1], v[2]}}};
  const auto faces_in = [&](const std::array<Triangle, 2>& pair) {
    return std::ranges::count_if(pair, [&](const Triangle& t) { return faces.find(t) != kNone; });
  };
  const auto gain = faces_in(second) - faces_in(first);
  const std::array<Triangle, 2>& wanted = gain > 0 ? second : first;
  const std::array<Triangle, 2>& other = gain > 0 ? first : second;
  const Triangle known = sorted(wanted[0]);
  const bool is_canonical =
      std::ranges::any_of(canonical, [&](const Triangle& t) { return sorted(t) == known; });
  if (is_canonical) return wanted;  // the canonical triangles cover the facet
  const tessellate::Projection projection = tessellate::facet_projection(merged, facet);
  const bool covers = std::ranges::all_of(wanted, [&](const Triangle& t) {
    return is_positive(points[t[0]], points[t[1]], points[t[2]], projection);
  });
  return covers ? wanted : other;
}

/// Requires `local_of` to hold kNone everywhere, and leaves it so.
std::vector<Triangle> follow_facet(const Solid& merged, Index facet,
                                   std::span<const Triangle> canonical, DelaunayFaces& faces,
                                   std::vector<Index>& local_of) {
  if (canonical.size() < 2) return {canonical.begin(), canonical.end()};
  const IndexRange rings = merged.rings_of(facet);
  if (canonical.size() == 2 && rings.size() == 1 && merged.ring(rings.begin).size() == 4) {
    const std::array<Triangle, 2> pair = follow_quad(merged, facet, canonical, faces);
    return {pair.begin(), pair.end()};
  }
  const LocalFacet local = localize(merged, facet, canonical, local_of);
  std::vector<Triangle> triangles = follow_locally(local, faces, local_of);
  for (Triangle& t : triangles) t = local.to_global(t);
  for (const Index vertex : local.global) local_of[vertex] = kNone;
  return triangles;
}

}  // namespace

Result<FollowingTriangles> follow_delaunay(const Solid& merged,
                                           const tessellate::FacetTriangles& canonical,
                                           const CanonicalDelaunay& delaunay,
                                           const std::vector<bool>& is_kept,
                                           const CancelPoll& is_cancelled) {
  WATERTIGHT_ASSERT(canonical.first.size() == std::size_t{merged.facet_count()} + 1);
  FollowingTriangles result;
  Cancellation cancellation(is_cancelled);
  DelaunayFaces faces(delaunay, merged.vertex_count());
  std::vector<Index> local_of(merged.vertex_count(), kNone);
  for (Index facet = 0; facet < merged.facet_count(); ++facet) {
    const auto own =
        std::span(canonical.triangles)
            .subspan(canonical.first[facet], canonical.first[facet + 1] - canonical.first[facet]);
    // A facet of k <= kLargestMeasuredRing vertices may take k^3 steps, a larger one about k log k.
    if (cancellation.is_due_and_wanted(1 + 16 * own.size())) {
      return Error{ErrorCode::cancelled, "cancelled by the caller"};
    }
    const bool is_own = !is_kept.empty() && is_kept[facet];
    std::vector<Triangle> triangles = is_own ? std::vector<Triangle>(own.begin(), own.end())
                                             : follow_facet(merged, facet, own, faces, local_of);
    for (Triangle& t : triangles)
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    Index missing = 0;
    for (const Triangle& t : triangles) {
      result.delaunay_face.push_back(faces.find(t));
      if (result.delaunay_face.back() == kNone) ++missing;
    }
    result.triangles.insert(result.triangles.end(), triangles.begin(), triangles.end());
    result.facet_of.resize(result.triangles.size(), facet);
    result.first.push_back(static_cast<Index>(result.triangles.size()));
    result.missing.push_back(missing);
    result.missing_total += missing;
  }
  return result;
}

FollowingTriangles follow_delaunay(const Solid& merged, const tessellate::FacetTriangles& canonical,
                                   const CanonicalDelaunay& delaunay) {
  Result<FollowingTriangles> result = follow_delaunay(merged, canonical, delaunay, {}, {});
  WATERTIGHT_ASSERT(result.has_value());  // nobody cancels
  return *std::move(result);
}

bool part_equal_triangles(std::span<const Triangle> triangles, std::span<const Index> facet_of,
                          std::vector<bool>& is_kept) {
  std::vector<std::pair<Triangle, Index>> uses;
  uses.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    uses.emplace_back(triangles[i], facet_of[i]);
    std::sort(uses.back().first.begin(), uses.back().first.end());
  }
  std::sort(uses.begin(), uses.end());
  bool has_changed = false;
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (uses[i].first != uses[i - 1].first) continue;
    for (const Index facet : {uses[i - 1].second, uses[i].second}) {
      has_changed = has_changed || !is_kept[facet];
      is_kept[facet] = true;
    }
  }
  return has_changed;
}

}  // namespace watertight::delaunay
