// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/tessellate_face.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "surfaces/face_loops.h"
#include "surfaces/grid_lines.h"
#include "surfaces/invert_point.h"
#include "tessellate/trimmed/grid.h"
#include "tessellate/trimmed/plane_predicates.h"

namespace watertight::surfaces {

bool FaceNeighbours::share(Index a, Index b) const {
  const auto faces_at = [&](Index vertex) {
    return vertex < faces.size() ? std::span<const Index>(faces[vertex]) : std::span<const Index>();
  };
  const std::span<const Index> own = faces_at(a);
  const std::span<const Index> others = faces_at(b);
  return std::any_of(own.begin(), own.end(), [&](Index other) {
    return other != face && std::find(others.begin(), others.end(), other) != others.end();
  });
}

namespace {

constexpr int kMostRefinements = 12;  // of refining triangles that are too far from the surface
constexpr int kMostSteps = 3;         // towards the nearest point of the surface
constexpr std::size_t kMeasured = 4;  // parts of a side of a triangle between measured points
constexpr double kFarEnough = 0.9;    // of the chord: how far measured points may be from a surface
constexpr double kClearance = 0.25;   // of a cell: how near a grid point may be to a loop
constexpr double kChordErrors = 4;    // of a chord: how near a point inside may be to it
constexpr std::size_t kScaleNet = 4;  // points along u and v at which lengths are compared

class FaceMesh {
 public:
  FaceMesh(const Surface& surface, FaceLoops loops, const FaceNeighbours& neighbours, double chord,
           std::size_t most, VertexPool& pool)
      : surface_(surface),
        bends_(surface),
        loops_(std::move(loops)),
        neighbours_(neighbours),
        chord_(chord),
        most_(most),
        pool_(pool) {}

  Result<FaceTriangles> run(bool is_flipped) {
    measure();
    make_region();
    measure_chords();
    make_grid();
    if (static_cast<double>(grid_.us.size()) * static_cast<double>(grid_.vs.size()) >
        static_cast<double>(most_)) {
      return too_many();
    }
    if (has_pole()) use_short_rows();
    tessellate::TrimmedTriangles mesh;
    for (int round = 0; round < kMostRefinements; ++round) {
      mesh = triangulate();
      if (mesh.conflict) {
        result_.crossing = edges_of(*mesh.conflict);
        return std::move(result_);
      }
      if (mesh.triangles.size() > most_) return too_many();
      if (!refine(mesh)) break;
    }
    take(mesh, is_flipped);
    return std::move(result_);
  }

 private:
  Error too_many() const {
    return Error{ErrorCode::limit_exceeded,
                 "a face needs more than " + std::to_string(most_) + " triangles for this chord",
                 {},
                 {}};
  }

  /// The box of the loops, and how long u and v are on the surface.
  void measure() {
    low_ = high_ = loops_.loops.front().front().at;
    for (const FaceLoop& loop : loops_.loops) {
      for (const LoopPoint& point : loop) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
          low_[axis] = std::min(low_[axis], point.at[axis]);
          high_[axis] = std::max(high_[axis], point.at[axis]);
        }
      }
    }
    Parameters sum{};
    for (std::size_t i = 0; i < kScaleNet * kScaleNet; ++i) {
      const auto share = [&](std::size_t at) {
        return (static_cast<double>(at) + 0.5) / static_cast<double>(kScaleNet);
      };
      const SurfacePoint point =
          point_at(surface_, {low_[0] + share(i % kScaleNet) * (high_[0] - low_[0]),
                              low_[1] + share(i / kScaleNet) * (high_[1] - low_[1])});
      sum[0] += length(point.along_u);
      sum[1] += length(point.along_v);
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
      scale_[axis] = sum[axis] > 0 ? sum[axis] / static_cast<double>(kScaleNet * kScaleNet) : 1;
    }
  }

  Point in_plane(const Parameters& at) const {
    return {(at[0] - low_[0]) * scale_[0], (at[1] - low_[1]) * scale_[1], 0};
  }
  Parameters parameters_of(const Point& p) const {
    return {low_[0] + p.x / scale_[0], low_[1] + p.y / scale_[1]};
  }

  void make_region() {
    for (const FaceLoop& loop : loops_.loops) {
      const auto first = static_cast<Index>(region_.points.size());
      const auto count = static_cast<Index>(loop.size());
      for (Index i = 0; i < count; ++i) {
        region_.points.push_back(in_plane(loop[i].at));
        region_.edges.push_back({first + i, first + (i + 1) % count});
        border_.push_back(loop[i]);
      }
    }
  }

  /// Lines so near to each other that a triangle within a cell is near enough to the surface.
  void make_grid() {
    const GridLines lines = grid_lines(surface_, {low_, high_}, scale_, chord_, most_);
    for (const double u : lines.us) grid_.us.push_back((u - low_[0]) * scale_[0]);
    for (const double v : lines.vs) grid_.vs.push_back((v - low_[1]) * scale_[1]);
  }

  bool has_pole() const {
    for (const Pole& pole : poles_of(surface_)) {
      const auto axis = static_cast<std::size_t>(pole.direction);
      if (pole.direction == 1 && (low_[axis] == pole.at || high_[axis] == pole.at)) return true;
    }
    return false;
  }

  /// Rows of the grid get fewer points where they are shorter, near a pole.
  void use_short_rows() {
    const tessellate::PlaneGrid grid = std::exchange(grid_, {});
    const double middle = (low_[0] + high_[0]) / 2;
    const auto length_at = [&](double y) {
      return length(point_at(surface_, {middle, parameters_of({0, y, 0})[1]}).along_u);
    };
    double longest = 0;
    for (const double y : grid.vs) longest = std::max(longest, length_at(y));
    if (!(longest > 0)) return;
    const double size = (high_[0] - low_[0]) * scale_[0];
    for (const double y : grid.vs) {
      const std::vector<std::size_t> edges = edges_near_row(y);
      const double share = length_at(y) / longest;
      const double count = std::ceil(static_cast<double>(grid.us.size() + 1) * share);
      for (double i = 1; i < count; ++i) {
        const Point p{size * (i / count), y, 0};
        if (is_inside(p, edges) && !is_beside_border(p, edges)) inner_.push_back(p);
      }
    }
  }

  /// The edges of the region that points of a row may be beside.
  std::vector<std::size_t> edges_near_row(double y) const {
    std::vector<std::size_t> edges;
    for (std::size_t i = 0; i < region_.edges.size(); ++i) {
      const double reach = clearance_.of_edges[i];
      const double a = region_.points[region_.edges[i][0]].y;
      const double b = region_.points[region_.edges[i][1]].y;
      if (std::min(a, b) - reach <= y && y <= std::max(a, b) + reach) edges.push_back(i);
    }
    return edges;
  }

  /// Whether a point of the plane is strictly inside the loops, exactly. `edges` has those of the
  /// edges of the region that the row of the point meets.
  bool is_inside(const Point& p, std::span<const std::size_t> edges) const {
    bool is_odd = false;
    for (const std::size_t edge : edges) {
      const Point* a = &region_.points[region_.edges[edge][0]];
      const Point* b = &region_.points[region_.edges[edge][1]];
      if ((a->y <= p.y) == (b->y <= p.y)) continue;
      if (a->y > b->y) std::swap(a, b);
      const int side = tessellate::turn(*a, *b, p);
      if (side == 0) return false;
      if (side > 0) is_odd = !is_odd;
    }
    return is_odd;
  }

  /// Triangulates with the points inside; one that no longer is inside, after rounding, goes.
  tessellate::TrimmedTriangles triangulate() {
    while (true) {
      tessellate::Region region = region_;
      region.points.insert(region.points.end(), inner_.begin(), inner_.end());
      tessellate::TrimmedTriangles mesh =
          tessellate::triangulate_trimmed(std::move(region), grid_, clearance_);
      if (!mesh.conflict) return mesh;
      const auto border = static_cast<Index>(region_.points.size());
      const auto last = static_cast<Index>(border + inner_.size());
      Index unwanted = kNone;
      for (const tessellate::PlaneEdge& edge : {mesh.conflict->first, mesh.conflict->second}) {
        for (const Index end : edge) {
          if (end >= border && end < last) unwanted = end;
        }
      }
      if (unwanted == kNone) return mesh;
      inner_.erase(inner_.begin() + (unwanted - border));
    }
  }

  std::vector<Index> edges_of(const tessellate::RegionConflict& conflict) const {
    std::vector<Index> edges;
    for (const tessellate::PlaneEdge& edge : {conflict.first, conflict.second}) {
      for (const Index end : edge) {
        if (end >= border_.size()) continue;
        const auto before = std::find_if(region_.edges.begin(), region_.edges.end(),
                                         [&](const auto& other) { return other[1] == end; });
        for (const Index own : {border_[end].edge, border_[(*before)[0]].edge}) {
          if (own != kNone) edges.push_back(own);
        }
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }

  /// Adds points where triangles may be too far from the surface; false if none is.
  bool refine(const tessellate::TrimmedTriangles& mesh) {
    const std::size_t before = inner_.size();
    for (const Triangle& triangle : mesh.triangles) {
      split_shared_sides(mesh, triangle);
      const double far = kFarEnough * chord_;
      if (!may_be_far(mesh, triangle) || measured(mesh, triangle, far) <= far) continue;
      const Point wanted = divided_at(mesh, triangle);
      if (!is_beside_border(wanted)) inner_.push_back(wanted);
    }
    std::sort(inner_.begin() + static_cast<std::ptrdiff_t>(before), inner_.end());
    inner_.erase(std::unique(inner_.begin() + static_cast<std::ptrdiff_t>(before), inner_.end()),
                 inner_.end());
    return inner_.size() > before;
  }

  /// Where a triangle is divided: in the middle of its longest side that is no part of a loop, else
  /// in its own middle.
  Point divided_at(const tessellate::TrimmedTriangles& mesh, const Triangle& triangle) const {
    std::optional<Point> middle;
    double longest = 0;
    Point centre{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangle[k];
      const Index b = triangle[(k + 1) % 3];
      const Point& p = mesh.points[a];
      const Point& q = mesh.points[b];
      centre = {centre.x + p.x / 3, centre.y + p.y / 3, 0};
      const double size = (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
      if (is_border(a, b) || size <= longest) continue;
      longest = size;
      middle = Point{(p.x + q.x) / 2, (p.y + q.y) / 2, 0};
    }
    return middle.value_or(centre);
  }

  /// How far the middle of each chord around the face is from the surface's point there, in metres.
  void measure_chords() {
    for (const tessellate::PlaneEdge& edge : region_.edges) {
      const LoopPoint& a = border_[edge[0]];
      const LoopPoint& b = border_[edge[1]];
      const Parameters at{(a.at[0] + b.at[0]) / 2, (a.at[1] + b.at[1]) / 2};
      const Vector3 middle = (pool_.place(a.vertex) + pool_.place(b.vertex)) * 0.5;
      clearance_.of_edges.push_back(kChordErrors * length(point_at(surface_, at).place - middle));
    }
    clearance_.of_cell = kClearance;
  }

  /// Whether a point is so near to a chord around the face that the surface may pass the chord
  /// there: a triangle between them might stand outside the face.
  bool is_beside_border(const Point& p, std::span<const std::size_t> edges) const {
    return std::any_of(edges.begin(), edges.end(),
                       [&](std::size_t edge) { return is_beside(p, edge); });
  }

  bool is_beside(const Point& p, std::size_t edge) const {
    const double reach = clearance_.of_edges[edge];
    const Point& a = region_.points[region_.edges[edge][0]];
    const Point& b = region_.points[region_.edges[edge][1]];
    if (p.x < std::min(a.x, b.x) - reach || p.x > std::max(a.x, b.x) + reach ||
        p.y < std::min(a.y, b.y) - reach || p.y > std::max(a.y, b.y) + reach) {
      return false;
    }
    const double u = b.x - a.x;
    const double v = b.y - a.y;
    const double squared = u * u + v * v;
    const double along =
        squared > 0 ? std::clamp(((p.x - a.x) * u + (p.y - a.y) * v) / squared, 0.0, 1.0) : 0.0;
    const double x = p.x - a.x - along * u;
    const double y = p.y - a.y - along * v;
    return x * x + y * y <= reach * reach;
  }

  /// Puts a point into each side of a triangle inside the face that joins two points of another
  /// curved face: the other face may have the same side, although it lies elsewhere.
  void split_shared_sides(const tessellate::TrimmedTriangles& mesh, const Triangle& triangle) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangle[k];
      const Index b = triangle[(k + 1) % 3];
      if (a >= border_.size() || b >= border_.size() || is_border(a, b)) continue;
      if (!neighbours_.share(border_[a].vertex, border_[b].vertex)) continue;
      const Point& p = mesh.points[a];
      const Point& q = mesh.points[b];
      const Point middle{(p.x + q.x) / 2, (p.y + q.y) / 2, 0};
      if (!is_beside_border(middle)) inner_.push_back(middle);
    }
  }

  bool is_beside_border(const Point& p) const { return is_beside_border(p, edges_near_row(p.y)); }

  bool is_border(Index a, Index b) const {
    const auto border = static_cast<Index>(region_.points.size());
    if (a >= border || b >= border) return false;
    return region_.edges[a][1] == b || region_.edges[b][1] == a;
  }

  /// Whether the bound of the second derivatives allows a triangle to be too far from the surface.
  bool may_be_far(const tessellate::TrimmedTriangles& mesh, const Triangle& triangle) const {
    Parameters low = parameters_of(mesh.points[triangle[0]]);
    Parameters high = low;
    for (const Index corner : triangle) {
      const Parameters at = parameters_of(mesh.points[corner]);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], at[axis]);
        high[axis] = std::max(high[axis], at[axis]);
      }
    }
    const double u = high[0] - low[0];
    const double v = high[1] - low[1];
    const SecondDerivatives bend = bends_.over(low, high);
    return (bend.uu * u * u + 2 * bend.uv * u * v + bend.vv * v * v) / 8 > chord_;
  }

  /// How far a place is from the surface, or more: from the nearest of a few points of it, found by
  /// steps of Gauss and Newton. Half of the chord is near enough.
  double distance_from(Parameters at, const Vector3& place) const {
    double least = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kMostSteps; ++step) {
      const SurfacePoint point = point_at(surface_, at);
      const Vector3 offset = place - point.place;
      const double distance = length(offset);
      if (!(distance < least)) break;
      least = distance;
      if (least <= chord_ / 2) break;
      const double uu = dot(point.along_u, point.along_u);
      const double uv = dot(point.along_u, point.along_v);
      const double vv = dot(point.along_v, point.along_v);
      const double determinant = uu * vv - uv * uv;
      if (!(determinant > 0)) break;
      const double u = dot(offset, point.along_u);
      const double v = dot(offset, point.along_v);
      at = {at[0] + (u * vv - v * uv) / determinant, at[1] + (v * uu - u * uv) / determinant};
    }
    return least;
  }

  /// The bound allows for more than surfaces do: the largest distance of points spread over a
  /// triangle from the surface, or one that is more than enough.
  double measured(const tessellate::TrimmedTriangles& mesh, const Triangle& triangle,
                  double enough) const {
    double most = 0;
    std::array<Parameters, 3> at;
    std::array<Vector3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] = parameters_of(mesh.points[triangle[k]]);
      corners[k] = point_at(surface_, at[k]).place;
    }
    for (std::size_t i = 0; i <= kMeasured; ++i) {
      for (std::size_t j = 0; i + j <= kMeasured; ++j) {
        const bool is_corner = i == kMeasured || j == kMeasured || i + j == 0;
        if (is_corner) continue;
        const std::array<double, 3> weights{
            static_cast<double>(i) / static_cast<double>(kMeasured),
            static_cast<double>(j) / static_cast<double>(kMeasured),
            static_cast<double>(kMeasured - i - j) / static_cast<double>(kMeasured)};
        Parameters place{};
        Vector3 flat{};
        for (std::size_t k = 0; k < 3; ++k) {
          place = {place[0] + weights[k] * at[k][0], place[1] + weights[k] * at[k][1]};
          flat = flat + corners[k] * weights[k];
        }
        most = std::max(most, distance_from(place, flat));
        if (most > enough) return most;
      }
    }
    return most;
  }

  /// The edges whose clearance keeps a triangle from being divided.
  void add_coarse_edges(const tessellate::TrimmedTriangles& mesh, const Triangle& triangle) {
    const Point wanted = divided_at(mesh, triangle);
    for (const std::size_t edge : edges_near_row(wanted.y)) {
      const Index own = border_[region_.edges[edge][0]].edge;
      if (own != kNone && is_beside(wanted, edge)) result_.coarse.push_back(own);
    }
  }

  void take(const tessellate::TrimmedTriangles& mesh, bool is_flipped) {
    std::vector<Index> vertex(mesh.points.size());
    for (Index i = 0; i < mesh.points.size(); ++i) {
      vertex[i] = i < border_.size()
                      ? border_[i].vertex
                      : pool_.add(point_at(surface_, parameters_of(mesh.points[i])).place);
    }
    result_.gap = loops_.gap;
    for (const Triangle& t : mesh.triangles) {
      Triangle triangle{vertex[t[0]], vertex[t[1]], vertex[t[2]]};
      if (is_flipped) std::swap(triangle[1], triangle[2]);
      const bool is_collapsed =
          triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
      if (is_collapsed) continue;
      result_.triangles.push_back(triangle);
      measure_error(mesh, t);
      if (may_be_far(mesh, t) && measured(mesh, t, chord_) > chord_) add_coarse_edges(mesh, t);
    }
    std::sort(result_.coarse.begin(), result_.coarse.end());
    result_.coarse.erase(std::unique(result_.coarse.begin(), result_.coarse.end()),
                         result_.coarse.end());
  }

  /// Measures how far the middle of a triangle is from the surface's point with its coordinates.
  void measure_error(const tessellate::TrimmedTriangles& mesh, const Triangle& t) {
    Parameters centre{};
    std::array<Vector3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Parameters at = parameters_of(mesh.points[t[k]]);
      centre = {centre[0] + at[0] / 3, centre[1] + at[1] / 3};
      corners[k] = point_at(surface_, at).place;
    }
    const Vector3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double size = length(normal);
    if (!(size > 0)) return;
    const Vector3 offset = point_at(surface_, centre).place - corners[0];
    double error = std::abs(dot(offset, normal)) / size;
    // In a long triangle the point of the surface is not the nearest one.
    if (error > chord_) error = measured(mesh, t, std::numeric_limits<double>::infinity());
    result_.chord_error = std::max(result_.chord_error, error);
  }

  const Surface& surface_;
  Bends bends_;
  FaceLoops loops_;
  const FaceNeighbours& neighbours_;
  double chord_;
  std::size_t most_;
  VertexPool& pool_;
  Parameters low_{};
  Parameters high_{};
  Parameters scale_{};             // metres per unit of u and v, in the mean
  tessellate::Region region_;      // in metres
  std::vector<LoopPoint> border_;  // by point of the region
  tessellate::Clearance clearance_;
  tessellate::PlaneGrid grid_;
  std::vector<Point> inner_;  // points inside besides those of the grid
  FaceTriangles result_;
};

/// A cone has two halves, which meet in its tip: the one on which a place lies.
Surface half_with(const Surface& surface, const Vector3& place, double tolerance) {
  const std::vector<Pole> poles = poles_of(surface);
  if (!surface.is_endless[1] || poles.size() != 1) return surface;
  const Vector3 tip = poles[0].place;
  const double u = surface.u_breaks.front();
  const double v = surface.v_breaks.back();
  const Vector3 across =
      point_at(surface, {u, v}).place - point_at(surface, {u + surface.period(0) / 2, v}).place;
  const Vector3 axis = across * (1 / length(across));
  // Half a turn about a line through the tip.
  Affine turn;
  for (std::size_t i = 0; i < 3; ++i) {
    turn.columns[i] = axis * (2 * axis[i]);
    turn.columns[i][i] -= 1;
  }
  turn.shift = tip - moved(turn, tip);
  Surface other = surface;
  move(turn, other);
  const double gap = Inverter(surface, tolerance).invert(place, {}).gap;
  return Inverter(other, tolerance).invert(place, {}).gap < gap ? other : surface;
}

}  // namespace

Result<FaceTriangles> tessellate_face(const BoundaryFace& face,
                                      const std::vector<EdgeSamples>& edges,
                                      const FaceNeighbours& neighbours, double tolerance,
                                      double chord, std::size_t most, VertexPool& pool) {
  Surface surface = *face.surface;
  if (!face.loops.empty() && !face.loops[0].empty()) {
    const EdgeSamples& samples = edges[face.loops[0][0].edge];
    const bool is_at_tip = length(pool.place(samples.front()) - pool.place(samples.back())) == 0;
    surface = half_with(
        surface, pool.place(is_at_tip ? samples[samples.size() / 2] : samples.back()), tolerance);
  }
  auto loops = loops_of(face, surface, false, edges, tolerance, chord, pool);
  bool is_transposed = false;
  if (!loops && winds_around_v(loops.error())) {
    is_transposed = true;
    surface = transposed(surface);
    loops = loops_of(face, surface, true, edges, tolerance, chord, pool);
  }
  if (!loops) return std::move(loops).error();
  const bool is_turned = loops->is_turned;
  FaceMesh mesh(surface, *std::move(loops), neighbours, chord, most, pool);
  return mesh.run((face.is_along_surface == is_transposed) != is_turned);
}

}  // namespace watertight::surfaces
