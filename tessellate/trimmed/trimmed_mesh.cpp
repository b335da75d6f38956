// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/trimmed/trimmed_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/assert.h"
#include "tessellate/trimmed/neighbours.h"
#include "tessellate/trimmed/plane_predicates.h"

namespace watertight::tessellate {
namespace {

/// Whether a point lies in a triangle or on its sides. Requires a left turn.
bool is_in(const std::array<Point, 3>& corners, const Point& p) {
  return turn(corners[0], corners[1], p) >= 0 && turn(corners[1], corners[2], p) >= 0 &&
         turn(corners[2], corners[0], p) >= 0;
}

/// The lines from `low` to `high`, both included.
std::pair<std::size_t, std::size_t> lines_between(const std::vector<double>& lines, double low,
                                                  double high) {
  const auto first = std::lower_bound(lines.begin(), lines.end(), low);
  const auto last = std::upper_bound(first, lines.end(), high);
  return {static_cast<std::size_t>(first - lines.begin()),
          static_cast<std::size_t>(last - lines.begin())};
}

/// For each point the sides of a box beyond which it lies, as bits: the outcodes of D. Cohen and
/// I. Sutherland.
std::vector<std::uint8_t> outcodes_of(std::span<const Point> points, const geometry::Box& box) {
  std::vector<std::uint8_t> codes(points.size());
  std::transform(points.begin(), points.end(), codes.begin(), [&](const Point& p) {
    const unsigned left = p.x < box.min.x ? 1U : 0U;
    const unsigned right = p.x > box.max.x ? 2U : 0U;
    const unsigned below = p.y < box.min.y ? 4U : 0U;
    const unsigned above = p.y > box.max.y ? 8U : 0U;
    return static_cast<std::uint8_t>(left | right | below | above);
  });
  return codes;
}

/// Whether a triangle lies beyond one side of the box of the outcodes.
bool is_beyond_a_side(const Triangle& triangle, std::span<const std::uint8_t> outcodes) {
  return (outcodes[triangle[0]] & outcodes[triangle[1]] & outcodes[triangle[2]]) != 0;
}

bool has(const std::vector<PlaneEdge>& edges, const PlaneEdge& edge) {
  return std::find(edges.begin(), edges.end(), edge) != edges.end();
}

}  // namespace

TrimmedMesh::TrimmedMesh(Region loops, PlaneGrid grid) : grid_(std::move(grid)) {
  const std::size_t samples = loops.points.size();
  next_.assign(samples, kNone);
  previous_.assign(samples, kNone);
  for (const auto& [from, to] : loops.edges) {
    WATERTIGHT_ASSERT(next_[from] == kNone && previous_[to] == kNone);
    next_[from] = to;
    previous_[to] = from;
  }
  TrimmedTriangles made = triangulate_trimmed(std::move(loops), grid_);
  points_ = std::move(made.points);
  next_.resize(points_.size(), kNone);
  previous_.resize(points_.size(), kNone);
  is_grid_point_.assign(points_.size(), true);
  std::fill_n(is_grid_point_.begin(), samples, false);
  triangles_ = std::move(made.triangles);
  twins_ = twins_of(triangles_, points_.size());
  conflict_ = made.conflict;
}

std::optional<RegionConflict> TrimmedMesh::insert_sample(Index before, const Point& place) {
  const Index after = next_[before];
  WATERTIGHT_ASSERT(after != kNone);
  const Index middle = add_point(place);
  is_grid_point_[middle] = false;
  Change change;
  change.coming = {middle};
  change.old_border = {{before, after}};
  change.new_border = {{before, middle}, {middle, after}};
  const bool is_gained = turn(points_[before], points_[after], place) < 0;
  auto conflict = change_loop(std::move(change), before, middle, after, is_gained);
  if (conflict) return conflict;
  next_[before] = previous_[after] = middle;
  next_[middle] = after;
  previous_[middle] = before;
  return std::nullopt;
}

std::optional<RegionConflict> TrimmedMesh::remove_sample(Index sample) {
  const Index before = previous_[sample];
  const Index after = next_[sample];
  WATERTIGHT_ASSERT(before != kNone && after != kNone);
  if (next_[after] == before) {
    return RegionConflict{RegionConflict::Kind::not_closed, {sample, after}, {kNone, kNone}};
  }
  Change change;
  change.going = {sample};
  change.old_border = {{before, sample}, {sample, after}};
  change.new_border = {{before, after}};
  const bool is_gained = turn(points_[before], points_[after], points_[sample]) > 0;
  auto conflict = change_loop(std::move(change), before, sample, after, is_gained);
  if (conflict) return conflict;
  next_[before] = after;
  previous_[after] = before;
  return std::nullopt;
}

/// The region gains or loses the triangle between three points of a loop.
std::optional<RegionConflict> TrimmedMesh::change_loop(Change change, Index before, Index middle,
                                                       Index after, bool is_gained) {
  std::array<Index, 3> place{before, middle, after};
  const int side = turn(points_[before], points_[middle], points_[after]);
  if (side < 0) std::swap(place[1], place[2]);
  // Every edge of a loop is a side of a triangle: each loop that the change may meet is in the gap.
  const auto outcodes = outcodes_of(
      points_,
      geometry::box_of(std::array{points_[place[0]], points_[place[1]], points_[place[2]]}));
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (is_beyond_a_side(triangles_[t], outcodes)) continue;
    if (may_meet(triangles_[t], place)) change.triangles.push_back(t);
  }
  if (side != 0 && is_gained) add_grid_points(place, change);
  if (side != 0 && !is_gained) remove_grid_points(place, change);
  auto conflict = apply(change);
  if (!conflict) return std::nullopt;
  for (const Index point : change.coming) free_point(point);
  return conflict;
}

/// False if the place lies beyond a side of the triangle.
bool TrimmedMesh::may_meet(const Triangle& triangle, const std::array<Index, 3>& place) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const Point& a = points_[triangle[k]];
    const Point& b = points_[triangle[(k + 1) % 3]];
    const bool is_beyond = std::all_of(
        place.begin(), place.end(), [&](Index corner) { return turn(a, b, points_[corner]) < 0; });
    if (is_beyond) return false;
  }
  return true;
}

/// The grid points of a triangle that the region gains, but for those on its new border.
void TrimmedMesh::add_grid_points(const std::array<Index, 3>& place, Change& change) {
  const std::array<Point, 3> corners{points_[place[0]], points_[place[1]], points_[place[2]]};
  const geometry::Box box = geometry::box_of(corners);
  const auto [first_u, last_u] = lines_between(grid_.us, box.min.x, box.max.x);
  const auto [first_v, last_v] = lines_between(grid_.vs, box.min.y, box.max.y);
  for (std::size_t k = first_v; k < last_v; ++k) {
    for (std::size_t j = first_u; j < last_u; ++j) {
      const Point p{grid_.us[j], grid_.vs[k], 0};
      if (!is_in(corners, p)) continue;
      const bool is_on_border = std::any_of(
          change.new_border.begin(), change.new_border.end(),
          [&](const PlaneEdge& edge) { return turn(points_[edge[0]], points_[edge[1]], p) == 0; });
      if (!is_on_border) change.coming.push_back(add_point(p));
    }
  }
}

/// The grid points of a triangle that the region loses.
void TrimmedMesh::remove_grid_points(const std::array<Index, 3>& place, Change& change) const {
  const std::array<Point, 3> corners{points_[place[0]], points_[place[1]], points_[place[2]]};
  for (const std::uint32_t t : change.triangles) {
    for (const Index corner : triangles_[t]) {
      if (is_grid_point_[corner] && is_in(corners, points_[corner])) change.going.push_back(corner);
    }
  }
  std::sort(change.going.begin(), change.going.end());
  change.going.erase(std::unique(change.going.begin(), change.going.end()), change.going.end());
}

bool TrimmedMesh::add_grid_line(std::size_t axis, double at) {
  std::vector<double>& own = lines(axis);
  const auto place = std::lower_bound(own.begin(), own.end(), at);
  if (place != own.end() && *place == at) return false;
  own.insert(place, at);
  Change change;
  change.is_along_u = axis == 1;
  std::vector<Index> point_of_line(lines(1 - axis).size(), kNone);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const geometry::Box line = axis == 0 ? geometry::Box{{at, -kFar, 0}, {at, kFar, 0}}
                                       : geometry::Box{{-kFar, at, 0}, {kFar, at, 0}};
  const auto outcodes = outcodes_of(points_, line);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (is_beyond_a_side(triangles_[t], outcodes)) continue;
    add_line_points(axis, at, t, point_of_line, change);
  }
  const auto conflict = apply(change);
  WATERTIGHT_ASSERT(!conflict);
  static_cast<void>(conflict);
  return true;
}

/// The points of a new line in a triangle, or on its sides inside the loops.
void TrimmedMesh::add_line_points(std::size_t axis, double at, std::uint32_t triangle,
                                  std::vector<Index>& point_of_line, Change& change) {
  const int across = static_cast<int>(1 - axis);
  const Triangle& t = triangles_[triangle];
  const std::array<Point, 3> corners{points_[t[0]], points_[t[1]], points_[t[2]]};
  const auto [from, to] = std::minmax({corners[0][across], corners[1][across], corners[2][across]});
  const std::vector<double>& others = lines(1 - axis);
  const auto [first, last] = lines_between(others, from, to);
  for (std::size_t k = first; k < last; ++k) {
    const Point p = axis == 0 ? Point{at, others[k], 0} : Point{others[k], at, 0};
    bool is_inside = true;
    std::size_t touched = 0;  // sides; two meet in a corner
    for (std::size_t side = 0; is_inside && side < 3; ++side) {
      const int turned = turn(corners[side], corners[(side + 1) % 3], p);
      if (turned == 0) ++touched;
      const bool has_other_side = twins_[3 * std::size_t{triangle} + side] != kNone;
      is_inside = turned > 0 || (turned == 0 && touched < 2 && has_other_side);
    }
    if (!is_inside) continue;
    if (change.triangles.empty() || change.triangles.back() != triangle) {
      change.triangles.push_back(triangle);
    }
    if (point_of_line[k] != kNone) continue;
    point_of_line[k] = add_point(p);
    change.coming.push_back(point_of_line[k]);
  }
}

bool TrimmedMesh::remove_grid_line(std::size_t axis, double at) {
  std::vector<double>& own = lines(axis);
  const auto place = std::lower_bound(own.begin(), own.end(), at);
  if (place == own.end() || *place != at) return false;
  own.erase(place);
  Change change;
  change.is_along_u = axis == 1;
  std::vector<bool> goes(points_.size(), false);
  for (Index point = 0; point < points_.size(); ++point) {
    goes[point] = is_grid_point_[point] && points_[point][static_cast<int>(axis)] == at;
    if (goes[point]) change.going.push_back(point);
  }
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& corners = triangles_[t];
    if (goes[corners[0]] || goes[corners[1]] || goes[corners[2]]) change.triangles.push_back(t);
  }
  const auto conflict = apply(change);
  WATERTIGHT_ASSERT(!conflict);
  static_cast<void>(conflict);
  return true;
}

/// Deletes triangles, sweeps the gap and flips edges from there; on conflict nothing changes.
std::optional<RegionConflict> TrimmedMesh::apply(const Change& change) {
  if (change.triangles.empty() && change.new_border.empty()) return std::nullopt;
  const Gap gap = gap_of(change);
  RegionTriangles swept =
      change.is_along_u ? sweep_region_from_left(gap.region) : sweep_region(gap.region);
  if (swept.conflict) {
    for (PlaneEdge* edge : {&swept.conflict->first, &swept.conflict->second}) {
      for (Index& end : *edge) end = end == kNone ? kNone : gap.points[end];
    }
    return swept.conflict;
  }
  splice(change, gap, swept.triangles);
  for (const Index point : change.going) free_point(point);
  return std::nullopt;
}

TrimmedMesh::Gap TrimmedMesh::gap_of(const Change& change) const {
  Gap gap;
  std::vector<Index> number(points_.size(), kNone);
  std::vector<bool> goes(points_.size(), false);
  for (const Index point : change.going) goes[point] = true;
  const auto number_of = [&](Index point) {
    if (number[point] == kNone) {
      number[point] = static_cast<Index>(gap.points.size());
      gap.points.push_back(point);
      gap.region.points.push_back(points_[point]);
    }
    return number[point];
  };
  const auto add_edge = [&](Index from, Index to, std::uint32_t beyond) {
    gap.region.edges.push_back({number_of(from), number_of(to)});
    gap.rim.push_back(beyond);
  };
  std::vector<bool> is_going(triangles_.size(), false);
  for (const std::uint32_t t : change.triangles) is_going[t] = true;
  for (const std::uint32_t t : change.triangles) {
    for (std::uint32_t edge = 3 * t; edge < 3 * t + 3; ++edge) {
      const Index from = start_of(triangles_, edge);
      const Index to = start_of(triangles_, next_edge(edge));
      if (!goes[from]) number_of(from);
      const std::uint32_t twin = twins_[edge];
      if (twin == kNone ? has(change.old_border, {from, to}) : is_going[twin / 3]) continue;
      add_edge(from, to, twin);
    }
  }
  for (const Index point : change.coming) number_of(point);
  for (const auto& [from, to] : change.new_border) add_edge(from, to, kNone);
  return gap;
}

/// Puts the triangles of a gap in the place of those that go.
void TrimmedMesh::splice(const Change& change, const Gap& gap,
                         std::span<const Triangle> triangles) {
  const std::size_t kept = triangles_.size();
  const auto slot_of = [&](std::size_t i) {
    return i < change.triangles.size()
               ? change.triangles[i]
               : static_cast<std::uint32_t>(kept + i - change.triangles.size());
  };
  if (triangles.size() > change.triangles.size()) {
    triangles_.resize(kept + triangles.size() - change.triangles.size());
    twins_.resize(3 * triangles_.size(), kNone);
  }
  // The edges of the new triangles, and those of the triangles beyond the gap.
  std::vector<PlaneEdge> edges;
  std::vector<std::uint32_t> places;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      edges.push_back({triangles[i][k], triangles[i][(k + 1) % 3]});
      places.push_back(3 * slot_of(i) + k);
      triangles_[slot_of(i)][k] = gap.points[triangles[i][k]];
    }
  }
  const std::size_t inside = edges.size();
  for (std::size_t i = 0; i < gap.rim.size(); ++i) {
    if (gap.rim[i] == kNone) continue;
    edges.push_back({gap.region.edges[i][1], gap.region.edges[i][0]});
    places.push_back(gap.rim[i]);
  }
  const auto opposites = opposites_of(edges, gap.points.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    twins_[places[i]] = opposites[i] == kNone ? kNone : places[opposites[i]];
  }
  for (std::size_t i = change.triangles.size(); i > triangles.size(); --i) {
    const auto last = static_cast<std::uint32_t>(triangles_.size() - 1);
    if (change.triangles[i - 1] != last) move_triangle(last, change.triangles[i - 1]);
    triangles_.pop_back();
    twins_.resize(3 * triangles_.size());
  }
  restore_delaunay(points_, triangles_, twins_, std::span(places).first(inside));
}

void TrimmedMesh::move_triangle(std::uint32_t from, std::uint32_t to) {
  triangles_[to] = triangles_[from];
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t twin = twins_[3 * from + k];
    twins_[3 * to + k] = twin;
    if (twin != kNone) twins_[twin] = 3 * to + k;
  }
}

Index TrimmedMesh::add_point(const Point& place) {
  Index point = static_cast<Index>(points_.size());
  if (free_.empty()) {
    points_.push_back(place);
    is_grid_point_.push_back(true);
    next_.push_back(kNone);
    previous_.push_back(kNone);
  } else {
    point = free_.back();
    free_.pop_back();
    points_[point] = place;
    is_grid_point_[point] = true;
  }
  return point;
}

void TrimmedMesh::free_point(Index point) {
  is_grid_point_[point] = false;
  next_[point] = previous_[point] = kNone;
  free_.push_back(point);
}

}  // namespace watertight::tessellate
