// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/edge_loops.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "geometry/predicates/predicates.h"

namespace watertight::tessellate {
namespace {

/// Vertices in a projection in which rings run counterclockwise around what they bound.
class ProjectedVertices {
 public:
  ProjectedVertices(std::span<const Point> vertices, const Projection& projection)
      : vertices_(vertices), projection_(projection) {}

  /// +1 if a, b, c turn counterclockwise, 0 if they are on one line.
  int turn(Index a, Index b, Index c) const {
    const int turn = geometry::orient2d(vertices_[a], vertices_[b], vertices_[c], projection_.axis);
    return projection_.is_mirrored ? -turn : turn;
  }
  double first(Index vertex) const { return vertices_[vertex][(projection_.axis + 1) % 3]; }
  double second(Index vertex) const { return vertices_[vertex][(projection_.axis + 2) % 3]; }

  /// Whether two vertices on one line with a third are on the same side of it.
  bool are_on_one_side(Index middle, Index a, Index b) const {
    if (first(a) != first(middle)) return (first(a) > first(middle)) == (first(b) > first(middle));
    return (second(a) > second(middle)) == (second(b) > second(middle));
  }

  /// Where a way from `middle` comes when one turns clockwise from the way to `from`: 0 before half
  /// a turn, 1 after half a turn, 2 behind that, 3 after a whole turn.
  int quarter(Index middle, Index from, Index to) const {
    const int side = turn(middle, from, to);
    if (side != 0) return side < 0 ? 0 : 2;
    return are_on_one_side(middle, from, to) ? 3 : 1;
  }
  /// Whether one meets the way to `a` before that to `b`.
  bool is_before(Index middle, Index from, Index a, Index b) const {
    const int one = quarter(middle, from, a);
    const int other = quarter(middle, from, b);
    return one != other ? one < other : turn(middle, a, b) < 0;
  }

  /// Twice the area of a ring: only its sign, and which of two is larger, is used.
  double doubled_area(std::span<const Index> ring) const {
    const double x = first(ring.front());
    const double y = second(ring.front());
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Index a = ring[i];
      const Index b = ring[(i + 1) % ring.size()];
      sum += (first(a) - x) * (second(b) - y) - (first(b) - x) * (second(a) - y);
    }
    return projection_.is_mirrored ? -sum : sum;
  }

  /// +1 if a ring turns counterclockwise, by the exact turn at its least vertex.
  int turn_of(std::span<const Index> ring) const {
    std::size_t least = 0;
    const auto place = [&](std::size_t i) { return std::pair(first(ring[i]), second(ring[i])); };
    for (std::size_t i = 1; i < ring.size(); ++i) {
      if (place(i) < place(least)) least = i;
    }
    const std::size_t size = ring.size();
    return turn(ring[(least + size - 1) % size], ring[least], ring[(least + 1) % size]);
  }

  /// +1 if a vertex is inside a ring, 0 if on it, -1 if outside.
  int locate(Index vertex, std::span<const Index> ring) const {
    bool is_inside = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Index a = ring[i];
      const Index b = ring[(i + 1) % ring.size()];
      if (vertex == a) return 0;
      const int side =
          geometry::orient2d(vertices_[a], vertices_[b], vertices_[vertex], projection_.axis);
      if (side == 0 && !are_on_one_side(vertex, a, b)) return 0;
      const bool is_above = second(a) > second(vertex);
      if (is_above == (second(b) > second(vertex))) continue;
      if ((side > 0) != is_above) is_inside = !is_inside;
    }
    return is_inside ? 1 : -1;
  }

 private:
  std::span<const Point> vertices_;
  Projection projection_;
};

/// Walks along edges that are not used yet.
class LoopWalk {
 public:
  LoopWalk(std::span<const DirectedEdge> edges, const ProjectedVertices& vertices)
      : edges_(edges), vertices_(vertices), is_used_(edges.size()) {}

  /// The rings of all edges; nothing where a way has no end.
  std::optional<std::vector<std::vector<Index>>> rings() {
    std::vector<std::vector<Index>> rings;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (!is_used_[i] && !walk_from(i, rings)) return std::nullopt;
    }
    return rings;
  }

 private:
  /// The unused edge that bounds the same corner as one that has come from `from`: the first one
  /// clockwise. The number of edges if there is none.
  std::size_t next_edge(Index from, Index at) const {
    const auto starts = [](const DirectedEdge& edge, Index vertex) { return edge[0] < vertex; };
    std::size_t best = edges_.size();
    for (auto edge = std::lower_bound(edges_.begin(), edges_.end(), at, starts);
         edge != edges_.end() && (*edge)[0] == at; ++edge) {
      const auto i = static_cast<std::size_t>(edge - edges_.begin());
      if (is_used_[i]) continue;
      if (best == edges_.size() || vertices_.is_before(at, from, (*edge)[1], edges_[best][1])) {
        best = i;
      }
    }
    return best;
  }

  /// Adds the rings of the boundary along an edge. A vertex that comes again ends a ring. False if
  /// the boundary does not come back.
  bool walk_from(std::size_t edge, std::vector<std::vector<Index>>& rings) {
    std::vector<Index> way{edges_[edge][0]};
    std::unordered_map<Index, std::size_t> place{{way.front(), 0}};
    while (edge != edges_.size()) {
      is_used_[edge] = true;
      const auto [from, at] = edges_[edge];
      const auto [seen, is_new] = place.try_emplace(at, way.size());
      if (is_new) {
        way.push_back(at);
      } else {
        const auto start = way.begin() + static_cast<std::ptrdiff_t>(seen->second);
        rings.emplace_back(start, way.end());
        for (auto vertex = start + 1; vertex != way.end(); ++vertex) place.erase(*vertex);
        way.erase(start + 1, way.end());
        if (way.size() == 1) return true;
      }
      edge = next_edge(from, at);
    }
    return false;
  }

  std::span<const DirectedEdge> edges_;
  const ProjectedVertices& vertices_;
  std::vector<bool> is_used_;
};

/// The facet that a hole is in: the smallest exterior ring around one of its vertices.
std::size_t facet_around(const std::vector<Index>& hole, const std::vector<LoopedFacet>& facets,
                         const ProjectedVertices& vertices) {
  std::size_t best = facets.size();
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const std::vector<Index>& exterior = facets[i].front();
    int place = 0;
    for (std::size_t k = 0; k < hole.size() && place == 0; ++k) {
      place = vertices.locate(hole[k], exterior);
    }
    if (place < 0) continue;
    if (best == facets.size() ||
        vertices.doubled_area(exterior) < vertices.doubled_area(facets[best].front())) {
      best = i;
    }
  }
  return best;
}

}  // namespace

void cancel_opposite_edges(std::vector<DirectedEdge>& edges) {
  const auto key = [](const DirectedEdge& edge) {
    return std::pair(std::min(edge[0], edge[1]), std::max(edge[0], edge[1]));
  };
  std::erase_if(edges, [](const DirectedEdge& edge) { return edge[0] == edge[1]; });
  std::ranges::sort(edges, [&](const DirectedEdge& a, const DirectedEdge& b) {
    return std::pair(key(a), a) < std::pair(key(b), b);
  });
  std::vector<DirectedEdge> left;
  for (const DirectedEdge& edge : edges) {
    // Edges along one line are in the order of their directions: an opposite one is at the end.
    if (!left.empty() && left.back() == DirectedEdge{edge[1], edge[0]}) {
      left.pop_back();
    } else {
      left.push_back(edge);
    }
  }
  std::ranges::sort(left);
  edges = std::move(left);
}

Result<std::vector<LoopedFacet>> facets_of_edges(std::span<const DirectedEdge> edges,
                                                 std::span<const Point> vertices,
                                                 const Projection& projection) {
  const ProjectedVertices projected(vertices, projection);
  std::vector<LoopedFacet> facets;
  std::vector<std::vector<Index>> holes;
  auto rings = LoopWalk(edges, projected).rings();
  if (!rings) return Error{ErrorCode::malformed, "edges do not close"};
  for (std::vector<Index>& ring : *rings) {
    if (ring.size() == 2) continue;
    const int turn = projected.turn_of(ring);
    if (turn == 0) return Error{ErrorCode::malformed, "edges bound nothing"};
    if (turn > 0) {
      facets.push_back({std::move(ring)});
    } else {
      holes.push_back(std::move(ring));
    }
  }
  for (std::vector<Index>& hole : holes) {
    const std::size_t facet = facet_around(hole, facets, projected);
    if (facet == facets.size()) return Error{ErrorCode::malformed, "a hole is in no facet"};
    facets[facet].push_back(std::move(hole));
  }
  return facets;
}

}  // namespace watertight::tessellate
