// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/constrained/protect_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "delaunay/cancellation.h"
#include "delaunay/canonical/growing_delaunay.h"
#include "delaunay/recovery/point_between.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/predicates/predicates.h"
#include "tessellate/flatness.h"

namespace watertight::delaunay {
namespace {

constexpr std::size_t kFewSteiner = 1024;
constexpr std::size_t kSteinerPerVertex = 24;
constexpr std::size_t kMostSteiner = 16'384;
/// A larger solid is not divided: that would take too long.
constexpr std::size_t kMostGiven = 65'536;
/// The most rounds, each of which divides all edges that are missing; those of hard solids take 40.
constexpr std::size_t kMostRounds = 64;
/// The reach of a place, as a share of its distance from the nearer end: the place in it that has
/// the fewest bits is taken. The second one is for edges on which doubles are rare.
constexpr std::array<double, 2> kReaches{1.0 / 32, 1.0 / 2};
constexpr int kMostPlaceBits = 50;
/// An edge with one Steiner end is divided in its middle where the other rule gives a place that is
/// nearer than this to an end.
constexpr double kLeastPlace = 1.0 / 1024;
constexpr double kMostPlace = 0.8;
/// The same for an edge with two ends of one kind: edges close beside each other would take turns
/// to cut small parts off.
constexpr double kLeastPlaceOfEqualEnds = 1.0 / 8;
/// A Delaunay tetrahedralization of a boundary has about 7 tetrahedra for each vertex.
constexpr std::uint64_t kTetrahedraPerVertex = 256;

class Protection {
 public:
  Protection(const Solid& solid, const tessellate::FacetTriangles& triangles,
             const std::vector<bool>& is_taken_apart, const CancelPoll& is_cancelled)
      : solid_(solid),
        triangles_(triangles),
        points_(solid.vertices().begin(), solid.vertices().end()),
        is_cancelled_(is_cancelled),
        cancellation_(is_cancelled) {
    stays_polygon_.resize(solid.facet_count());
    for (Index facet = 0; facet < solid.facet_count(); ++facet) {
      const bool is_apart = !is_taken_apart.empty() && is_taken_apart[facet];
      stays_polygon_[facet] = !is_apart && tessellate::is_flat(solid, facet);
      for_each_ring(facet, [&](const auto& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i)
          add_edge(ring[i], ring[(i + 1) % ring.size()]);
      });
    }
  }

  Result<ProtectedSolid> run() {
    const std::size_t given = points_.size();
    if (given > kMostGiven) {
      return Error{
          ErrorCode::limit_exceeded,
          "the edges of more than " + std::to_string(kMostGiven) + " vertices are not divided"};
    }
    const std::size_t most_points =
        given + std::min(kFewSteiner + kSteinerPerVertex * given, kMostSteiner);
    std::size_t inserted = 0;
    for (std::size_t round = 0; round < kMostRounds && points_.size() <= most_points; ++round) {
      const auto added = std::span(points_).subspan(inserted);
      const Status grown =
          delaunay_.insert(added, 4096 + kTetrahedraPerVertex * points_.size(), is_cancelled_);
      if (!grown) return grown.error();
      find_missing_parts(static_cast<Index>(std::exchange(inserted, points_.size())));
      if (missing_.empty()) return result(delaunay_.listed());
      if (Status divided = divide(); !divided) return divided.error();
    }
    return Error{ErrorCode::limit_exceeded, "the edges need more than " +
                                                std::to_string(most_points) + " vertices, or " +
                                                std::to_string(kMostRounds) + " rounds"};
  }

 private:
  struct Placed {
    Point point;
    double place = 0;  // on the whole edge: 0 at its first vertex, 1 at its second
  };
  struct Edge {
    Index first = kNone;  // the vertex with smaller coordinates
    Index second = kNone;
    std::vector<Index> steiner;
  };

  bool is_given(Index vertex) const { return vertex < solid_.vertex_count(); }

  /// The rings of a facet that stays a polygon, or the triangles of another one.
  template <class Function>
  void for_each_ring(Index facet, const Function& function) const {
    if (stays_polygon_[facet]) {
      const IndexRange rings = solid_.rings_of(facet);
      for (Index r = rings.begin; r < rings.end; ++r) function(solid_.ring(r));
    } else {
      for (Index t = triangles_.first[facet]; t < triangles_.first[facet + 1]; ++t) {
        function(triangles_.triangles[t]);
      }
    }
  }

  void add_edge(Index a, Index b) {
    if (points_[b] < points_[a]) std::swap(a, b);
    const auto [place, is_new] = edge_at_.try_emplace(pair_of(a, b), edges_.size());
    if (!is_new) return;
    parts_.emplace(pair_of(a, b), edges_.size());
    edges_.push_back({a, b, {}});
  }

  /// Parts of the vertices from `first_new` on are looked for. Another part was an edge, and can be
  /// missing only between two vertices with new neighbours.
  void find_missing_parts(Index first_new) {
    const std::vector<bool> is_changed = delaunay_.changed();
    missing_.clear();
    for (const auto& [part, edge] : parts_) {
      const auto [a, b] = part;
      const bool is_due = std::max(a, b) >= first_new || (is_changed[a] && is_changed[b]);
      if (is_due && !delaunay_.has_edge(a, b)) missing_.push_back(part);
    }
  }

  /// Divides missing parts of edges. Which vertices see a part does not depend on those put in
  /// before it.
  Status divide() {
    sort_by_x();
    for (const VertexPair& part : missing_) {
      if (cancellation_.is_wanted()) {
        return Error{ErrorCode::cancelled, "cancelled by the caller"};
      }
      const std::size_t edge = parts_.at(part);
      const std::optional<Placed> placed = place_on(part, edges_[edge]);
      if (!placed) {
        return Error{ErrorCode::limit_exceeded, "doubles have no point inside a part of an edge"};
      }
      const auto vertex = static_cast<Index>(points_.size());
      points_.push_back(placed->point);
      place_of_steiner_.push_back(placed->place);
      edges_[edge].steiner.push_back(vertex);
      parts_.erase(part);
      for (const Index end : part) parts_.emplace(pair_of(end, vertex), edge);
    }
    return Done{};
  }

  void sort_by_x() {
    by_x_.resize(points_.size());
    std::iota(by_x_.begin(), by_x_.end(), Index{0});
    std::sort(by_x_.begin(), by_x_.end(),
              [&](Index a, Index b) { return points_[a] < points_[b]; });
  }

  /// The vertex that sees a part of an edge under the largest angle, if that is obtuse; of equal
  /// ones the first by coordinates. Such vertices lie in the sphere around the part.
  Index seeing(const VertexPair& part) const {
    const Point& a = points_[part[0]];
    const Point& b = points_[part[1]];
    const double middle = (a.x + b.x) / 2;
    const double radius = std::sqrt(squared_distance(a, b)) / 2;
    auto at = std::lower_bound(by_x_.begin(), by_x_.end(), middle - radius,
                               [&](Index v, double x) { return points_[v].x < x; });
    double largest = 0;  // the squared cosine
    Index found = kNone;
    for (; at != by_x_.end() && points_[*at].x <= middle + radius; ++at) {
      if (*at == part[0] || *at == part[1]) continue;
      const Point& p = points_[*at];
      const double dot =
          (a.x - p.x) * (b.x - p.x) + (a.y - p.y) * (b.y - p.y) + (a.z - p.z) * (b.z - p.z);
      if (dot >= 0) continue;
      const double cosine = dot * dot / (squared_distance(a, p) * squared_distance(b, p));
      if (cosine <= largest) continue;
      largest = cosine;
      found = *at;
    }
    return found;
  }

  /// The share of a part, from its first end on, at which it is best divided: as far from an end as
  /// the vertex that sees it. Of two ends of different kind that is the one of the source, so that
  /// edges at a sharp corner are divided at equal distances.
  double best_share(Index first, Index second) const {
    const Index seen_by = seeing({first, second});
    if (seen_by == kNone) return 0.5;
    const double length = squared_distance(points_[first], points_[second]);
    const auto share_from = [&](Index end) {
      return std::sqrt(squared_distance(points_[end], points_[seen_by]) / length);
    };
    if (is_given(first) == is_given(second)) {
      const double one = share_from(first);
      const double other = share_from(second);
      if (std::min(one, other) < kLeastPlaceOfEqualEnds) return 0.5;
      if (one < 0.5) return one;
      return other < 0.5 ? 1 - other : 0.5;
    }
    const double share = share_from(is_given(first) ? first : second);
    if (share > kMostPlace || share < kLeastPlace) return 0.5;
    return is_given(first) ? share : 1 - share;
  }

  double place_of(Index vertex, const Edge& edge) const {
    if (!is_given(vertex)) return place_of_steiner_[vertex - solid_.vertex_count()];
    return vertex == edge.first ? 0 : 1;
  }

  std::optional<Placed> place_on(const VertexPair& part, const Edge& edge) const {
    auto [first, second] = part;
    if (points_[second] < points_[first]) std::swap(first, second);
    const double share = best_share(first, second);
    const double from = place_of(first, edge);
    const double to = place_of(second, edge);
    for (const double reach : kReaches) {
      const double about = reach * std::min(share, 1 - share);
      const double least = from + (share - about) * (to - from);
      const double most = from + (share + about) * (to - from);
      const std::optional<Placed> placed = simplest_place(edge, least, most);
      if (placed && placed->point != points_[first] && placed->point != points_[second] &&
          geometry::is_on_segment(points_[first], points_[second], placed->point)) {
        return placed;
      }
    }
    return std::nullopt;
  }

  /// The place in a range that has the fewest bits, and the point there, which may be rounded.
  std::optional<Placed> simplest_place(const Edge& edge, double least, double most) const {
    double step = 1;
    for (int bits = 1; bits <= kMostPlaceBits; ++bits) {
      step /= 2;
      const double place = std::ceil(least / step) * step;
      if (place > most) continue;
      const Point& p = points_[edge.first];
      const Point& q = points_[edge.second];
      return Placed{
          {p.x + (q.x - p.x) * place, p.y + (q.y - p.y) * place, p.z + (q.z - p.z) * place}, place};
    }
    return std::nullopt;
  }

  /// The Steiner vertices between two neighbours in a ring, in order.
  std::vector<Index> between(Index from, Index to) const {
    const Edge& edge = edges_[edge_at_.at(pair_of(from, to))];
    std::vector<Index> vertices = edge.steiner;
    std::sort(vertices.begin(), vertices.end(),
              [&](Index p, Index q) { return points_[p] < points_[q]; });
    if (from == edge.second) std::reverse(vertices.begin(), vertices.end());
    return vertices;
  }

  Result<ProtectedSolid> result(CanonicalDelaunay delaunay) const {
    SolidArrays arrays;
    arrays.vertices = points_;
    std::vector<Index> facet_of;
    const auto end_facet = [&](Index facet) {
      arrays.end_facet();
      facet_of.push_back(facet);
    };
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      for_each_ring(facet, [&](const auto& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
          arrays.ring_vertices.push_back(ring[i]);
          const std::vector<Index> added = between(ring[i], ring[(i + 1) % ring.size()]);
          arrays.ring_vertices.insert(arrays.ring_vertices.end(), added.begin(), added.end());
        }
        arrays.end_ring();
        if (!stays_polygon_[facet]) end_facet(facet);
      });
      if (stays_polygon_[facet]) end_facet(facet);
    }
    arrays.end_shell();
    Result<Solid> divided = Solid::make(std::move(arrays), solid_.lattice(), solid_.srid());
    if (!divided) return divided.error();
    return ProtectedSolid{*std::move(divided), std::move(facet_of), std::move(delaunay)};
  }

  const Solid& solid_;
  const tessellate::FacetTriangles& triangles_;
  GrowingDelaunay delaunay_;
  std::vector<VertexPair> missing_;  // the parts that are no edges
  std::vector<Point> points_;
  std::vector<double> place_of_steiner_;
  std::vector<bool> stays_polygon_;
  std::vector<Edge> edges_;
  std::map<VertexPair, std::size_t> edge_at_;
  std::map<VertexPair, std::size_t> parts_;  // part of an edge -> the number of the edge
  std::vector<Index> by_x_;                  // vertices in the order of their coordinates
  const CancelPoll& is_cancelled_;
  Cancellation cancellation_;
};

}  // namespace

Result<ProtectedSolid> protect_edges(const Solid& solid,
                                     const tessellate::FacetTriangles& triangles,
                                     const std::vector<bool>& is_taken_apart,
                                     const CancelPoll& is_cancelled) {
  return Protection(solid, triangles, is_taken_apart, is_cancelled).run();
}

}  // namespace watertight::delaunay
