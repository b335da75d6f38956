// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/ring_problems.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include <CGAL/Exact_rational.h>

#include "geometry/divided_rings.h"
#include "geometry/predicates/predicates.h"

namespace watertight::tessellate {
namespace {

/// The largest number of pairs of edges that are examined in a facet; with more pairs the list of
/// problems is not complete. About one second of work.
constexpr std::uint64_t kMostPairs = 20'000'000;

struct Edge {
  Index ring = 0;      // the index of the ring in the facet
  Index position = 0;  // the index, in the divided ring, of the vertex where the edge starts
  Index from = 0;
  Index to = 0;
  std::array<double, 2> min{};
  std::array<double, 2> max{};
};

struct Contact {
  Point witness;
  bool is_at_shared_vertex = false;  // true if the edges have only an end vertex in common
};

class RingExaminer {
 public:
  RingExaminer(const Solid& solid, Index facet, std::size_t most, const CancelPoll& cancel)
      : solid_(solid),
        vertices_(solid.vertices()),
        rings_(solid.rings_of(facet)),
        most_(most),
        cancel_(cancel) {
    divide(facet);
  }

  RingProblems examine(Index facet);

 private:
  void divide(Index facet);
  std::span<const Index> ring(Index number) const { return divided_[number].vertices; }
  bool choose_axis(Index facet);
  void measure_boxes();
  bool are_apart(Index a, Index b) const;
  void find_collapsed();
  void find_same();
  void collect_edges();
  void find_contacts();
  void examine_pair(const Edge& a, const Edge& b);
  std::optional<Contact> neighbour_contact(const Edge& a, const Edge& b) const;
  std::optional<Contact> contact(const Edge& a, const Edge& b) const;
  Point crossing(const Edge& a, const Edge& b) const;
  void find_nesting();
  std::optional<bool> is_within(Index inner, Index outer, bool& is_mixed) const;
  int side_of_ring(const Point& p, std::span<const Index> around) const;
  void keep_one_of_each_contact();
  void add(RingProblem problem);
  bool goes_on(std::size_t steps);

  double u(Index vertex) const { return vertices_[vertex][(axis_ + 1) % 3]; }
  double v(Index vertex) const { return vertices_[vertex][(axis_ + 2) % 3]; }
  bool is_same_in_plane(Index a, Index b) const { return u(a) == u(b) && v(a) == v(b); }
  /// The turn from ab to bc in the projection: 0 if two of the projected points are the same.
  int turn(Index a, Index b, Index c) const {
    if (is_same_in_plane(a, b) || is_same_in_plane(b, c) || is_same_in_plane(a, c)) return 0;
    return geometry::orient2d(vertices_[a], vertices_[b], vertices_[c], axis_);
  }
  /// True if q lies on the edge. Requires q on the line of the edge.
  bool is_between(Index q, const Edge& e) const {
    return e.min[0] <= u(q) && u(q) <= e.max[0] && e.min[1] <= v(q) && v(q) <= e.max[1];
  }

  const Solid& solid_;
  std::span<const Point> vertices_;
  IndexRange rings_;
  std::size_t most_;
  const CancelPoll& cancel_;
  std::size_t steps_ = 0;  // the number of steps since the last call of cancel_
  int axis_ = 2;
  struct Box {
    std::array<double, 2> min{};
    std::array<double, 2> max{};
  };
  /// A ring with the vertices that split its edges.
  struct DividedRing {
    std::vector<Index> vertices;
    std::vector<Index> position_of;  // the index, in the submitted ring, of the undivided edge
  };
  std::vector<DividedRing> divided_;
  std::vector<Edge> edges_;
  std::vector<Box> boxes_;         // the box of each ring in the plane of projection
  std::vector<bool> is_left_out_;  // ring -> whether it is short, collapsed or a duplicate
  RingProblems result_;
};

void RingExaminer::divide(Index facet) {
  const std::vector<geometry::RingTouch> touches =
      geometry::ring_touches(solid_, std::span(&facet, 1));
  auto touch = touches.begin();
  divided_.resize(rings_.size());
  for (Index r = 0; r < rings_.size(); ++r) {
    DividedRing& divided = divided_[r];
    const std::span<const Index> corners = solid_.ring(rings_.begin + r);
    const Index first = solid_.arrays().ring_offsets[rings_.begin + r];
    for (Index i = 0; i < corners.size(); ++i) {
      divided.vertices.push_back(corners[i]);
      for (; touch != touches.end() && touch->corner == first + i; ++touch) {
        divided.vertices.push_back(touch->vertex);
      }
      divided.position_of.resize(divided.vertices.size(), i);
    }
  }
}

/// Chooses the axis of the facet's projection or, if the facet has no area, an axis along which the
/// projection of a ring has a turn. False if there is none.
bool RingExaminer::choose_axis(Index facet) {
  const Projection projection = facet_projection(solid_, facet);
  axis_ = projection.axis;
  if (!projection.is_degenerate) return true;
  for (Index r = 0; r < rings_.size(); ++r) {
    if (is_left_out_[r]) continue;
    const std::span<const Index> corners = ring(r);
    for (axis_ = 0; axis_ < 3; ++axis_) {
      for (std::size_t i = 2; i < corners.size(); ++i) {
        if (turn(corners[i - 2], corners[i - 1], corners[i]) != 0) return true;
      }
    }
  }
  axis_ = 2;
  return false;
}

void RingExaminer::add(RingProblem problem) {
  if (result_.problems.size() < most_) {
    result_.problems.push_back(problem);
  } else {
    result_.is_complete = false;
  }
}

/// False if the search is cancelled; the list of problems is then not complete.
bool RingExaminer::goes_on(std::size_t steps) {
  constexpr std::size_t kAskInterval = std::size_t{1} << 16U;
  steps_ += steps;
  if (steps_ < kAskInterval) return true;
  steps_ = 0;
  if (!cancel_ || !cancel_()) return true;
  result_.is_complete = false;
  return false;
}

void RingExaminer::find_collapsed() {
  is_left_out_.assign(rings_.size(), false);
  for (Index r = 0; r < rings_.size(); ++r) {
    const std::span<const Index> corners = ring(r);
    if (corners.size() < 3) {
      is_left_out_[r] = true;
      continue;
    }
    const Index first = corners[0];
    const auto second =
        std::find_if(corners.begin(), corners.end(), [&](Index vertex) { return vertex != first; });
    const bool is_line = std::all_of(second, corners.end(), [&](Index vertex) {
      return vertex == first || vertex == *second ||
             geometry::are_collinear(vertices_[first], vertices_[*second], vertices_[vertex]);
    });
    if (!is_line) continue;
    is_left_out_[r] = true;
    add({RingProblemKind::collapsed, r, kNone, kNone, kNone, vertices_[first]});
  }
}

void RingExaminer::find_same() {
  std::vector<std::pair<std::vector<Index>, Index>> sorted;
  for (Index r = 0; r < rings_.size(); ++r) {
    if (is_left_out_[r]) continue;
    std::vector<Index> corners(ring(r).begin(), ring(r).end());
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(std::move(corners), r);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first != sorted[i - 1].first) continue;
    const Index r = sorted[i].second;
    is_left_out_[r] = true;
    add({RingProblemKind::same_ring, r, kNone, sorted[i - 1].second, kNone,
         vertices_[ring(r).front()]});
  }
}

void RingExaminer::collect_edges() {
  for (Index r = 0; r < rings_.size(); ++r) {
    if (is_left_out_[r]) continue;
    const std::span<const Index> corners = ring(r);
    for (Index i = 0; i < corners.size(); ++i) {
      Edge edge;
      edge.ring = r;
      edge.position = i;
      edge.from = corners[i];
      edge.to = corners[(i + 1) % corners.size()];
      if (edge.from == edge.to) continue;
      std::tie(edge.min[0], edge.max[0]) = std::minmax({u(edge.from), u(edge.to)});
      std::tie(edge.min[1], edge.max[1]) = std::minmax({v(edge.from), v(edge.to)});
      edges_.push_back(edge);
    }
  }
}

void RingExaminer::find_contacts() {
  std::vector<std::size_t> order(edges_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(edges_[a].min[0], a) < std::tie(edges_[b].min[0], b);
  });
  std::vector<std::size_t> active;
  std::uint64_t pairs = 0;
  for (const std::size_t number : order) {
    const Edge& edge = edges_[number];
    std::erase_if(active, [&](std::size_t a) { return edges_[a].max[0] < edge.min[0]; });
    pairs += active.size();
    if (pairs > kMostPairs) result_.is_complete = false;
    if (!goes_on(active.size() + 1)) return;
    for (const std::size_t a : active) {
      // To compute the exact witnesses of problems that are not reported could take hours.
      if (!result_.is_complete) return;
      const Edge& other = edges_[a];
      if (other.max[1] < edge.min[1] || edge.max[1] < other.min[1]) continue;
      if (a < number) {
        examine_pair(other, edge);
      } else {
        examine_pair(edge, other);
      }
    }
    active.push_back(number);
  }
}

/// Adds the problem of two edges, if they have one. Requires a before b in facet order.
void RingExaminer::examine_pair(const Edge& a, const Edge& b) {
  const bool is_same_ring = a.ring == b.ring;
  const bool are_neighbours =
      is_same_ring && (a.to == b.from || b.to == a.from) &&
      (a.position + 1 == b.position || (a.position == 0 && b.position + 1 == ring(b.ring).size()));
  const std::optional<Contact> found = are_neighbours ? neighbour_contact(a, b) : contact(a, b);
  if (!found || (!is_same_ring && found->is_at_shared_vertex)) return;
  add({is_same_ring ? RingProblemKind::self_contact : RingProblemKind::rings_meet, a.ring,
       a.position, b.ring, b.position, found->witness});
}

/// The contact of neighbouring edges beyond their common vertex: they have one if they lie on each
/// other.
std::optional<Contact> RingExaminer::neighbour_contact(const Edge& a, const Edge& b) const {
  // The positions decide which end is the joint: where a ring runs to a point and back, the edges
  // have both ends in common.
  const Index joint = a.position + 1 == b.position ? a.to : a.from;
  const Index end_of_a = a.to == joint ? a.from : a.to;
  const Index end_of_b = b.to == joint ? b.from : b.to;
  if (turn(end_of_a, joint, end_of_b) != 0) return std::nullopt;
  std::optional<Contact> found;
  for (const auto& [end, edge] : {std::pair(end_of_a, &b), std::pair(end_of_b, &a)}) {
    if (!is_between(end, *edge)) continue;
    if (!found || vertices_[end] < found->witness) found = Contact{vertices_[end], false};
  }
  return found;
}

std::optional<Contact> RingExaminer::contact(const Edge& a, const Edge& b) const {
  const int from_a = turn(b.from, b.to, a.from);
  const int to_a = turn(b.from, b.to, a.to);
  if (from_a * to_a > 0) return std::nullopt;
  const int from_b = turn(a.from, a.to, b.from);
  const int to_b = turn(a.from, a.to, b.to);
  if (from_b * to_b > 0) return std::nullopt;
  if (from_a * to_a < 0 && from_b * to_b < 0) {
    // The edge with the smaller ends gets the witness, so that it does not depend on the order of
    // the source.
    const auto ends = [&](const Edge& e) {
      return std::minmax(vertices_[e.from], vertices_[e.to]);
    };
    return Contact{ends(a) <= ends(b) ? crossing(a, b) : crossing(b, a), false};
  }

  // An end of one edge lies on the other edge or at least on its line.
  std::vector<Index> ends;
  if (from_a == 0 && is_between(a.from, b)) ends.push_back(a.from);
  if (to_a == 0 && is_between(a.to, b)) ends.push_back(a.to);
  if (from_b == 0 && is_between(b.from, a)) ends.push_back(b.from);
  if (to_b == 0 && is_between(b.to, a)) ends.push_back(b.to);
  if (ends.empty()) return std::nullopt;
  const auto is_end_of = [](Index vertex, const Edge& e) {
    return vertex == e.from || vertex == e.to;
  };
  const bool is_one_vertex =
      std::all_of(ends.begin(), ends.end(), [&](Index end) { return end == ends.front(); });
  const Index end = *std::min_element(
      ends.begin(), ends.end(), [&](Index x, Index y) { return vertices_[x] < vertices_[y]; });
  return Contact{vertices_[end], is_one_vertex && is_end_of(end, a) && is_end_of(end, b)};
}

/// The exact point of edge a in which the edges cross, rounded once per coordinate. Requires edges
/// of which each has its ends on different sides of the other.
Point RingExaminer::crossing(const Edge& a, const Edge& b) const {
  using Number = CGAL::Exact_rational;
  const auto area = [&](Index p) -> Number {  // a value: gmpxx would return references
    return (Number(u(b.to)) - Number(u(b.from))) * (Number(v(p)) - Number(v(b.from))) -
           (Number(v(b.to)) - Number(v(b.from))) * (Number(u(p)) - Number(u(b.from)));
  };
  const Number from = area(a.from);
  const Number parameter = from / (from - area(a.to));
  Point witness;
  for (int axis = 0; axis < 3; ++axis) {
    const Number start(vertices_[a.from][axis]);
    const Number way = Number(vertices_[a.to][axis]) - start;
    witness[axis] = CGAL::to_double(Number(start + parameter * way)) + 0.0;
  }
  return witness;
}

/// +1 if the point is inside a ring, -1 if outside, 0 if on the ring: decided by the parity of the
/// crossings of a ray along +u.
int RingExaminer::side_of_ring(const Point& p, std::span<const Index> around) const {
  const double pu = p[(axis_ + 1) % 3];
  const double pv = p[(axis_ + 2) % 3];
  bool is_inside = false;
  Index from = around.back();
  for (const Index to : around) {
    if (u(to) == pu && v(to) == pv) return 0;
    const bool is_level = v(from) == pv && v(to) == pv;
    if (is_level && std::min(u(from), u(to)) < pu && pu < std::max(u(from), u(to))) return 0;
    if ((v(from) > pv) != (v(to) > pv)) {
      const int side = u(from) == pu && v(from) == pv
                           ? 0
                           : geometry::orient2d(vertices_[from], vertices_[to], p, axis_);
      if (side == 0) return 0;
      if ((side > 0) == (v(to) > v(from))) is_inside = !is_inside;
    }
    from = to;
  }
  return is_inside ? 1 : -1;
}

/// True if ring `inner` lies within ring `outer`, false if outside of it, nothing if all points
/// tried are on `outer`. `is_mixed` becomes true if parts of `inner` lie on both sides of `outer`.
std::optional<bool> RingExaminer::is_within(Index inner, Index outer, bool& is_mixed) const {
  const std::span<const Index> corners = ring(inner);
  std::optional<bool> result;
  is_mixed = false;
  const auto note = [&](int side) {
    if (side == 0) return;
    if (result && *result != (side > 0)) is_mixed = true;
    result = side > 0;
  };
  for (const Index vertex : corners) note(side_of_ring(vertices_[vertex], ring(outer)));
  Index from = corners.back();
  for (const Index to : corners) {
    Point middle;
    bool is_exact = true;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = vertices_[from][axis];
      const double b = vertices_[to][axis];
      middle[axis] = a + (b - a) / 2;
      is_exact = is_exact && middle[axis] - a == b - middle[axis] && (b - a) + a == b;
    }
    if (is_exact) note(side_of_ring(middle, ring(outer)));
    from = to;
  }
  return result;
}

void RingExaminer::measure_boxes() {
  boxes_.assign(rings_.size(), Box{});
  for (Index r = 0; r < rings_.size(); ++r) {
    Box& box = boxes_[r];
    const std::span<const Index> corners = ring(r);
    if (corners.empty()) continue;
    box.min = box.max = {u(corners[0]), v(corners[0])};
    for (const Index corner : corners) {
      box.min = {std::min(box.min[0], u(corner)), std::min(box.min[1], v(corner))};
      box.max = {std::max(box.max[0], u(corner)), std::max(box.max[1], v(corner))};
    }
  }
}

bool RingExaminer::are_apart(Index a, Index b) const {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (boxes_[a].max[axis] < boxes_[b].min[axis]) return true;
    if (boxes_[b].max[axis] < boxes_[a].min[axis]) return true;
  }
  return false;
}

/// Finds interior rings outside the exterior ring or inside another. Requires rings that have at
/// most vertices in common.
void RingExaminer::find_nesting() {
  measure_boxes();
  for (Index inner = 1; inner < rings_.size(); ++inner) {
    if (is_left_out_[inner]) continue;
    const Point& witness = vertices_[ring(inner).front()];
    for (Index outer = 0; outer < rings_.size(); ++outer) {
      if (outer == inner || is_left_out_[outer]) continue;
      if (!goes_on(1)) return;
      if (outer != 0 && are_apart(inner, outer)) continue;
      if (!goes_on(ring(inner).size() * ring(outer).size())) return;
      bool is_mixed = false;
      const std::optional<bool> within = is_within(inner, outer, is_mixed);
      if (is_mixed) {
        if (outer < inner) add({RingProblemKind::rings_meet, inner, kNone, outer, kNone, witness});
      } else if (within && outer == 0 && !*within) {
        add({RingProblemKind::outside_exterior, inner, kNone, outer, kNone, witness});
      } else if (within && outer != 0 && *within) {
        add({RingProblemKind::nested, inner, kNone, outer, kNone, witness});
      }
    }
  }
}

/// Each pair of edges that meet in a point of the plane of projection has added a problem there.
/// Keeps the first of these problems, with the smallest witness of all. Requires sorted problems.
void RingExaminer::keep_one_of_each_contact() {
  using Key = std::tuple<RingProblemKind, Index, Index, double, double>;
  std::map<Key, std::size_t> kept_at;
  std::vector<RingProblem> kept;
  for (const RingProblem& p : result_.problems) {
    if (p.kind == RingProblemKind::self_contact || p.kind == RingProblemKind::rings_meet) {
      const Key key{p.kind, p.ring, p.other_ring, p.witness[(axis_ + 1) % 3],
                    p.witness[(axis_ + 2) % 3]};
      const auto [place, is_new] = kept_at.try_emplace(key, kept.size());
      if (!is_new) {
        Point& witness = kept[place->second].witness;
        witness = std::min(witness, p.witness);
        continue;
      }
    }
    kept.push_back(p);
  }
  result_.problems = std::move(kept);
}

RingProblems RingExaminer::examine(Index facet) {
  if (rings_.size() == 0) return result_;
  find_collapsed();
  find_same();
  if (choose_axis(facet)) {
    collect_edges();
    find_contacts();
    if (result_.is_complete && result_.problems.empty() && !is_left_out_[0]) find_nesting();
  }
  auto& problems = result_.problems;
  for (RingProblem& p : problems) {
    if (p.edge != kNone) p.edge = divided_[p.ring].position_of[p.edge];
    if (p.other_edge != kNone) p.other_edge = divided_[p.other_ring].position_of[p.other_edge];
  }
  const auto key = [](const RingProblem& p) {
    return std::tie(p.ring, p.kind, p.edge, p.other_ring, p.other_edge);
  };
  std::sort(problems.begin(), problems.end(),
            [&](const RingProblem& a, const RingProblem& b) { return key(a) < key(b); });
  keep_one_of_each_contact();
  return result_;
}

}  // namespace

RingProblems ring_problems(const Solid& solid, Index facet, std::size_t most,
                           const CancelPoll& cancel) {
  return RingExaminer(solid, facet, most, cancel).examine(facet);
}

int ring_turn(const Solid& solid, Index ring, int axis) {
  const std::span<const Index> corners = solid.ring(ring);
  const std::span<const Point> vertices = solid.vertices();
  const auto key = [&](std::size_t i) {
    const Point& p = vertices[corners[i]];
    return std::pair(p[(axis + 1) % 3], p[(axis + 2) % 3]);
  };
  std::size_t smallest = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (key(i) < key(smallest)) smallest = i;
  }
  const std::size_t count = corners.size();
  return geometry::orient2d(vertices[corners[(smallest + count - 1) % count]],
                            vertices[corners[smallest]], vertices[corners[(smallest + 1) % count]],
                            axis);
}

}  // namespace watertight::tessellate
