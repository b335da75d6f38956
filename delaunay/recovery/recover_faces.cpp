// SPDX-License-Identifier: GPL-3.0-or-later
//
// Each missing triangle is put in by itself: the tetrahedra that hold a point of its inside, or of
// the inside of an edge that is missing too, are taken away, and the cavity is filled anew with the
// triangle in it. Triangles that are faces already stay faces. All decisions about points are
// exact; where a Steiner point lies is computed by additions and divisions by 4 only, so that it is
// the same on every machine.
#include "delaunay/recovery/recover_faces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <unordered_set>
#include <utility>

#include "delaunay/cancellation.h"
#include "delaunay/recovery/fill_cavity.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

/// The most tests that the search for the filling of one triangle's cavities makes in the first
/// pass; twice as many in each of the next ones.
constexpr std::size_t kFillSteps = 1000;
/// The most tests for all triangles together, for each triangle of the boundary.
constexpr std::size_t kFillStepsPerTriangle = 16;
/// The most tetrahedra that are looked at for each triangle of the boundary, all together.
constexpr std::size_t kVisitsPerTriangle = 512;
/// The most times that a cavity grows.
constexpr int kRounds = 8;
/// The most passes over the missing triangles: a cavity can become simpler when others are filled.
constexpr std::size_t kPasses = 24;
/// The passes that double the tests of the pass before.
constexpr std::size_t kDoublings = 5;
/// The number of triangles after which the search ends if it did not find half of them.
constexpr std::size_t kSample = 256;

struct TriangleHash {
  std::size_t operator()(const Triangle& t) const {
    std::uint64_t hash = t[0];
    for (const Index vertex : {t[1], t[2]}) hash = (hash ^ vertex) * 0x9E3779B97F4A7C15ULL;
    return static_cast<std::size_t>(hash ^ hash >> 32);
  }
};

bool has_vertex(const geometry::Tetrahedron& tetrahedron, Index vertex) {
  return std::find(tetrahedron.begin(), tetrahedron.end(), vertex) != tetrahedron.end();
}

/// How a tetrahedron lies to the plane of a triangle, and whether it holds points of the triangle.
class Section {
 public:
  Section(std::span<const Point> points, const Triangle& triangle,
          const geometry::Tetrahedron& tetrahedron)
      : points_(points), triangle_(triangle), tetrahedron_(tetrahedron) {
    const auto& [a, b, c] = triangle;
    for (std::size_t i = 0; i < 4; ++i) side_[i] = orientation(a, b, c, tetrahedron[i]);
  }

  /// True if the closed tetrahedron holds a point of the inside of the triangle. Two convex
  /// polygons in a plane are apart if and only if the line of an edge of one parts them.
  bool meets_inside() {
    if (!meets_plane() || is_beyond_a_face({0, 1, 2})) return false;
    for (std::size_t edge = 0; edge < 3; ++edge) {
      if (range_beside(edge)[1] <= 0) return false;
    }
    return true;
  }

  /// True if the closed tetrahedron holds a point of the inside of an edge. May also be true if it
  /// only touches the line of the edge along a segment.
  bool meets_edge(std::size_t edge) {
    if (!meets_plane() || is_beyond_a_face({edge, (edge + 1) % 3, edge})) return false;
    const auto [least, most] = range_beside(edge);
    return least <= 0 && most >= 0;
  }

 private:
  int orientation(Index a, Index b, Index c, Index d) const {
    if (a == d || b == d || c == d || a == c || b == c) return 0;
    return geometry::orient3d(points_[a], points_[b], points_[c], points_[d]);
  }

  bool meets_plane() const {
    const auto [least, most] = std::minmax_element(side_.begin(), side_.end());
    return *least <= 0 && *most >= 0;
  }

  /// True if these corners of the triangle are not inside a face of the tetrahedron, nor all on it.
  bool is_beyond_a_face(const std::array<std::size_t, 3>& corners) const {
    for (std::size_t face = 0; face < 4; ++face) {
      const auto [a, b, c] = inward_face(tetrahedron_, face);
      int least = 0;
      int most = -1;
      for (const std::size_t corner : corners) {
        const int side = orientation(a, b, c, triangle_[corner]);
        least = std::min(least, side);
        most = std::max(most, side);
      }
      if (most <= 0 && least < 0) return true;
    }
    return false;
  }

  /// The least and the largest side of the tetrahedron's section on the line of an edge of the
  /// triangle; the triangle itself is on the side +1.
  std::array<int, 2> range_beside(std::size_t edge) const {
    const Index p = triangle_[edge];
    const Index q = triangle_[(edge + 1) % 3];
    std::array<int, 2> range{1, -1};
    const auto add = [&](int side) {
      range = {std::min(range[0], side), std::max(range[1], side)};
    };
    const auto off = static_cast<std::size_t>(
        std::find_if(side_.begin(), side_.end(), [](int side) { return side != 0; }) -
        side_.begin());
    for (std::size_t i = 0; i < 4; ++i) {
      if (side_[i] == 0) add(orientation(p, q, tetrahedron_[i], tetrahedron_[off]) * side_[off]);
      for (std::size_t j = 0; j < 4; ++j) {
        if (side_[i] > 0 && side_[j] < 0) {
          add(orientation(p, q, tetrahedron_[j], tetrahedron_[i]));
        }
      }
    }
    return range;
  }

  std::span<const Point> points_;
  const Triangle& triangle_;
  const geometry::Tetrahedron& tetrahedron_;
  std::array<int, 4> side_{};
};

class Recovery {
 public:
  Recovery(std::span<const Point> points, std::vector<geometry::Tetrahedron> tetrahedra,
           std::span<const Triangle> triangles, const CancelPoll& is_cancelled)
      : points_(points.begin(), points.end()),
        apex_(static_cast<Index>(points.size())),
        mesh_(std::move(tetrahedra), points.size()),
        visits_left_(4096 + kVisitsPerTriangle * triangles.size()),
        steps_left_(16384 + kFillStepsPerTriangle * triangles.size()),
        cancellation_(is_cancelled) {
    points_.emplace_back();  // the apex
    wanted_.reserve(triangles.size());
    for (const Triangle& triangle : triangles) wanted_.insert(sorted(triangle));
    for (const Triangle& triangle : triangles) {
      if (!is_face(triangle)) missing_.push_back(triangle);
    }
  }

  Result<RecoveredFaces> run() {
    for (; pass_ < kPasses && !missing_.empty() && is_promising_; ++pass_) {
      if (!run_pass()) return Error{ErrorCode::cancelled, "cancelled by the caller"};
    }
    return RecoveredFaces{points_without_apex(), tetrahedra_without_apex(), missing_.size()};
  }

 private:
  /// Tries each missing triangle once. False if the caller cancels.
  bool run_pass() {
    std::vector<Triangle> still_missing;
    for (std::size_t i = 0; i < missing_.size(); ++i) {
      if (cancellation_.is_wanted()) return false;
      if (!put_in(missing_[i])) still_missing.push_back(missing_[i]);
      const bool is_failing = i + 1 >= kSample && still_missing.size() > (i + 1) / 2;
      if (is_failing || visits_left_ == 0 || steps_left_ == 0) {
        is_promising_ = false;
        still_missing.insert(still_missing.end(),
                             missing_.begin() + static_cast<std::ptrdiff_t>(i) + 1, missing_.end());
        break;
      }
    }
    missing_ = std::move(still_missing);
    return true;
  }

  std::vector<Point> points_without_apex() {
    points_.erase(points_.begin() + apex_);
    return std::move(points_);
  }

  std::vector<geometry::Tetrahedron> tetrahedra_without_apex() {
    std::vector<geometry::Tetrahedron> tetrahedra = mesh_.take();
    for (geometry::Tetrahedron& t : tetrahedra) {
      for (Index& vertex : t) vertex -= vertex > apex_ ? 1 : 0;
    }
    return tetrahedra;
  }

  void mark(Index t) {
    if (mark_of_.size() < mesh_.places()) mark_of_.resize(mesh_.places(), 0);
    mark_of_[t] = mark_;
  }
  bool is_marked(Index t) const { return t < mark_of_.size() && mark_of_[t] == mark_; }

  /// Collects the tetrahedra that belong to a set, which is connected across faces, from one of
  /// them or its neighbours on. Ends at the limit of visits; the set is incomplete then.
  template <class Belongs>
  void flood(std::vector<Index>& found, const Belongs& belongs) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const Index other = mesh_.neighbour(found[i], corner);
        if (other == kNone || is_marked(other)) continue;
        mark(other);
        if (visits_left_ == 0) return;
        --visits_left_;
        if (belongs(mesh_.tetrahedron(other))) found.push_back(other);
      }
    }
  }

  std::vector<Index> star(Index vertex) {
    ++mark_;
    const Index first = mesh_.at_vertex(vertex);
    if (first == kNone) return {};
    std::vector<Index> found{first};
    mark(first);
    flood(found, [&](const geometry::Tetrahedron& t) { return has_vertex(t, vertex); });
    return found;
  }

  bool is_face(const Triangle& triangle) {
    for (const Index t : star(triangle[0])) {
      if (has_vertex(mesh_.tetrahedron(t), triangle[1]) &&
          has_vertex(mesh_.tetrahedron(t), triangle[2])) {
        return true;
      }
    }
    return false;
  }

  bool is_edge(Index a, Index b) {
    const std::vector<Index> around = star(a);
    return std::any_of(around.begin(), around.end(),
                       [&](Index t) { return has_vertex(mesh_.tetrahedron(t), b); });
  }

  /// The tetrahedra that must go so that the triangle can be a face.
  std::vector<Index> cavity(const Triangle& triangle) {
    std::array<bool, 3> is_missing{};
    for (std::size_t edge = 0; edge < 3; ++edge) {
      is_missing[edge] = !is_edge(triangle[edge], triangle[(edge + 1) % 3]);
    }
    const auto belongs = [&](const geometry::Tetrahedron& tetrahedron) {
      Section section(points_, triangle, tetrahedron);
      if (section.meets_inside()) return true;
      for (std::size_t edge = 0; edge < 3; ++edge) {
        if (is_missing[edge] && section.meets_edge(edge)) return true;
      }
      return false;
    };
    std::vector<Index> around = star(triangle[0]);
    std::erase_if(around, [&](Index t) { return !belongs(mesh_.tetrahedron(t)); });
    ++mark_;
    for (const Index t : around) mark(t);
    flood(around, belongs);
    std::sort(around.begin(), around.end());
    return around;
  }

  /// The triangles around a cavity, and both sides of those that must stay. Where the triangle lies
  /// in the hull, the faces of the hull in its plane change with it: the cavity then also holds a
  /// cone over them, whose apex is beyond the hull.
  std::vector<Triangle> front(const std::vector<Index>& tetrahedra, const Triangle& triangle) {
    std::vector<Triangle> front{triangle, reversed(triangle)};
    const bool has_apex = place_apex(tetrahedra, triangle);
    for (const Index t : tetrahedra) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const Triangle face = inward_face(mesh_.tetrahedron(t), corner);
        const Index other = mesh_.neighbour(t, corner);
        const bool is_inside =
            other != kNone && std::binary_search(tetrahedra.begin(), tetrahedra.end(), other);
        if (wanted_.contains(sorted(face))) {
          front.push_back(face);
        } else if (other == kNone && has_apex && is_in_plane(face, triangle)) {
          add_cone(face, front);
        } else if (!is_inside) {
          front.push_back(face);
        }
      }
    }
    // The search fills over the last triangle first: each pass puts another one there.
    std::rotate(front.begin(), front.begin() + static_cast<std::ptrdiff_t>(pass_ % front.size()),
                front.end());
    return front;
  }

  bool is_in_plane(const Triangle& face, const Triangle& plane) const {
    return std::all_of(face.begin(), face.end(), [&](Index vertex) {
      return std::find(plane.begin(), plane.end(), vertex) != plane.end() ||
             geometry::orient3d(points_[plane[0]], points_[plane[1]], points_[plane[2]],
                                points_[vertex]) == 0;
    });
  }

  /// Places the apex on the side of the triangle's plane where no tetrahedron is. False if there
  /// are tetrahedra on both sides, or if doubles have no such place.
  bool place_apex(const std::vector<Index>& tetrahedra, const Triangle& triangle) {
    const Point& a = points_[triangle[0]];
    const Point& b = points_[triangle[1]];
    const Point& c = points_[triangle[2]];
    std::array<bool, 2> is_filled{};
    for (const Index t : tetrahedra) {
      for (const Index vertex : mesh_.tetrahedron(t)) {
        if (std::find(triangle.begin(), triangle.end(), vertex) != triangle.end()) continue;
        const int side = geometry::orient3d(a, b, c, points_[vertex]);
        if (side != 0) is_filled[side > 0 ? 1 : 0] = true;
      }
    }
    if (is_filled[0] == is_filled[1]) return false;
    const Point u{b.x - a.x, b.y - a.y, b.z - a.z};
    const Point v{c.x - a.x, c.y - a.y, c.z - a.z};
    const int outer = is_filled[1] ? -1 : 1;
    points_[apex_] = {a.x + outer * (u.y * v.z - u.z * v.y), a.y + outer * (u.z * v.x - u.x * v.z),
                      a.z + outer * (u.x * v.y - u.y * v.x)};
    return geometry::orient3d(a, b, c, points_[apex_]) == outer;
  }

  /// Adds the sides of the cone over a face of the hull. Two sides that meet are inside.
  void add_cone(const Triangle& face, std::vector<Triangle>& front) const {
    const geometry::Tetrahedron cone{face[0], face[2], face[1], apex_};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Triangle side = rotated(inward_face(cone, corner));
      const auto twin = std::find(front.begin(), front.end(), rotated(reversed(side)));
      if (twin != front.end()) {
        front.erase(twin);
      } else {
        front.push_back(side);
      }
    }
  }

  std::vector<Index> vertices_of(const std::vector<Index>& tetrahedra) const {
    std::vector<Index> vertices;
    for (const Index t : tetrahedra) {
      const geometry::Tetrahedron& tetrahedron = mesh_.tetrahedron(t);
      vertices.insert(vertices.end(), tetrahedron.begin(), tetrahedron.end());
    }
    return vertices;
  }

  /// Adds the tetrahedra beyond the blocked faces of a cavity, or if there are none, beyond all of
  /// its faces. False if the cavity cannot grow.
  bool grow(std::vector<Index>& tetrahedra, const std::vector<Triangle>& blocked) const {
    std::vector<Index> beyond_blocked;
    std::vector<Index> beyond;
    for (const Index t : tetrahedra) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const Index other = mesh_.neighbour(t, corner);
        if (other == kNone || std::binary_search(tetrahedra.begin(), tetrahedra.end(), other)) {
          continue;
        }
        const Triangle face = rotated(inward_face(mesh_.tetrahedron(t), corner));
        if (wanted_.contains(sorted(face))) continue;
        beyond.push_back(other);
        if (std::binary_search(blocked.begin(), blocked.end(), face)) {
          beyond_blocked.push_back(other);
        }
      }
    }
    const std::vector<Index>& added = beyond_blocked.empty() ? beyond : beyond_blocked;
    tetrahedra.insert(tetrahedra.end(), added.begin(), added.end());
    std::sort(tetrahedra.begin(), tetrahedra.end());
    tetrahedra.erase(std::unique(tetrahedra.begin(), tetrahedra.end()), tetrahedra.end());
    return !added.empty();
  }

  /// Adds, on each side of a triangle, the centre of a tetrahedron of the cavity that sees much of
  /// the front: the one that sees most in the first of the passes, then the next ones.
  void add_points(const std::vector<Index>& tetrahedra, const Triangle& triangle, Cavity& cavity) {
    struct Candidate {
      std::size_t seen = 0;
      Point point;
    };
    std::array<std::vector<Candidate>, 2> sides;
    for (const Index t : tetrahedra) {
      const Point centre = centre_of(mesh_.tetrahedron(t));
      const auto sees = [&](const Triangle& f) {
        return geometry::orient3d(points_[f[0]], points_[f[1]], points_[f[2]], centre) > 0;
      };
      const auto seen = std::count_if(cavity.front.begin(), cavity.front.end(), sees);
      sides[sees(triangle) ? 1 : 0].push_back({static_cast<std::size_t>(seen), centre});
    }
    for (std::vector<Candidate>& side : sides) {
      if (side.empty()) continue;
      std::stable_sort(side.begin(), side.end(),
                       [](const Candidate& a, const Candidate& b) { return a.seen > b.seen; });
      const std::size_t choice = (pass_ - 1) / 2 % side.size();
      cavity.inner_vertices.push_back(static_cast<Index>(points_.size()));
      points_.push_back(side[choice].point);
    }
  }

  Point centre_of(const geometry::Tetrahedron& tetrahedron) const {
    Point centre{0, 0, 0};
    for (const Index vertex : tetrahedron) {
      const Point& p = points_[vertex];
      centre = {centre.x + p.x / 4, centre.y + p.y / 4, centre.z + p.z / 4};
    }
    return centre;
  }

  /// Makes a triangle a face. A cavity that cannot be filled grows.
  bool put_in(const Triangle& triangle) {
    if (is_face(triangle)) return true;
    std::vector<Index> old_ones = cavity(triangle);
    const std::size_t steps_before =
        std::min(kFillSteps << std::min(pass_, kDoublings), steps_left_);
    std::size_t steps = steps_before;
    bool is_filled = false;
    for (int round = 0; round < kRounds && !old_ones.empty() && steps > 0; ++round) {
      const Filling filling = fill(old_ones, triangle, steps);
      is_filled = !filling.tetrahedra.empty();
      if (is_filled || old_ones.size() > kLargestFront || !grow(old_ones, filling.blocked)) break;
    }
    steps_left_ -= steps_before - steps;
    return is_filled;
  }

  /// Replaces the tetrahedra of a cavity, if a filling is found, and returns the filling. Every
  /// second pass may add points.
  Filling fill(const std::vector<Index>& old_ones, const Triangle& triangle, std::size_t& steps) {
    Cavity cavity{front(old_ones, triangle), vertices_of(old_ones), apex_, triangle};
    const std::size_t point_count = points_.size();
    if (pass_ % 2 == 1) add_points(old_ones, triangle, cavity);
    Filling filling = fill_cavity(points_, std::move(cavity), steps);
    if (filling.tetrahedra.empty()) {
      points_.resize(point_count);
    } else {
      std::erase_if(filling.tetrahedra, [this](const auto& t) { return has_vertex(t, apex_); });
      mesh_.replace(old_ones, filling.tetrahedra);
    }
    return filling;
  }

  std::vector<Point> points_;  // the input's, the apex, and the points added
  Index apex_;                 // of cones over faces of the hull
  std::size_t pass_ = 0;
  bool is_promising_ = true;
  TetrahedronMesh mesh_;
  std::unordered_set<Triangle, TriangleHash> wanted_;  // sorted
  std::vector<Triangle> missing_;
  std::vector<std::uint32_t> mark_of_;
  std::uint32_t mark_ = 0;
  std::size_t visits_left_;
  std::size_t steps_left_;
  Cancellation cancellation_;
};

/// Vertices in the order of their coordinates, so that a result does not depend on the numbering.
struct CoordinateOrder {
  std::vector<Index> vertex_at;  // rank -> vertex
  std::vector<Index> rank_of;    // vertex -> rank
};

CoordinateOrder order_of(std::span<const Point> points) {
  CoordinateOrder order;
  order.vertex_at.resize(points.size());
  std::iota(order.vertex_at.begin(), order.vertex_at.end(), Index{0});
  std::sort(order.vertex_at.begin(), order.vertex_at.end(),
            [&](Index a, Index b) { return points[a] < points[b]; });
  order.rank_of.resize(points.size());
  for (Index rank = 0; rank < points.size(); ++rank) order.rank_of[order.vertex_at[rank]] = rank;
  return order;
}

/// A positive tetrahedron with its smallest vertices first, still positive.
geometry::Tetrahedron normalized(geometry::Tetrahedron t) {
  bool is_odd = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto least = static_cast<std::size_t>(
        std::min_element(t.begin() + static_cast<std::ptrdiff_t>(i), t.end()) - t.begin());
    if (least == i) continue;
    std::swap(t[i], t[least]);
    is_odd = !is_odd;
  }
  if (is_odd) std::swap(t[2], t[3]);
  return t;
}

}  // namespace

Result<RecoveredFaces> recover_faces(std::span<const Point> points,
                                     std::vector<geometry::Tetrahedron> tetrahedra,
                                     std::span<const Triangle> triangles,
                                     const CancelPoll& is_cancelled) {
  const CoordinateOrder order = order_of(points);
  std::vector<Point> sorted_points;
  sorted_points.reserve(points.size());
  for (const Index vertex : order.vertex_at) sorted_points.push_back(points[vertex]);
  for (geometry::Tetrahedron& t : tetrahedra) {
    for (Index& vertex : t) vertex = order.rank_of[vertex];
    t = normalized(t);
  }
  std::sort(tetrahedra.begin(), tetrahedra.end());
  std::vector<Triangle> sorted_triangles(triangles.begin(), triangles.end());
  for (Triangle& triangle : sorted_triangles) {
    for (Index& vertex : triangle) vertex = order.rank_of[vertex];
    triangle = sorted(triangle);
  }
  std::sort(sorted_triangles.begin(), sorted_triangles.end());
  Result<RecoveredFaces> recovered =
      Recovery(sorted_points, std::move(tetrahedra), sorted_triangles, is_cancelled).run();
  if (!recovered) return recovered;
  for (geometry::Tetrahedron& t : recovered->tetrahedra) {
    for (Index& vertex : t) {
      if (vertex < points.size()) vertex = order.vertex_at[vertex];
    }
  }
  std::copy(points.begin(), points.end(), recovered->points.begin());
  return recovered;
}

}  // namespace watertight::delaunay
