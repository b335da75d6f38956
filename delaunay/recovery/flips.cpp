// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/recovery/flips.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

/// The corner of a tetrahedron with a vertex, or 4.
std::size_t corner_of(const geometry::Tetrahedron& t, Index vertex) {
  if (t[0] == vertex) return 0;
  if (t[1] == vertex) return 1;
  if (t[2] == vertex) return 2;
  return t[3] == vertex ? 3 : 4;
}

/// Sorts parts of the mesh, and keeps the first of equal ones.
template <class Part>
void sort_once(std::vector<Part>& parts) {
  constexpr std::size_t kFew = 32;
  if (parts.size() > kFew) {
    std::stable_sort(parts.begin(), parts.end());
  } else {
    for (auto at = parts.begin(); at != parts.end(); ++at) {
      std::rotate(std::upper_bound(parts.begin(), at, *at), at, at + 1);
    }
  }
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
}

/// The other two vertices x, y of a positive tetrahedron with p and q, so that (p, q, x, y) is
/// positive.
std::array<Index, 2> others(const geometry::Tetrahedron& t, Index p, Index q) {
  // [i][j] are the corners k, l for which the permutation (i, j, k, l) is even.
  constexpr std::array<std::array<std::array<std::uint8_t, 2>, 4>, 4> kRest = {
      {{{{0, 0}, {2, 3}, {3, 1}, {1, 2}}},
       {{{3, 2}, {0, 0}, {0, 3}, {2, 0}}},
       {{{1, 3}, {3, 0}, {0, 0}, {0, 1}}},
       {{{2, 1}, {0, 2}, {1, 0}, {0, 0}}}}};
  const auto [x, y] = kRest[corner_of(t, p)][corner_of(t, q)];
  return {t[x], t[y]};
}

/// So many tests of triangles in a ring count as one visit of a tetrahedron.
constexpr std::size_t kTestsPerVisit = 8;

Index other_apex(const geometry::Tetrahedron& t, const Triangle& face) {
  return *std::find_if(t.begin(), t.end(), [&](Index vertex) { return !has_vertex(face, vertex); });
}

}  // namespace

std::size_t KeptParts::Hash::operator()(const Triangle& t) const {
  std::uint64_t hash = t[0];
  for (const Index vertex : {t[1], t[2]}) hash = (hash ^ vertex) * 0x9E3779B97F4A7C15ULL;
  return static_cast<std::size_t>(hash ^ hash >> 32);
}

void KeptParts::add(const Triangle& sorted) {
  faces_.insert(sorted);
  for (const VertexPair& edge : edges_of(sorted)) add(edge);
}

/// Those of a segment are the faces and edges that it crosses, those of a triangle the edges that
/// pass through its inside. If the ring of an edge is to be shortened, each of its tetrahedra
/// counts too, but all of them less than one face or edge that is in the way.
class Flips::Obstacles {
 public:
  /// Of the segment that turns_ began with.
  static Obstacles of_segment(Flips& flips, Index a, Index b) {
    return {flips, {a, b}, std::nullopt};
  }
  static Obstacles of_triangle(Flips& flips, const Triangle& triangle) {
    return {flips, {}, triangle};
  }
  Obstacles with_ring(const VertexPair& edge) const {
    Obstacles result = *this;
    result.ring_ = edge;
    result.weight_ = 2 * static_cast<int>(kLargestRing);
    return result;
  }

  int of_face(const Triangle& face) const {
    const bool is_crossed =
        !triangle_ && flips_.segment_crosses_face(segment_[0], segment_[1], face);
    const bool is_in_ring = ring_ && has_vertex(face, (*ring_)[0]) && has_vertex(face, (*ring_)[1]);
    return (is_crossed ? weight_ : 0) + (is_in_ring ? 1 : 0);
  }
  int of_edge(const VertexPair& edge) const {
    const bool is_crossed = triangle_ ? flips_.crosses_face(edge[0], edge[1], *triangle_)
                                      : flips_.segment_crosses_edge(segment_[0], segment_[1], edge);
    return is_crossed ? weight_ : 0;
  }

 private:
  Obstacles(Flips& flips, const VertexPair& segment, const std::optional<Triangle>& triangle)
      : flips_(flips), segment_(segment), triangle_(triangle) {}

  Flips& flips_;
  VertexPair segment_;
  std::optional<Triangle> triangle_;  // or else the segment
  std::optional<VertexPair> ring_;
  int weight_ = 1;
};

template <class Belongs>
Index Flips::find_in_star(Index vertex, const Belongs& belongs) {
  star_.clear();
  const Index first = mesh_.at_vertex(vertex);
  if (first == kNone) return kNone;
  if (belongs(mesh_.tetrahedron(first))) return first;
  if (mark_of_.size() < mesh_.places()) mark_of_.resize(mesh_.places() + 64, 0);
  ++mark_;
  star_.push_back(first);
  mark_of_[first] = mark_;
  for (std::size_t i = 0; i < star_.size(); ++i) {
    const geometry::Tetrahedron& t = mesh_.tetrahedron(star_[i]);
    if (visits_left_ == 0) break;
    --visits_left_;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      if (t[corner] == vertex) continue;
      const Index other = mesh_.neighbour(star_[i], corner);
      if (other == kNone || mark_of_[other] == mark_) continue;
      mark_of_[other] = mark_;
      if (belongs(mesh_.tetrahedron(other))) return other;
      star_.push_back(other);
    }
  }
  return kNone;
}

std::span<const Index> Flips::star(Index vertex) {
  find_in_star(vertex, [](const geometry::Tetrahedron&) { return false; });
  return star_;
}

Index Flips::tetrahedron_at(Index a, Index b) {
  return find_in_star(a, [b](const geometry::Tetrahedron& t) { return has_vertex(t, b); });
}

bool Flips::is_face(const Triangle& triangle) {
  const auto [a, b, c] = triangle;
  const auto belongs = [b = b, c = c](const geometry::Tetrahedron& t) {
    return has_vertex(t, b) && has_vertex(t, c);
  };
  return find_in_star(a, belongs) != kNone;
}

std::optional<Flips::Ring> Flips::ring_of(const MeshEdge& edge) const {
  const auto [p, q] = edge.vertices;
  const Index start = edge.tetrahedron;
  Ring ring;
  ring.edge = edge.vertices;
  const auto [first, second] = others(mesh_.tetrahedron(start), p, q);
  ring.vertices.push_back(first);
  ring.vertices.push_back(second);
  ring.tetrahedra.push_back(start);
  // Forward over the face (p, q, last vertex), then backward if the hull is met.
  Index t = start;
  Index behind = first;
  for (;;) {
    const Index next = mesh_.neighbour(t, corner_of(mesh_.tetrahedron(t), behind));
    if (next == start) {
      ring.vertices.pop_back();
      return ring;
    }
    if (next == kNone) break;
    if (ring.vertices.size() == kLargestRing) return std::nullopt;
    behind = ring.vertices.back();
    ring.vertices.push_back(others(mesh_.tetrahedron(next), p, q)[1]);
    ring.tetrahedra.push_back(next);
    t = next;
  }
  t = start;
  behind = second;
  for (;;) {
    const Index next = mesh_.neighbour(t, corner_of(mesh_.tetrahedron(t), behind));
    if (next == kNone) return ring;
    if (ring.vertices.size() == kLargestRing) return std::nullopt;
    behind = ring.vertices.front();
    ring.vertices.push_front(others(mesh_.tetrahedron(next), p, q)[0]);
    ring.tetrahedra.push_front(next);
    t = next;
  }
}

bool Flips::crosses_face(Index a, Index b, const Triangle& face) const {
  if (has_vertex(face, a) || has_vertex(face, b)) return false;
  const auto [p, q, r] = face;
  const int first = side(a, b, p, q);
  if (first == 0 || side(a, b, q, r) != first || side(a, b, r, p) != first) return false;
  return side(p, q, r, a) * side(p, q, r, b) < 0;
}

bool Flips::segment_crosses_face(Index a, Index b, const Triangle& face) {
  if (has_vertex(face, a) || has_vertex(face, b)) return false;
  const auto [p, q, r] = face;
  const int first = turns_.turn(p, q);
  if (first == 0 || turns_.turn(q, r) != first || turns_.turn(r, p) != first) return false;
  return signs_.orient3d(points_[p], points_[q], points_[r], points_[a]) *
             signs_.orient3d(points_[p], points_[q], points_[r], points_[b]) <
         0;
}

bool Flips::segment_crosses_edge(Index a, Index b, const VertexPair& edge) {
  const auto [p, q] = edge;
  if (p == a || p == b || q == a || q == b || turns_.turn(p, q) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const auto turn = [&](Index i, Index j, Index k) {
      return geometry::orient2d(points_[i], points_[j], points_[k], axis);
    };
    const int p_side = turn(a, b, p);
    const int q_side = turn(a, b, q);
    if (p_side * q_side > 0) return false;
    if (p_side * q_side < 0) return turn(p, q, a) * turn(p, q, b) < 0;
  }
  return false;
}

/// Looks for them from the tetrahedra at `a` on, through each one that is found.
const Flips::Crossings& Flips::crossings(Index a, Index b) {
  Crossings& found = found_;
  found.edges.clear();
  found.faces.clear();
  found.around.clear();
  const std::span<const Index> first = star(a);
  pending_.assign(first.begin(), first.end());
  ++mark_;
  while (!pending_.empty() && visits_left_ > 0) {
    const Index t = pending_.back();
    pending_.pop_back();
    if (mark_of_[t] == mark_) continue;
    mark_of_[t] = mark_;
    --visits_left_;
    const geometry::Tetrahedron& corners = mesh_.tetrahedron(t);
    const std::size_t start = corner_of(corners, a);
    if (start < 4 && !is_before(b, inward_face(corners, start))) continue;
    // turns[i][j] is how the edge of corners i and j turns around the segment.
    std::array<std::array<int, 4>, 4> turns{};
    for (std::size_t i = 0; i < 4; ++i) {
      if (corners[i] == a || corners[i] == b) continue;
      for (std::size_t j = 0; j < i; ++j) {
        if (corners[j] == a || corners[j] == b) continue;
        turns[i][j] = turns_.turn(corners[i], corners[j]);
        turns[j][i] = -turns[i][j];
        if (turns[i][j] == 0) add_crossed_edge(a, b, {pair_of(corners[i], corners[j]), t});
      }
    }
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::size_t i = (corner + 1) % 4;
      const std::size_t j = (corner + 2) % 4;
      const std::size_t k = (corner + 3) % 4;
      const bool is_around =
          turns[i][j] != 0 && turns[i][j] == turns[j][k] && turns[j][k] == turns[k][i];
      if (!is_around) continue;
      const Triangle face = sorted({corners[i], corners[j], corners[k]});
      const auto [p, q, r] = face;
      if (side(p, q, r, a) * side(p, q, r, b) >= 0) continue;
      found.faces.push_back({face, t, corner});
      for (const VertexPair& edge : edges_of(face)) found.around.push_back({edge, t});
      const Index other = mesh_.neighbour(t, corner);
      if (other != kNone) pending_.push_back(other);
    }
  }
  sort_once(found.edges);
  sort_once(found.faces);
  sort_once(found.around);
  return found;
}

/// False if the ray from the start of the segment through its end `b` misses a face, on the inner
/// side of which the start lies.
bool Flips::is_before(Index b, const Triangle& face) {
  const auto is_beside = [&](Index p, Index q) {
    return p == b || q == b || turns_.turn(p, q) <= 0;
  };
  const auto [p, q, r] = face;
  return is_beside(p, q) && is_beside(q, r) && is_beside(r, p);
}

/// Adds an edge in one plane with a segment if the segment crosses it, and goes on around it.
void Flips::add_crossed_edge(Index a, Index b, const MeshEdge& edge) {
  if (!segment_crosses_edge(a, b, edge.vertices)) return;
  found_.edges.push_back(edge);
  const std::optional<Ring> ring = ring_of(edge);
  if (ring) pending_.insert(pending_.end(), ring->tetrahedra.begin(), ring->tetrahedra.end());
}

/// The triangulation of a ring that leaves the fewest obstacles, and among those makes the most
/// faces that are to be kept; each triangle makes two positive tetrahedra, with both ends of the
/// edge. Cost: O(n^3) for n vertices.
class Flips::RingTriangulation {
 public:
  /// Finds only triangulations with fewer than `limit` obstacles.
  RingTriangulation(Flips& flips, const Ring& ring, const Obstacles& obstacles, int limit)
      : flips_(flips), ring_(ring), obstacles_(obstacles), limit_(limit) {
    const std::size_t n = ring.vertices.size();
    for (std::size_t i = 0; i + 1 < n; ++i) best_[i][i + 1] = {true, 0, 0, 0};
    for (std::size_t length = 2; length < n; ++length) {
      for (std::size_t i = 0; i + length < n; ++i) choose_middle(i, i + length);
    }
  }

  bool exists() const { return whole().exists; }
  int obstacles() const { return whole().obstacles; }
  std::size_t tests() const { return tests_; }

  /// Calls `add` with each tetrahedron.
  template <class Add>
  void for_each_tetrahedron(const Add& add) const {
    const auto [p, q] = ring_.edge;
    const RingList& v = ring_.vertices;
    std::array<std::array<std::size_t, 2>, kLargestRing> pending;
    std::size_t count = 0;
    pending[count++] = {0, v.size() - 1};
    while (count > 0) {
      const auto [i, j] = pending[--count];
      if (j == i + 1) continue;
      const std::size_t k = best_[i][j].middle;
      add({v[i], v[k], v[j], q});
      add({v[i], v[j], v[k], p});
      pending[count++] = {i, k};
      pending[count++] = {k, j};
    }
  }

 private:
  /// The best triangulation of the vertices from one to another.
  struct Best {
    bool exists;
    int obstacles;
    int kept;
    std::size_t middle;  // the third vertex of the triangle at both ends
  };

  const Best& whole() const { return best_[0][ring_.vertices.size() - 1]; }

  void add_face(Best& sum, const Triangle& face) const {
    sum.obstacles += obstacles_.of_face(face);
    sum.kept += flips_.kept_.has(face) ? 1 : 0;
  }

  int side_of(std::size_t i, std::size_t k, std::size_t j, Index end) const {
    const RingList& v = ring_.vertices;
    const std::vector<Point>& points = flips_.points_;
    return flips_.signs_.orient3d(points[v[i]], points[v[k]], points[v[j]], points[end]);
  }

  void choose_middle(std::size_t i, std::size_t j) {
    const auto [p, q] = ring_.edge;
    const RingList& v = ring_.vertices;
    Best& best = best_[i][j];
    best = {false, 0, 0, 0};
    for (std::size_t k = i + 1; k < j; ++k) {
      const Best& left = best_[i][k];
      const Best& right = best_[k][j];
      if (!left.exists || !right.exists) continue;
      Best sum{true, left.obstacles + right.obstacles, left.kept + right.kept, k};
      const auto is_worse = [&] {
        return sum.obstacles >= limit_ || (best.exists && sum.obstacles > best.obstacles);
      };
      ++tests_;
      if (is_worse() || side_of(i, k, j, q) <= 0 || side_of(i, k, j, p) >= 0) continue;
      add_face(sum, sorted({v[i], v[k], v[j]}));
      if (is_worse()) continue;
      const bool is_better = !best.exists || std::pair(sum.obstacles, -sum.kept) <
                                                 std::pair(best.obstacles, -best.kept);
      if (is_better) best = sum;
    }
    const bool is_edge_of_ring = i == 0 && j + 1 == v.size() && !ring_.is_open();
    if (!best.exists || is_edge_of_ring) return;
    best.obstacles += obstacles_.of_edge(pair_of(v[i], v[j]));
    for (const Index end : ring_.edge) add_face(best, sorted({v[i], v[j], end}));
  }

  Flips& flips_;
  const Ring& ring_;
  const Obstacles& obstacles_;
  int limit_;
  std::size_t tests_ = 0;
  // [i][j] is set for i < j only: most rings are short.
  std::array<std::array<Best, kLargestRing>, kLargestRing> best_;
};

std::array<double, 2> Flips::middle_of_crossings(Index a, Index b, std::optional<double> share) {
  struct Crossing {
    double place = 0;
    bool is_edge = false;
  };
  turns_.begin(a, b);
  const Crossings& crossed = crossings(a, b);
  std::vector<Crossing> places{{0, false}, {1, false}};
  const auto add = [&](double before, double after, bool is_edge) {
    const double sum = before + after;
    if (sum > 0 && std::isfinite(sum)) places.push_back({before / sum, is_edge});
  };
  for (const MeshFace& face : crossed.faces) {
    const auto [p, q, r] = face.vertices;
    add(rounded_volume(p, q, r, a), rounded_volume(p, q, r, b), false);
  }
  for (const MeshEdge& edge : crossed.edges) {
    const auto [p, q] = edge.vertices;
    add(rounded_area(p, q, a), rounded_area(p, q, b), true);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Crossing& p, const Crossing& q) { return p.place < q.place; });
  const std::size_t middle = places.size() / 2;
  const Crossing& before = places[middle - 1];
  const Crossing& after = places[middle];
  if (!share) return {before.place, places[std::min(middle + 1, places.size() - 1)].place};
  const double near = (after.place - before.place) * *share;
  if (before.is_edge) return {before.place, before.place + near};
  if (after.is_edge) return {after.place - near, after.place};
  return {before.place, after.place};
}

/// Six times the volume between four points, without its sign.
double Flips::rounded_volume(Index a, Index b, Index c, Index d) const {
  const std::array<double, 3> u = rounded_product(a, b, c);
  const Point& from = points_[a];
  const Point& to = points_[d];
  return std::abs(u[0] * (to.x - from.x) + u[1] * (to.y - from.y) + u[2] * (to.z - from.z));
}

/// Twice the area between three points.
double Flips::rounded_area(Index a, Index b, Index c) const {
  const auto [x, y, z] = rounded_product(a, b, c);
  return std::sqrt(x * x + y * y + z * z);
}

/// The cross product of b - a and c - a.
std::array<double, 3> Flips::rounded_product(Index a, Index b, Index c) const {
  const Point& o = points_[a];
  const Point u{points_[b].x - o.x, points_[b].y - o.y, points_[b].z - o.z};
  const Point v{points_[c].x - o.x, points_[c].y - o.y, points_[c].z - o.z};
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

bool Flips::exchange_face(const MeshFace& face, const Obstacles& obstacles) {
  const std::array<Index, 2> old_ones{face.tetrahedron,
                                      mesh_.neighbour(face.tetrahedron, face.corner)};
  if (old_ones[1] == kNone || kept_.has(face.vertices)) return false;
  const auto [p, q, r] = inward_face(mesh_.tetrahedron(old_ones[0]), face.corner);
  const Index u = mesh_.tetrahedron(old_ones[0])[face.corner];
  const Index v = other_apex(mesh_.tetrahedron(old_ones[1]), face.vertices);
  // The new edge passes through the face if the three new tetrahedra are positive.
  if (side(v, u, p, q) <= 0 || side(v, u, q, r) <= 0 || side(v, u, r, p) <= 0) return false;
  const int after = obstacles.of_edge(pair_of(u, v)) + obstacles.of_face(sorted({u, v, p})) +
                    obstacles.of_face(sorted({u, v, q})) + obstacles.of_face(sorted({u, v, r}));
  if (after >= obstacles.of_face(face.vertices)) return false;
  const std::array<geometry::Tetrahedron, 3> new_ones{{{v, u, p, q}, {v, u, q, r}, {v, u, r, p}}};
  mesh_.replace(old_ones, new_ones);
  return true;
}

bool Flips::remove_edge(const MeshEdge& edge, const Obstacles& obstacles) {
  if (kept_.has(edge.vertices)) return false;
  const std::optional<Ring> ring = ring_of(edge);
  if (!ring || ring->vertices.size() < 3) return false;
  const auto [p, q] = edge.vertices;
  int before = obstacles.of_edge(edge.vertices);
  for (const Index vertex : ring->vertices) before += obstacles.of_face(sorted({p, q, vertex}));
  if (before == 0) return false;
  // An edge of the hull can only go where the faces of the hull beside it lie in one plane.
  const bool is_flat_outside =
      !ring->is_open() || side(p, q, ring->vertices.front(), ring->vertices.back()) == 0;
  if (!is_flat_outside) return false;
  const RingTriangulation triangulation(*this, *ring, obstacles, before);
  visits_left_ -= std::min(visits_left_, triangulation.tests() / kTestsPerVisit);
  if (!triangulation.exists() || triangulation.obstacles() >= before) return false;
  std::array<geometry::Tetrahedron, 2 * kLargestRing> new_ones;
  std::size_t count = 0;
  triangulation.for_each_tetrahedron(
      [&](const geometry::Tetrahedron& t) { new_ones[count++] = t; });
  mesh_.replace(std::span(ring->tetrahedra.begin(), ring->tetrahedra.size()),
                std::span(new_ones).first(count));
  return true;
}

bool Flips::shrink_ring(const MeshEdge& edge, const Obstacles& obstacles) {
  const std::optional<Ring> ring = ring_of(edge);
  if (!ring) return false;
  const Obstacles with_ring = obstacles.with_ring(edge.vertices);
  for (std::size_t i = 0; i < ring->vertices.size(); ++i) {
    const Index at = ring->tetrahedra[std::min(i, ring->tetrahedra.size() - 1)];
    for (const Index end : edge.vertices) {
      const MeshEdge spoke{pair_of(ring->vertices[i], end), at};
      if (remove_edge(spoke, with_ring)) return true;
    }
  }
  return false;
}

bool Flips::is_there(const MeshEdge& edge) const {
  const geometry::Tetrahedron& t = mesh_.tetrahedron(edge.tetrahedron);
  return has_vertex(t, edge.vertices[0]) && has_vertex(t, edge.vertices[1]);
}

bool Flips::is_there(const MeshFace& face) const {
  const geometry::Tetrahedron& t = mesh_.tetrahedron(face.tetrahedron);
  return !has_vertex(face.vertices, t[face.corner]) &&
         std::ranges::all_of(face.vertices, [&](Index vertex) { return has_vertex(t, vertex); });
}

bool Flips::recover_edge(Index a, Index b, std::size_t shrinks) {
  if (tetrahedron_at(a, b) != kNone) return true;
  turns_.begin(a, b);
  const Obstacles obstacles = Obstacles::of_segment(*this, a, b);
  const auto shrink = [&](const MeshEdge& edge) { return shrink_ring(edge, obstacles); };
  do {
    const Crossings& found = crossings(a, b);
    if (is_exhausted() || cancellation_.is_due_and_wanted(found.around.size())) return false;
    std::size_t flips = 0;
    const auto remove = [&](const MeshEdge& edge) {
      if (is_there(edge) && remove_edge(edge, obstacles)) ++flips;
    };
    std::ranges::for_each(found.edges, remove);
    for (const MeshFace& face : found.faces) {
      if (is_there(face) && exchange_face(face, obstacles)) ++flips;
    }
    std::ranges::for_each(found.around, remove);
    if (flips > 0) continue;
    if (shrinks-- == 0) return false;
    if (!std::ranges::any_of(found.edges, shrink) && !std::ranges::any_of(found.around, shrink)) {
      return false;
    }
  } while (tetrahedron_at(a, b) == kNone);
  return true;
}

/// The edges of the tetrahedra at the sides of a triangle that pass through its inside.
std::vector<Flips::MeshEdge> Flips::edges_through(const Triangle& triangle) {
  std::vector<MeshEdge> edges;
  for (const VertexPair& side : edges_of(triangle)) {
    const Index t = tetrahedron_at(side[0], side[1]);
    const std::optional<Ring> ring = t == kNone ? std::nullopt : ring_of({side, t});
    if (!ring) continue;
    for (const Index beside : ring->tetrahedra) {
      const auto [x, y] = others(mesh_.tetrahedron(beside), side[0], side[1]);
      if (crosses_face(x, y, triangle)) edges.push_back({pair_of(x, y), beside});
    }
  }
  sort_once(edges);
  return edges;
}

bool Flips::recover_face(const Triangle& triangle) {
  const Obstacles obstacles = Obstacles::of_triangle(*this, triangle);
  const auto remove = [&](const MeshEdge& edge) { return remove_edge(edge, obstacles); };
  const auto shrink = [&](const MeshEdge& edge) { return shrink_ring(edge, obstacles); };
  std::size_t shrinks_left = kShrinks;
  while (!is_face(triangle)) {
    const std::vector<MeshEdge> edges = edges_through(triangle);
    if (is_exhausted() || cancellation_.is_due_and_wanted(edges.size())) return false;
    if (std::ranges::any_of(edges, remove)) continue;
    if (shrinks_left-- == 0 || !std::ranges::any_of(edges, shrink)) return false;
  }
  return true;
}

}  // namespace watertight::delaunay
