// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstddef>
#include <memory_resource>
#include <numeric>
#include <set>
#include <utility>

#include "base/work_memory.h"
#include "tessellate/trimmed/plane_predicates.h"
#include "tessellate/trimmed/region.h"

namespace watertight::tessellate {
namespace {

// An edge that the sweep line meets. A trapezoid lies between two neighbours, from one vertex of
// the sweep to the next that lies between them. The trapezoids beside an edge, on the side of the
// region, make a piece with one monotone chain: their vertices. The piece is triangulated while the
// chain grows; `top` leads to the vertices that have no triangle yet.
struct SweepEdge {
  Index lower = kNone;
  Index upper = kNone;
  bool is_region_left = false;  // seen upwards
  Index top = kNone;            // the last link of the chain
};

struct ChainLink {
  Index vertex = kNone;
  Index before = kNone;
};

class Sweep {
 public:
  explicit Sweep(const Region& region)
      : region_(region), points_(region.points), status_(Order{*this}, memory_.get()) {}

  RegionTriangles run() {
    if (prepare()) {
      for (const Index vertex : order_) {
        if (!visit(vertex)) break;
      }
    }
    if (result_.conflict) result_.triangles.clear();
    return std::move(result_);
  }

 private:
  struct Active {
    mutable Index edge;
  };
  // Edges from left to right along the sweep line, compared with a vertex of it.
  struct Order {
    using is_transparent = void;
    const Sweep& sweep;
    bool operator()(const Active& a, const Active& b) const {
      const SweepEdge& left = sweep.edges_[a.edge];
      const SweepEdge& right = sweep.edges_[b.edge];
      if (left.lower == right.lower) {
        return sweep.turn_at(left.lower, left.upper, right.upper) < 0;
      }
      if (is_below(sweep.points_[left.lower], sweep.points_[right.lower])) {
        return sweep.side(a.edge, right.lower) < 0;
      }
      return sweep.side(b.edge, left.lower) > 0;
    }
    bool operator()(const Active& a, Index vertex) const { return sweep.side(a.edge, vertex) < 0; }
  };
  using Status = std::pmr::set<Active, Order>;
  template <class T>
  using Vector = std::pmr::vector<T>;

  int turn_at(Index a, Index b, Index c) const { return turn(points_[a], points_[b], points_[c]); }
  /// +1 if the vertex is left of the edge, seen upwards.
  int side(Index edge, Index vertex) const {
    return turn_at(edges_[edge].lower, edges_[edge].upper, vertex);
  }

  bool conflict(RegionConflict::Kind kind, PlaneEdge first, PlaneEdge second = {kNone, kNone}) {
    result_.conflict = {kind, first, second};
    return false;
  }
  PlaneEdge ends_of(Index edge) const { return {edges_[edge].lower, edges_[edge].upper}; }

  bool prepare() {
    edges_.reserve(region_.edges.size());
    order_.resize(points_.size());
    std::iota(order_.begin(), order_.end(), Index{0});
    std::sort(order_.begin(), order_.end(),
              [&](Index a, Index b) { return is_below(points_[a], points_[b]); });
    for (std::size_t i = 1; i < order_.size(); ++i) {
      const Point& p = points_[order_[i - 1]];
      const Point& q = points_[order_[i]];
      if (p.x == q.x && p.y == q.y) {
        const auto [a, b] = std::minmax(order_[i - 1], order_[i]);
        return conflict(RegionConflict::Kind::equal, {a, kNone}, {b, kNone});
      }
    }
    first_start_.assign(points_.size() + 1, 0);
    first_end_.assign(points_.size() + 1, 0);
    balance_.assign(points_.size(), 0);
    for (const auto& [from, to] : region_.edges) {
      if (from == to) return conflict(RegionConflict::Kind::equal, {from, to}, {from, to});
      const bool goes_up = is_below(points_[from], points_[to]);
      edges_.push_back({goes_up ? from : to, goes_up ? to : from, goes_up, kNone});
      ++first_start_[edges_.back().lower + 1];
      ++first_end_[edges_.back().upper + 1];
      ++balance_[from];
      --balance_[to];
    }
    for (Index vertex = 0; vertex < points_.size(); ++vertex) {
      if (balance_[vertex] != 0) return conflict(RegionConflict::Kind::not_closed, {vertex, kNone});
    }
    group_edges();
    result_.triangles.reserve(points_.size() + edges_.size() / 2);
    links_.reserve(2 * points_.size());
    return true;
  }

  /// Lists the edges that begin, and those that end, at each vertex.
  void group_edges() {
    std::partial_sum(first_start_.begin(), first_start_.end(), first_start_.begin());
    std::partial_sum(first_end_.begin(), first_end_.end(), first_end_.begin());
    starting_.resize(edges_.size());
    ending_.resize(edges_.size());
    place_.resize(edges_.size());
    Vector<Index> start(first_start_.begin(), first_start_.end() - 1, memory_.get());
    Vector<Index> end(first_end_.begin(), first_end_.end() - 1, memory_.get());
    for (Index edge = 0; edge < edges_.size(); ++edge) {
      starting_[start[edges_[edge].lower]++] = edge;
      ending_[end[edges_[edge].upper]++] = edge;
    }
  }

  bool visit(Index vertex) {
    const std::span<const Index> ends(ending_.data() + first_end_[vertex],
                                      ending_.data() + first_end_[vertex + 1]);
    const std::span<Index> starts(starting_.data() + first_start_[vertex],
                                  starting_.data() + first_start_[vertex + 1]);
    auto first = status_.end();  // the first edge that ends here, or the one right of the vertex
    auto right = status_.end();
    if (ends.empty()) {
      first = right = status_.lower_bound(vertex);
    } else if (!find_ending(vertex, ends, first, right)) {
      return false;
    }
    if (!is_between(vertex, ends, starts, first, right)) return false;
    if (!sort_starting(vertex, starts)) return false;
    if (!agrees_on_sides(vertex, starts, first, right)) return false;
    close_trapezoids(vertex, first, right);
    replace(ends.size(), starts, first, right);
    for (const Index edge : starts) push(edge, vertex);
    return true;
  }

  /// Finds the edges that end at a vertex, which are neighbours: [first, right).
  bool find_ending(Index vertex, std::span<const Index> ends, Status::iterator& first,
                   Status::iterator& right) {
    const auto ends_here = [&](Status::iterator at) { return edges_[at->edge].upper == vertex; };
    first = place_[ends.front()];
    right = std::next(first);
    std::size_t count = 1;
    for (; first != status_.begin() && ends_here(std::prev(first)); --first) ++count;
    for (; right != status_.end() && ends_here(right); ++right) ++count;
    if (count == ends.size()) return true;
    // An edge of another vertex stands between two edges that end here, so it crosses one of them.
    const auto other = right != status_.end() ? right : std::prev(first);
    return conflict(RegionConflict::Kind::crossing, ends_of(ends.front()), ends_of(other->edge));
  }

  /// True if the vertex is strictly between its neighbours. A crossing of two edges is noticed at
  /// the latest where one of them ends: there the other one is its neighbour, on the wrong side.
  bool is_between(Index vertex, std::span<const Index> ends, std::span<const Index> starts,
                  Status::iterator first, Status::iterator right) {
    const auto blocked_by = [&](Index edge) {
      const PlaneEdge own = !ends.empty()     ? ends_of(ends.front())
                            : !starts.empty() ? ends_of(starts.front())
                                              : PlaneEdge{vertex, vertex};
      return conflict(RegionConflict::Kind::crossing, own, ends_of(edge));
    };
    if (right != status_.end() && side(right->edge, vertex) <= 0) return blocked_by(right->edge);
    if (first != status_.begin() && side(std::prev(first)->edge, vertex) >= 0) {
      return blocked_by(std::prev(first)->edge);
    }
    return true;
  }

  bool sort_starting(Index vertex, std::span<Index> starts) {
    std::sort(starts.begin(), starts.end(), [&](Index a, Index b) {
      return turn_at(vertex, edges_[a].upper, edges_[b].upper) < 0;
    });
    for (std::size_t i = 1; i < starts.size(); ++i) {
      if (turn_at(vertex, edges_[starts[i - 1]].upper, edges_[starts[i]].upper) >= 0) {
        return conflict(RegionConflict::Kind::crossing, ends_of(starts[i - 1]), ends_of(starts[i]));
      }
    }
    return true;
  }

  /// True if neighbours above the vertex agree whether the region is between them.
  bool agrees_on_sides(Index vertex, std::span<const Index> starts, Status::iterator first,
                       Status::iterator right) {
    Index left = first != status_.begin() ? std::prev(first)->edge : kNone;
    if (starts.empty() && first == right && !is_region_between(left)) {
      return conflict(RegionConflict::Kind::outside, {vertex, kNone});
    }
    const auto agree = [&](Index edge) {
      const bool is_region = edge != kNone && edges_[edge].is_region_left;
      if (is_region == is_region_between(left)) return true;
      const PlaneEdge none{kNone, kNone};
      return conflict(RegionConflict::Kind::side, left != kNone ? ends_of(left) : none,
                      edge != kNone ? ends_of(edge) : none);
    };
    for (const Index edge : starts) {
      if (!agree(edge)) return false;
      left = edge;
    }
    return agree(right != status_.end() ? right->edge : kNone);
  }

  /// Whether the region is on the right of an edge; kNone is left of all edges.
  bool is_region_between(Index left) const { return left != kNone && !edges_[left].is_region_left; }

  /// Ends the trapezoids between the neighbours of a vertex and the edges that end there.
  void close_trapezoids(Index vertex, Status::iterator first, Status::iterator right) {
    if (first != status_.begin()) {
      const Index left = std::prev(first)->edge;
      if (!edges_[left].is_region_left) push(left, vertex);
    }
    for (; first != right; ++first) push(first->edge, vertex);
    if (right != status_.end() && edges_[right->edge].is_region_left) push(right->edge, vertex);
  }

  /// Puts the edges that begin into the place of those that end.
  void replace(std::size_t ended, std::span<const Index> starts, Status::iterator first,
               Status::iterator right) {
    std::size_t reused = 0;
    while (reused < std::min(ended, starts.size())) {
      first->edge = starts[reused];
      place_[starts[reused++]] = first++;
    }
    while (first != right) first = status_.erase(first);
    for (; reused < starts.size(); ++reused) {
      place_[starts[reused]] = status_.insert(right, Active{starts[reused]});
    }
  }

  /// Adds a vertex to the chain of an edge, and makes the triangles of the chain that it sees.
  void push(Index edge, Index vertex) {
    Index top = edges_[edge].top;
    const bool is_left = edges_[edge].is_region_left;
    while (top != kNone && links_[top].before != kNone) {
      const Index last = links_[top].vertex;
      const Index before = links_[links_[top].before].vertex;
      const int bend = turn_at(before, last, vertex);
      if (is_left ? bend >= 0 : bend <= 0) break;
      if (is_left) {
        result_.triangles.push_back({before, vertex, last});
      } else {
        result_.triangles.push_back({before, last, vertex});
      }
      top = links_[top].before;
    }
    edges_[edge].top = static_cast<Index>(links_.size());
    links_.push_back({vertex, top});
  }

  const Region& region_;
  std::span<const Point> points_;
  WorkMemory memory_;
  Vector<SweepEdge> edges_{memory_.get()};
  Vector<Index> order_{memory_.get()};  // vertices from below
  Vector<Index> first_start_{memory_.get()};
  Vector<Index> first_end_{memory_.get()};
  Vector<Index> starting_{memory_.get()};  // edges by their lower vertex
  Vector<Index> ending_{memory_.get()};    // edges by their upper vertex
  Vector<int> balance_{memory_.get()};     // vertex -> edges that begin there less those that end
  Status status_;
  // Edge -> where it stands among those that the line meets.
  Vector<Status::iterator> place_{memory_.get()};
  Vector<ChainLink> links_{memory_.get()};
  RegionTriangles result_;
};

}  // namespace

RegionTriangles sweep_region(const Region& region) { return Sweep(region).run(); }

RegionTriangles sweep_region_from_left(Region region) {
  // The mirror image: u and v exchanged, and each edge in the other direction.
  for (Point& p : region.points) std::swap(p.x, p.y);
  for (PlaneEdge& edge : region.edges) std::swap(edge[0], edge[1]);
  RegionTriangles result = sweep_region(region);
  for (Triangle& triangle : result.triangles) std::swap(triangle[1], triangle[2]);
  return result;
}

}  // namespace watertight::tessellate
