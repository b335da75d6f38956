// SPDX-License-Identifier: GPL-3.0-or-later
//
// Missing edges, then missing triangles are made by flips. Where flips end, an edge of the triangle
// is divided at the middle of the faces and edges that it crosses, and flips go on with the parts.
// What is left is searched for: the tetrahedra that hold a point of the inside of a missing
// triangle, or of the inside of an edge that is missing too, are taken away, and the cavity is
// filled anew with the triangle in it. Triangles that are faces already stay faces. All decisions
// about points are exact; a Steiner point on an edge lies on it exactly, at a place that is a
// fraction of a power of two. Where else one lies is computed by additions and divisions by 4 only,
// so that it is the same on every machine.
#include "delaunay/recovery/recover_faces.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "delaunay/cancellation.h"
#include "delaunay/recovery/coordinate_order.h"
#include "delaunay/recovery/divided_edges.h"
#include "delaunay/recovery/fill_cavity.h"
#include "delaunay/recovery/flips.h"
#include "delaunay/recovery/point_between.h"
#include "delaunay/recovery/section.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

/// The most tests that the search for the filling of one triangle's cavities makes.
constexpr std::size_t kFillSteps = 400;
/// The most tests for all triangles together, for each triangle of the boundary.
constexpr std::size_t kFillStepsPerTriangle = 32;
/// The most tetrahedra that flips, and that searches look at for each triangle of the boundary, and
/// in any case.
constexpr std::size_t kVisitsPerTriangle = 2048;
constexpr std::size_t kFewVisits = 65'536;
/// The most times that a cavity grows.
constexpr int kGrowths = 8;
/// The most rounds, each of which divides an edge of each missing triangle.
constexpr std::size_t kRounds = 32;
/// The most rounds in a row after which no fewer triangles are missing than before.
constexpr std::size_t kIdleRounds = 8;
/// The same for a boundary of so many triangles or more, whose rounds take long.
constexpr std::size_t kIdleRoundsOfMany = 3;
constexpr std::size_t kManyTriangles = 50'000;
/// The most triangles that may be missing: so many times the least number so far, and so many more.
constexpr std::size_t kMostGrowth = 2;
constexpr std::size_t kSmallGrowth = 32;
/// The rounds of flips alone; the search begins after them.
constexpr std::size_t kRoundsOfFlips = 3;
/// The most parts of triangles for each triangle of the boundary.
constexpr std::size_t kPartsPerTriangle = 4;
/// The number of triangles after which the search ends if it did not find half of them.
constexpr std::size_t kSample = 256;

class Recovery {
 public:
  Recovery(std::span<const Point> points, std::vector<geometry::Tetrahedron> tetrahedra,
           std::span<const Triangle> triangles, std::vector<Index> missing,
           const DivisionRule& rule, const CancelPoll& is_cancelled)
      : rule_(rule),
        points_(points.begin(), points.end()),
        apex_(static_cast<Index>(points.size())),
        mesh_(std::move(tetrahedra), points.size()),
        missing_(std::move(missing)),
        wanted_(triangles.size()),
        visits_left_(kFewVisits + kVisitsPerTriangle * triangles.size()),
        steps_left_(16384 + kFillStepsPerTriangle * triangles.size()),
        cancellation_(is_cancelled),
        flips_(points_, mesh_, wanted_, visits_left_, is_cancelled) {
    points_.emplace_back();  // the apex
    for (Index i = 0; i < triangles.size(); ++i) {
      triangles_.push_back({sorted(triangles[i]), i});
      wanted_.add(triangles_.back().vertices);
    }
    std::sort(missing_.begin(), missing_.end());
  }

  Result<RecoveredFaces> run() {
    const std::size_t most_parts = 64 + kPartsPerTriangle * triangles_.size();
    const std::size_t most_idle_rounds =
        triangles_.size() < kManyTriangles ? kIdleRounds : kIdleRoundsOfMany;
    bool is_cancelled = !flip();
    std::size_t least_missing = missing_.size() + 1;
    std::size_t idle_rounds = 0;
    for (std::size_t round = 0; round < kRounds && !is_cancelled; ++round) {
      const bool is_search_due = round >= kRoundsOfFlips || are_edges_there();
      if (is_search_due && !is_search_over_) is_cancelled = !search();
      idle_rounds = missing_.size() < least_missing ? 0 : idle_rounds + 1;
      least_missing = std::min(least_missing, missing_.size());
      if (is_cancelled || missing_.empty() || idle_rounds == most_idle_rounds ||
          missing_.size() > kMostGrowth * least_missing + kSmallGrowth ||
          triangles_.size() > most_parts || flips_.is_exhausted()) {
        break;
      }
      share_ = round < rule_.first_rounds ? std::nullopt : std::optional(rule_.share);
      divide_missing();
      is_cancelled = !flip();
    }
    if (is_cancelled) return Error{ErrorCode::cancelled, "cancelled by the caller"};
    return result();
  }

 private:
  struct Wanted {
    Triangle vertices{};  // sorted
    Index source = kNone;
  };
  /// An edge that is divided.
  struct Division {
    Index missing = kNone;         // a missing triangle that has it
    std::vector<Index> triangles;  // all that have it
  };

  RecoveredFaces result() {
    RecoveredFaces result;
    for (const Wanted& wanted : triangles_) {
      result.triangles.push_back(without_apex(wanted.vertices));
      result.source.push_back(wanted.source);
    }
    result.missing = missing_.size();
    result.tetrahedra = mesh_.take();
    for (geometry::Tetrahedron& t : result.tetrahedra) t = without_apex(t);
    points_.erase(points_.begin() + apex_);
    result.points = std::move(points_);
    return result;
  }

  bool has_edges(const Triangle& triangle) {
    return std::ranges::all_of(edges_of(triangle),
                               [this](const VertexPair& e) { return is_edge(e[0], e[1]); });
  }

  /// True if no edge of a missing triangle is missing.
  bool are_edges_there() {
    return std::ranges::all_of(missing_,
                               [this](Index i) { return has_edges(triangles_[i].vertices); });
  }

  /// Searches once for each missing triangle. False if the caller cancels.
  bool search() {
    std::size_t failures = 0;
    for (std::size_t i = 0; i < missing_.size() && !is_search_over_; ++i) {
      if (cancellation_.is_wanted()) return false;
      if (!put_in(triangles_[missing_[i]].vertices)) ++failures;
      const bool are_most_lost = i + 1 >= kSample && failures > (i + 1) / 2;
      is_search_over_ = are_most_lost || visits_left_ == 0 || steps_left_ == 0;
    }
    ++searches_;
    forget_found();
    return true;
  }

  template <class Vertices>
  Vertices without_apex(Vertices vertices) const {
    for (Index& vertex : vertices) vertex -= vertex > apex_ ? 1 : 0;
    return vertices;
  }

  /// Makes missing edges, then missing triangles by flips. False if the caller cancels.
  bool flip() {
    std::vector<VertexPair> edges;
    for (const Index i : missing_) {
      const std::array<VertexPair, 3> own = edges_of(triangles_[i].vertices);
      edges.insert(edges.end(), own.begin(), own.end());
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    // Most edges that are in each other's way are made before rings are shortened for one of them.
    for (const std::size_t shrinks : {std::size_t{0}, kShrinks}) {
      for (const auto& [a, b] : edges) {
        if (cancellation_.is_wanted()) return false;
        flips_.recover_edge(a, b, shrinks);
      }
    }
    for (const Index i : missing_) {
      if (cancellation_.is_wanted()) return false;
      const Triangle& triangle = triangles_[i].vertices;
      if (has_edges(triangle)) flips_.recover_face(triangle);
    }
    forget_found();
    return true;
  }

  void forget_found() {
    std::erase_if(missing_, [this](Index i) { return is_face(triangles_[i].vertices); });
  }

  /// The edge of a missing triangle to divide: the longest of those that are missing too, or if
  /// there are none, the longest.
  VertexPair edge_to_divide(const Triangle& triangle) {
    VertexPair longest{};
    std::pair<bool, double> most{false, -1};
    for (const VertexPair& edge : edges_of(triangle)) {
      const std::pair<bool, double> rank{!is_edge(edge[0], edge[1]),
                                         squared_distance(points_[edge[0]], points_[edge[1]])};
      if (rank <= most) continue;
      most = rank;
      longest = edge;
    }
    return longest;
  }

  /// Divides an edge of each missing triangle.
  void divide_missing() {
    std::map<VertexPair, Division> divisions;
    for (const Index i : missing_) {
      divisions[edge_to_divide(triangles_[i].vertices)].missing = i;
    }
    for (Index i = 0; i < triangles_.size(); ++i) {
      for (const VertexPair& edge : edges_of(triangles_[i].vertices)) {
        const auto found = divisions.find(edge);
        if (found != divisions.end()) found->second.triangles.push_back(i);
      }
    }
    std::sort(missing_.begin(), missing_.end());
    for (auto& [edge, division] : divisions) {
      const std::optional<Index> vertex = put_on_edge(edge, division.missing);
      if (!vertex) continue;
      // At once, before flips for other edges change what is beside the vertex.
      for (const Index end : edge) flips_.recover_edge(end, *vertex);
      for (const Index i : std::exchange(division.triangles, {})) {
        divide_triangle(i, edge, *vertex, divisions);
      }
    }
    forget_found();
  }

  /// Divides a triangle at a vertex on one of its edges: the first part takes its place.
  void divide_triangle(Index i, const VertexPair& edge, Index vertex,
                       std::map<VertexPair, Division>& divisions) {
    const Triangle whole = triangles_[i].vertices;
    const auto with_vertex = [&](Index replaced) {
      Triangle part = whole;
      std::replace(part.begin(), part.end(), replaced, vertex);
      return sorted(part);
    };
    const auto second = static_cast<Index>(triangles_.size());
    triangles_.push_back({with_vertex(edge[0]), triangles_[i].source});
    triangles_[i].vertices = with_vertex(edge[1]);
    wanted_.remove(whole);
    wanted_.add(triangles_[i].vertices);
    wanted_.add(triangles_[second].vertices);
    if (std::binary_search(missing_.begin(), missing_.end(), i)) missing_.push_back(second);
    // The other edge at the second end has the second part now.
    for (const VertexPair& other : edges_of(whole)) {
      const bool is_moved = other != edge && (other[0] == edge[1] || other[1] == edge[1]);
      const auto found = is_moved ? divisions.find(other) : divisions.end();
      if (found == divisions.end()) continue;
      std::ranges::replace(found->second.triangles, i, second);
      if (found->second.missing == i) found->second.missing = second;
    }
  }

  /// Puts a vertex on an edge of a missing triangle, with edges to all corners of the tetrahedra
  /// that hold it: in the middle of what the edge crosses, so that each part crosses less. None if
  /// doubles have no such point.
  std::optional<Index> put_on_edge(const VertexPair& edge, Index missing) {
    const auto [a, b] = edge;
    const bool is_missing = !is_edge(a, b);
    const std::array<double, 2> places =
        is_missing ? flips_.middle_of_crossings(a, b, share_) : std::array<double, 2>{0, 1};
    const std::optional<PlacedPoint> placed = divided_.place_on(points_, edge, places);
    if (!placed) return std::nullopt;
    const Point& point = placed->point;
    std::vector<Index> around = star(a);
    std::erase_if(around, [&, end = b](Index t) { return !has_vertex(mesh_.tetrahedron(t), end); });
    if (around.empty()) {
      around = cavity(triangles_[missing].vertices);
      std::erase_if(around, [&](Index t) { return !holds(t, point); });
      // Edges of two shells may cross in a point that is no vertex.
      const auto is_taken = [&](Index t) { return has_wanted_part_at(t, point); };
      if (std::ranges::any_of(around, is_taken)) return std::nullopt;
    }
    const auto vertex = static_cast<Index>(points_.size());
    std::vector<geometry::Tetrahedron> parts;
    for (const Index t : around) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const auto [p, q, r] = inward_face(mesh_.tetrahedron(t), corner);
        if (geometry::orient3d(points_[p], points_[q], points_[r], point) > 0) {
          parts.push_back({p, q, r, vertex});
        }
      }
    }
    // Where the visits have ended, tetrahedra that hold the point may not be known.
    if (parts.empty() || visits_left_ == 0 || flips_.is_exhausted()) return std::nullopt;
    points_.push_back(point);
    divided_.divide(edge, vertex, placed->place);
    wanted_.remove(edge);
    mesh_.replace(around, parts);
    return vertex;
  }

  bool holds(Index t, const Point& p) const {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const auto [a, b, c] = inward_face(mesh_.tetrahedron(t), corner);
      if (geometry::orient3d(points_[a], points_[b], points_[c], p) < 0) return false;
    }
    return true;
  }

  /// True if a point of a tetrahedron is a corner of it or lies inside a wanted edge or face of it.
  bool has_wanted_part_at(Index t, const Point& p) const {
    RingList part;  // the corners of the edge, face or tetrahedron that has the point inside
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const auto [a, b, c] = inward_face(mesh_.tetrahedron(t), corner);
      const bool is_beside = geometry::orient3d(points_[a], points_[b], points_[c], p) != 0;
      if (is_beside) part.push_back(mesh_.tetrahedron(t)[corner]);
    }
    if (part.size() == 2) return wanted_.has(pair_of(part[0], part[1]));
    if (part.size() == 3) return wanted_.has(sorted(Triangle{part[0], part[1], part[2]}));
    return part.size() == 1;
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
    const auto found = flips_.star(vertex);
    return {found.begin(), found.end()};
  }

  bool is_face(const Triangle& triangle) { return flips_.is_face(triangle); }
  bool is_edge(Index a, Index b) { return flips_.tetrahedron_at(a, b) != kNone; }

  /// The tetrahedra that must go so that the triangle can be a face.
  std::vector<Index> cavity(const Triangle& triangle) {
    std::array<bool, 3> is_missing{};
    for (std::size_t edge = 0; edge < 3; ++edge) {
      is_missing[edge] = !is_edge(triangle[edge], triangle[(edge + 1) % 3]);
    }
    const auto belongs = [&](const geometry::Tetrahedron& tetrahedron) {
      const Section section(points_, triangle, tetrahedron);
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
        if (wanted_.has(sorted(face))) {
          front.push_back(face);
        } else if (other == kNone && has_apex && is_in_plane(face, triangle)) {
          add_cone(face, front);
        } else if (!is_inside) {
          front.push_back(face);
        }
      }
    }
    // The search fills over the last triangle first: each time it puts another one there.
    const auto first = static_cast<std::ptrdiff_t>(searches_ % front.size());
    std::rotate(front.begin(), front.begin() + first, front.end());
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
        if (wanted_.has(sorted(face))) continue;
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
  /// the front: the one that sees most in the first of the searches, then the next ones.
  void add_points(const std::vector<Index>& tetrahedra, const Triangle& triangle, Cavity& cavity) {
    struct Candidate {
      std::size_t seen = 0;
      Point point;
    };
    std::array<std::vector<Candidate>, 2> sides;
    for (const Index t : tetrahedra) {
      const Point centre = centre_of(points_, mesh_.tetrahedron(t));
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
      const std::size_t choice = (searches_ - 1) / 2 % side.size();
      cavity.inner_vertices.push_back(static_cast<Index>(points_.size()));
      points_.push_back(side[choice].point);
    }
  }

  /// Makes a triangle a face. A cavity that cannot be filled grows.
  bool put_in(const Triangle& triangle) {
    if (is_face(triangle)) return true;
    std::vector<Index> old_ones = cavity(triangle);
    const std::size_t steps_before = std::min(kFillSteps, steps_left_);
    std::size_t steps = steps_before;
    bool is_filled = false;
    for (int round = 0; round < kGrowths && !old_ones.empty() && steps > 0; ++round) {
      const Filling filling = fill(old_ones, triangle, steps);
      is_filled = !filling.tetrahedra.empty();
      if (is_filled || old_ones.size() > kLargestFront || !grow(old_ones, filling.blocked)) break;
    }
    steps_left_ -= steps_before - steps;
    return is_filled;
  }

  /// Replaces the tetrahedra of a cavity, if a filling is found, and returns the filling. Every
  /// second search may add points.
  Filling fill(const std::vector<Index>& old_ones, const Triangle& triangle, std::size_t& steps) {
    Cavity cavity{front(old_ones, triangle), corners_of(mesh_, old_ones), apex_, triangle};
    const std::size_t point_count = points_.size();
    if (searches_ % 2 == 1) add_points(old_ones, triangle, cavity);
    Filling filling = fill_cavity(points_, std::move(cavity), steps);
    if (filling.tetrahedra.empty()) {
      points_.resize(point_count);
    } else {
      std::erase_if(filling.tetrahedra, [this](const auto& t) { return has_vertex(t, apex_); });
      mesh_.replace(old_ones, filling.tetrahedra);
    }
    return filling;
  }

  DivisionRule rule_;
  std::optional<double> share_;  // of the rule, in this round
  DividedEdges divided_;
  std::vector<Point> points_;    // the input's, the apex, and the points added
  Index apex_;                   // of cones over faces of the hull
  std::size_t searches_ = 0;     // that ended
  bool is_search_over_ = false;  // the search has found too little
  TetrahedronMesh mesh_;
  std::vector<Index> missing_;  // numbers of triangles that are no faces
  std::vector<Wanted> triangles_;
  KeptParts wanted_;
  std::vector<std::uint32_t> mark_of_;
  std::uint32_t mark_ = 0;
  std::size_t visits_left_;
  std::size_t steps_left_;
  Cancellation cancellation_;
  Flips flips_;
};

}  // namespace

Result<RecoveredFaces> recover_faces(std::span<const Point> points,
                                     std::vector<geometry::Tetrahedron> tetrahedra,
                                     std::span<const Triangle> triangles,
                                     std::span<const Index> missing,
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
  std::vector<std::pair<Triangle, Index>> numbered;
  for (Index i = 0; i < triangles.size(); ++i) {
    Triangle triangle = triangles[i];
    for (Index& vertex : triangle) vertex = order.rank_of[vertex];
    numbered.push_back({sorted(triangle), i});
  }
  std::sort(numbered.begin(), numbered.end());
  std::vector<Triangle> sorted_triangles;
  std::vector<Index> place_of(numbered.size());
  for (const auto& [triangle, number] : numbered) {
    place_of[number] = static_cast<Index>(sorted_triangles.size());
    sorted_triangles.push_back(triangle);
  }
  std::vector<Index> sorted_missing;
  for (const Index number : missing) sorted_missing.push_back(place_of[number]);
  Result<RecoveredFaces> recovered = RecoveredFaces{};
  for (const DivisionRule& rule : kDivisionRules) {
    recovered =
        Recovery(sorted_points, tetrahedra, sorted_triangles, sorted_missing, rule, is_cancelled)
            .run();
    if (!recovered) return recovered;
    if (recovered->missing == 0 || sorted_triangles.size() >= kManyTriangles) break;
  }
  const auto renumber = [&](auto& vertices) {
    for (Index& vertex : vertices) {
      if (vertex < points.size()) vertex = order.vertex_at[vertex];
    }
  };
  for (geometry::Tetrahedron& t : recovered->tetrahedra) renumber(t);
  for (Triangle& t : recovered->triangles) renumber(t);
  for (Index& source : recovered->source) source = numbered[source].second;
  std::copy(points.begin(), points.end(), recovered->points.begin());
  return recovered;
}

}  // namespace watertight::delaunay
