// SPDX-License-Identifier: GPL-3.0-or-later
//
// Steps: find the pairs of triangles of different shells that meet; divide the triangles of each
// facet at the vertices of other shells that lie on them; make the edges of other shells that lie
// on a facet edges of its triangles, by flips (after S. W. Sloan, "A fast algorithm for generating
// constrained Delaunay triangulations", 1993). A straight edge that runs over two triangles lies in
// both planes, so that the two triangles of a flip are coplanar even where the facet as a whole is
// not.
#include "delaunay/shell_contacts.h"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "geometry/intersection/box_partition.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

using Edge = std::pair<Index, Index>;

constexpr std::uint64_t kMostPairs = 20'000'000;

Edge edge_between(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// For each edge of a triangle in projection: +1 if the point is on the inner side, 0 on the line
/// of the edge, -1 on the outer side.
std::array<int, 3> sides(std::span<const Point> points, const Triangle& t, const Point& p,
                         int axis) {
  const int turn = geometry::orient2d(points[t[0]], points[t[1]], points[t[2]], axis);
  std::array<int, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = turn * geometry::orient2d(points[t[k]], points[t[(k + 1) % 3]], p, axis);
  }
  return result;
}

/// True if segments ab and cd have exactly one point in common, inside both.
bool do_cross(std::span<const Point> points, const Edge& first, const Edge& second) {
  const auto [a, b] = first;
  const auto [c, d] = second;
  if (a == c || a == d || b == c || b == d) return false;
  if (geometry::orient3d(points[a], points[b], points[c], points[d]) != 0) return false;
  // The turns decide along any axis along which the common plane has an area in projection.
  for (int axis = 0; axis < 3; ++axis) {
    const int c_side = geometry::orient2d(points[a], points[b], points[c], axis);
    const int d_side = geometry::orient2d(points[a], points[b], points[d], axis);
    const int a_side = geometry::orient2d(points[c], points[d], points[a], axis);
    const int b_side = geometry::orient2d(points[c], points[d], points[b], axis);
    if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  }
  return false;
}

/// The triangles of one facet, to be divided.
class FacetMesh {
 public:
  FacetMesh(std::span<const Point> points, std::span<const Triangle> triangles, int axis)
      : points_(points), triangles_(triangles.begin(), triangles.end()), axis_(axis) {
    const Triangle& t = triangles_.front();
    turn_ = geometry::orient2d(points[t[0]], points[t[1]], points[t[2]], axis);
  }

  const std::vector<Triangle>& triangles() const { return triangles_; }

  /// Divides each triangle that has the vertex inside into three, or in an edge into two.
  void divide(Index vertex) {
    const std::size_t count = triangles_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Triangle t = triangles_[i];
      if (std::find(t.begin(), t.end(), vertex) != t.end()) return;
      if (!is_on_triangle(points_, t, points_[vertex], axis_)) continue;
      const std::array<int, 3> side = sides(points_, t, points_[vertex], axis_);
      bool is_replaced = false;
      for (std::size_t k = 0; k < 3; ++k) {
        if (side[k] == 0) continue;
        const Triangle part{t[k], t[(k + 1) % 3], vertex};
        if (is_replaced) {
          triangles_.push_back(part);
        } else {
          triangles_[i] = part;
        }
        is_replaced = true;
      }
    }
  }

  /// Notes which triangle is beside each edge, after the last divide(). Returns the directed edges
  /// with a triangle on one side only.
  std::vector<Edge> link() {
    left_of_.clear();
    for (std::size_t t = 0; t < triangles_.size(); ++t) connect(t);
    std::vector<Edge> boundary;
    for (const auto& [edge, triangle] : left_of_) {
      if (!left_of_.contains({edge.second, edge.first})) boundary.push_back(edge);
    }
    return boundary;
  }

  bool has_edge(const Edge& edge) const {
    return left_of_.contains(edge) || left_of_.contains({edge.second, edge.first});
  }

  /// Makes the segment an edge if it lies on the facet. Requires link() before.
  void insert(const Edge& segment) {
    if (has_edge(segment)) return;
    std::optional<std::deque<Edge>> crossed = edges_across(segment);
    if (!crossed) return;
    // A flip that does not help at once is put off; k edges need at most some k^2 flips.
    std::size_t left = 16 + 4 * crossed->size() * crossed->size();
    while (!crossed->empty() && left-- > 0) {
      const Edge edge = crossed->front();
      crossed->pop_front();
      const std::optional<Edge> flipped = flip(edge);
      if (!flipped) {
        crossed->push_back(edge);
      } else if (do_cross(points_, *flipped, segment)) {
        crossed->push_back(*flipped);
      }
    }
  }

 private:
  void connect(std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      left_of_[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = t;
    }
  }
  bool is_positive(Index a, Index b, Index c) const {
    return turn_ * geometry::orient2d(points_[a], points_[b], points_[c], axis_) > 0;
  }
  Index opposite(const Edge& edge) const {
    for (const Index v : triangles_[left_of_.at(edge)]) {
      if (v != edge.first && v != edge.second) return v;
    }
    return kNone;
  }

  /// The edges between the triangles that the segment runs over, or nothing if it leaves the facet.
  std::optional<std::deque<Edge>> edges_across(const Edge& segment) const {
    std::deque<Edge> crossed;
    std::optional<Edge> edge = first_across(segment);
    while (edge) {
      if (crossed.size() > triangles_.size()) return std::nullopt;
      crossed.push_back(*edge);
      const Edge reverse{edge->second, edge->first};
      if (!left_of_.contains(reverse)) return std::nullopt;
      const Index apex = opposite(reverse);
      if (apex == segment.second) return crossed;
      if (do_cross(points_, {reverse.second, apex}, segment)) {
        edge = Edge{reverse.second, apex};
      } else if (do_cross(points_, {apex, reverse.first}, segment)) {
        edge = Edge{apex, reverse.first};
      } else {
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

  /// The edge of the segment's first triangle through which the segment leaves that triangle.
  std::optional<Edge> first_across(const Edge& segment) const {
    for (const Triangle& t : triangles_) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (t[k] != segment.first) continue;
        const Edge edge{t[(k + 1) % 3], t[(k + 2) % 3]};
        if (do_cross(points_, edge, segment)) return edge;
      }
    }
    return std::nullopt;
  }

  std::optional<Edge> flip(const Edge& edge) {
    const auto [a, b] = edge;
    const Index c = opposite(edge);
    const Index d = opposite({b, a});
    if (!is_positive(a, d, c) || !is_positive(d, b, c)) return std::nullopt;
    const std::size_t left = left_of_.at(edge);
    const std::size_t right = left_of_.at({b, a});
    left_of_.erase(edge);
    left_of_.erase({b, a});
    triangles_[left] = {a, d, c};
    triangles_[right] = {d, b, c};
    connect(left);
    connect(right);
    return Edge{d, c};
  }

  std::span<const Point> points_;
  std::vector<Triangle> triangles_;
  std::map<Edge, std::size_t> left_of_;  // directed edge -> the index of its triangle
  int axis_;
  int turn_;
};

class ContactDivision {
 public:
  ContactDivision(const Solid& solid, const tessellate::FacetTriangles& canonical)
      : solid_(solid), canonical_(canonical), points_(solid.vertices()) {}

  Result<ContactTriangles> run(const CancelPoll& is_cancelled) {
    geometry::IntersectionOptions options;
    options.limit = kMostPairs;
    options.cancel = is_cancelled;
    options.group_of = canonical_.facet_of;
    const auto pairs = geometry::intersecting_pairs(points_, canonical_.triangles, options);
    if (!pairs) return pairs.error();
    if (pairs->size() >= kMostPairs) {
      return Error{ErrorCode::limit_exceeded, "the shells touch in too many places"};
    }
    collect_ring_edges();
    for (const geometry::IntersectingPair& pair : *pairs) note(pair);
    note_common_diagonals();
    if (touched_.empty() && result_.obstacle.empty()) return std::move(result_);
    result_.is_touched.assign(solid_.facet_count(), false);
    for (const Index facet : touched_) result_.is_touched[facet] = true;
    divide();
    assemble();
    return std::move(result_);
  }

 private:
  Index shell_of(Index triangle) const { return solid_.shell_of(canonical_.facet_of[triangle]); }

  void collect_ring_edges() {
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      const IndexRange rings = solid_.rings_of(facet);
      for (Index r = rings.begin; r < rings.end; ++r) {
        const std::span<const Index> ring = solid_.ring(r);
        for (std::size_t i = 0; i < ring.size(); ++i) {
          ring_edges_.push_back(edge_between(ring[i], ring[(i + 1) % ring.size()]));
        }
      }
    }
    std::sort(ring_edges_.begin(), ring_edges_.end());
  }
  bool is_ring_edge(const Edge& edge) const {
    return std::binary_search(ring_edges_.begin(), ring_edges_.end(), edge);
  }

  void note(const geometry::IntersectingPair& pair) {
    if (shell_of(pair.first) == shell_of(pair.second)) return;
    note_vertices(pair.first, pair.second);
    note_vertices(pair.second, pair.first);
    const Index first = canonical_.facet_of[pair.first];
    const Index second = canonical_.facet_of[pair.second];
    meeting_.insert({first, second});
    meeting_.insert({second, first});
    if (pair.contact >= geometry::ContactClass::edge_edge) note_crossing(pair);
  }

  void note_vertices(Index triangle, Index other) {
    const Triangle& t = canonical_.triangles[triangle];
    const Index facet = canonical_.facet_of[triangle];
    for (const Index v : canonical_.triangles[other]) {
      if (std::find(t.begin(), t.end(), v) != t.end()) continue;
      if (!is_on_triangle(points_, t, points_[v], tessellate::facet_projection(solid_, facet).axis))
        continue;
      inside_[facet].insert(v);
      touched_.insert(facet);
    }
  }

  /// Notes the facets where an edge inside a facet crosses an edge of another shell, and reports
  /// edges of two shells that cross in no vertex.
  void note_crossing(const geometry::IntersectingPair& pair) {
    const Triangle& first = canonical_.triangles[pair.first];
    const Triangle& second = canonical_.triangles[pair.second];
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge a = edge_between(first[i], first[(i + 1) % 3]);
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge b = edge_between(second[k], second[(k + 1) % 3]);
        if (!do_cross(points_, a, b)) continue;
        const Index facet_of_a = canonical_.facet_of[pair.first];
        const Index facet_of_b = canonical_.facet_of[pair.second];
        if (!is_ring_edge(a)) touched_.insert(facet_of_a);
        if (!is_ring_edge(b)) touched_.insert(facet_of_b);
        if (is_fixed(a, facet_of_a) && is_fixed(b, facet_of_b)) report(facet_of_a, facet_of_b);
      }
    }
  }

  /// True for an edge of the surface: one of a ring, or a fold of a facet that is not planar.
  bool is_fixed(const Edge& edge, Index facet) const {
    if (is_ring_edge(edge)) return true;
    std::vector<Index> apexes;
    for (Index i = canonical_.first[facet]; i < canonical_.first[facet + 1]; ++i) {
      const Triangle& t = canonical_.triangles[i];
      for (std::size_t k = 0; k < 3; ++k) {
        if (edge_between(t[k], t[(k + 1) % 3]) == edge) apexes.push_back(t[(k + 2) % 3]);
      }
    }
    return apexes.size() == 2 && geometry::orient3d(points_[edge.first], points_[edge.second],
                                                    points_[apexes[0]], points_[apexes[1]]) != 0;
  }

  void report(Index facet, Index other) {
    if (!result_.obstacle.empty()) return;
    result_.obstacle = "facets " + std::to_string(std::min(facet, other)) + " and ";
    result_.obstacle += std::to_string(std::max(facet, other)) + " of different shells touch where";
    result_.obstacle += " two edges (or folds) cross in a point that is not a vertex";
  }

  /// Notes the facets that have a diagonal of their triangulation in common with a ring edge of
  /// another facet. The search for triangles that intersect does not find these contacts.
  void note_common_diagonals() {
    for (Index t = 0; t < canonical_.triangles.size(); ++t) {
      const Index facet = canonical_.facet_of[t];
      if (canonical_.first[facet + 1] - canonical_.first[facet] < 2) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = canonical_.triangles[t][k];
        const Index b = canonical_.triangles[t][(k + 1) % 3];
        if (is_ring_edge(edge_between(a, b)) && !is_own_edge(facet, a, b)) touched_.insert(facet);
      }
    }
  }

  bool is_own_edge(Index facet, Index a, Index b) const {
    const IndexRange rings = solid_.rings_of(facet);
    for (Index r = rings.begin; r < rings.end; ++r) {
      const std::span<const Index> ring = solid_.ring(r);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        if (ring[i] == a && ring[(i + 1) % ring.size()] == b) return true;
      }
    }
    return false;
  }

  FacetMesh& mesh_of(Index facet) {
    const auto place = meshes_.find(facet);
    if (place != meshes_.end()) return place->second;
    const auto own = std::span(canonical_.triangles)
                         .subspan(canonical_.first[facet],
                                  canonical_.first[facet + 1] - canonical_.first[facet]);
    return meshes_
        .emplace(facet, FacetMesh(points_, own, tessellate::facet_projection(solid_, facet).axis))
        .first->second;
  }

  void divide() {
    for (const Index facet : touched_) mesh_of(facet);
    for (const auto& [facet, other] : meeting_) mesh_of(facet);
    for (const auto& [facet, vertices] : inside_) {
      for (const Index v : vertices) mesh_of(facet).divide(v);
    }
    std::map<Index, std::vector<Edge>> boundaries;
    std::map<Index, std::set<Index>> corners;
    for (auto& [facet, mesh] : meshes_) {
      boundaries[facet] = mesh.link();
      for (const Triangle& t : mesh.triangles()) corners[facet].insert(t.begin(), t.end());
    }
    for (const auto& [facet, other] : meeting_) {
      if (!touched_.contains(facet)) continue;
      const std::set<Index>& own = corners[facet];
      for (const Edge& edge : boundaries[other]) {
        if (own.contains(edge.first) && own.contains(edge.second)) mesh_of(facet).insert(edge);
      }
    }
  }

  void assemble() {
    result_.triangles.state = canonical_.state;
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      const auto mesh = meshes_.find(facet);
      auto& list = result_.triangles.triangles;
      if (mesh != meshes_.end()) {
        list.insert(list.end(), mesh->second.triangles().begin(), mesh->second.triangles().end());
      } else {
        list.insert(list.end(), canonical_.triangles.begin() + canonical_.first[facet],
                    canonical_.triangles.begin() + canonical_.first[facet + 1]);
      }
      result_.triangles.facet_of.resize(list.size(), facet);
      result_.triangles.first.push_back(static_cast<Index>(list.size()));
    }
  }

  const Solid& solid_;
  const tessellate::FacetTriangles& canonical_;
  std::span<const Point> points_;
  std::vector<Edge> ring_edges_;
  std::set<Index> touched_;
  std::set<std::pair<Index, Index>> meeting_;  // pairs of facets of different shells that meet, in
                                               // both orders
  std::map<Index, std::set<Index>> inside_;    // facet -> vertices of other shells on it
  std::map<Index, FacetMesh> meshes_;
  ContactTriangles result_;
};

}  // namespace

bool is_on_triangle(std::span<const Point> points, const Triangle& triangle, const Point& point,
                    int axis) {
  const auto& [a, b, c] = triangle;
  for (int k = 0; k < 3; ++k) {
    const double low = std::min({points[a][k], points[b][k], points[c][k]});
    const double high = std::max({points[a][k], points[b][k], points[c][k]});
    if (point[k] < low || point[k] > high) return false;
  }
  if (geometry::orient3d(points[a], points[b], points[c], point) != 0) return false;
  const std::array<int, 3> side = sides(points, triangle, point, axis);
  return std::all_of(side.begin(), side.end(), [](int sign) { return sign >= 0; });
}

Result<ContactTriangles> divide_at_contacts(const Solid& solid,
                                            const tessellate::FacetTriangles& canonical,
                                            const CancelPoll& is_cancelled) {
  if (solid.shell_count() < 2) return ContactTriangles{};
  return ContactDivision(solid, canonical).run(is_cancelled);
}

}  // namespace watertight::delaunay
