// SPDX-License-Identifier: GPL-3.0-or-later
//
// The corners of the overlap of two solids are corners of one solid that are not outside the other,
// and points where an edge of one solid meets a triangle of the other. Triangles that have a corner
// of the overlap in common belong to one part of the overlap. The convex hull of a part's corners
// contains the part, so the extent of the hull along any direction is an upper bound of the extent
// of the part: the depth is never too small.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "geometry/disjoint_sets.h"
#include "geometry/predicates/predicates.h"
#include "validate/overlap/solid_overlap.h"
#include "validate/planarity.h"

namespace watertight::validate {
namespace {

/// With this many corners or more, the depth is the least extent of the common box.
constexpr std::size_t kMostCorners = 100'000;
/// The largest number of directions along which the extent of a part is measured.
constexpr std::size_t kMostNormals = 64;
/// The largest number of pairs of corners whose middle is tried as a witness.
constexpr std::size_t kMostTries = 64;

using Metres = Vector;

Metres triangle_normal(const Metres& a, const Metres& b, const Metres& c) {
  return unit_normal(b - a, c - a);
}

/// The box that the boxes of two overlapping boundaries have in common.
Box common_box(const RegionSurface& first, const RegionSurface& second) {
  Box common;
  for (int axis = 0; axis < 3; ++axis) {
    common.min[axis] = std::max(first.box().min[axis], second.box().min[axis]);
    common.max[axis] = std::min(first.box().max[axis], second.box().max[axis]);
  }
  return common;
}

/// The point where the segment pq meets the triangle, if p and q are on different sides of its
/// plane; else nothing.
std::optional<Point> crossing(const Point& p, const Point& q, const std::array<Point, 3>& t) {
  const int at_p = geometry::orient3d(t[0], t[1], t[2], p);
  if (at_p == 0 || at_p * geometry::orient3d(t[0], t[1], t[2], q) >= 0) return std::nullopt;
  std::array<int, 3> turns{};
  for (std::size_t i = 0; i < 3; ++i) turns[i] = geometry::orient3d(p, q, t[i], t[(i + 1) % 3]);
  const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
  if (*least < 0 && *most > 0) return std::nullopt;
  const auto from_p = [&](const Point& r) { return geometry::difference(r, p); };
  const Metres normal = triangle_normal(from_p(t[0]), from_p(t[1]), from_p(t[2]));
  const double along = dot(normal, from_p(q));
  const double share = along == 0 ? 0.5 : std::clamp(dot(normal, from_p(t[0])) / along, 0.0, 1.0);
  return Point{p.x + share * (q.x - p.x), p.y + share * (q.y - p.y), p.z + share * (q.z - p.z)};
}

class OverlapMeasurer {
 public:
  OverlapMeasurer(const RegionSurface& first, const RegionSurface& second,
                  const StepMetres& step_metres)
      : surfaces_{&first, &second},
        step_metres_(step_metres),
        common_(common_box(first, second)),
        parts_(0) {
    for (std::size_t side = 0; side < 2; ++side) {
      triangles_[side] = surfaces_[side]->triangles_in(common_);
    }
    parts_ = geometry::DisjointSets(triangles_[0].size() + triangles_[1].size());
  }

  OverlapExtent run() {
    add_vertices(0);
    add_vertices(1);
    add_crossings(0);
    add_crossings(1);
    OverlapExtent extent;
    extent.depth = corners_.size() < kMostCorners ? largest_depth(extent) : depth_of_box();
    return extent;
  }

 private:
  struct Corner {
    Point at;
    Index triangle;  // the number of a triangle that has this corner
  };
  /// The number of the i-th triangle of a side: the triangles of the first solid come before those
  /// of the second.
  Index number(std::size_t side, std::size_t i) const {
    return static_cast<Index>(side * triangles_[0].size() + i);
  }
  std::array<Point, 3> triangle(Index number) const {
    const std::size_t count = triangles_[0].size();
    return number < count ? surfaces_[0]->corners(triangles_[0][number])
                          : surfaces_[1]->corners(triangles_[1][number - count]);
  }
  Metres metres(const Point& p) const {
    Metres result{};
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = p[axis] - common_.min[axis];
      for (std::size_t row = 0; row < 3; ++row) {
        result[row] += step_metres_[row][static_cast<std::size_t>(axis)] * steps;
      }
    }
    return result;
  }
  void add_vertices(std::size_t side);
  void add_crossings(std::size_t side);
  double largest_depth(OverlapExtent& extent);
  double depth_of(std::span<const Corner> corners, std::span<const Index> members) const;
  std::optional<Point> witness(std::span<const Corner> corners) const;
  double depth_of_box() const;

  std::array<const RegionSurface*, 2> surfaces_;
  StepMetres step_metres_;
  Box common_;
  std::array<std::vector<Index>, 2> triangles_;
  geometry::DisjointSets parts_;  // the parts of the overlap, as sets of triangle numbers
  std::vector<Corner> corners_;
};

/// The least extent of the common box along the axes of the world.
double OverlapMeasurer::depth_of_box() const {
  Metres size{};
  for (int axis = 0; axis < 3; ++axis) {
    const double steps = common_.max[axis] - common_.min[axis];
    for (std::size_t row = 0; row < 3; ++row) {
      size[row] += std::abs(step_metres_[row][static_cast<std::size_t>(axis)]) * steps;
    }
  }
  return *std::min_element(size.begin(), size.end());
}

void OverlapMeasurer::add_vertices(std::size_t side) {
  const RegionSurface& own = *surfaces_[side];
  const RegionSurface& other = *surfaces_[1 - side];
  // Vertex -> true if it is a corner of the overlap, and the number of its first triangle.
  std::map<Index, std::pair<bool, Index>> seen;
  for (std::size_t i = 0; i < triangles_[side].size() && corners_.size() < kMostCorners; ++i) {
    for (const Index vertex : own.triangles()[triangles_[side][i]]) {
      const Point& p = own.vertices()[vertex];
      const auto [entry, is_new] = seen.try_emplace(vertex, false, number(side, i));
      auto& [is_corner, holder] = entry->second;
      if (is_new) {
        is_corner = common_.overlaps(Box{p, p}) && other.locate(p) != Location::outside;
        if (is_corner) corners_.push_back({p, holder});
      } else if (is_corner) {
        parts_.join(holder, number(side, i));
      }
    }
  }
}

/// Adds the points in which edges of one side meet triangles of the other side.
void OverlapMeasurer::add_crossings(std::size_t side) {
  const RegionSurface& own = *surfaces_[side];
  const RegionSurface& other = *surfaces_[1 - side];
  std::map<Index, std::size_t> position;  // triangle of the other side -> its index in the list
  for (std::size_t j = 0; j < triangles_[1 - side].size(); ++j) {
    position.emplace(triangles_[1 - side][j], j);
  }
  for (std::size_t i = 0; i < triangles_[side].size(); ++i) {
    const std::array<Point, 3> corners = own.corners(triangles_[side][i]);
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const Point& p = corners[edge];
      const Point& q = corners[(edge + 1) % 3];
      Box box;
      box.include(p);
      box.include(q);
      if (!box.overlaps(common_)) continue;
      for (const Index found : other.triangles_in(box)) {
        if (corners_.size() >= kMostCorners) return;
        const auto at = position.find(found);
        if (at == position.end()) continue;
        const auto point = crossing(p, q, other.corners(found));
        if (!point) continue;
        const Index holder = number(side, i);
        corners_.push_back({*point, holder});
        parts_.join(holder, number(1 - side, at->second));
      }
    }
  }
}

double OverlapMeasurer::depth_of(std::span<const Corner> corners,
                                 std::span<const Index> members) const {
  std::vector<Metres> points;
  points.reserve(corners.size());
  for (const Corner& corner : corners) points.push_back(metres(corner.at));
  std::vector<Metres> directions{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < members.size() && directions.size() < kMostNormals; ++i) {
    const std::array<Point, 3> t = triangle(members[i]);
    const Metres normal = triangle_normal(metres(t[0]), metres(t[1]), metres(t[2]));
    if (dot(normal, normal) < 0.5) continue;
    if (std::find(directions.begin(), directions.end(), normal) == directions.end()) {
      directions.push_back(normal);
    }
  }
  double depth = std::numeric_limits<double>::infinity();
  for (const Metres& direction : directions) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Metres& point : points) {
      const double at = dot(direction, point);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    depth = std::min(depth, high - low);
  }
  return std::min(depth, depth_of_box());
}

/// A point that is exactly inside both solids: the mean of all corners, or of two corners.
std::optional<Point> OverlapMeasurer::witness(std::span<const Corner> corners) const {
  const auto is_inside = [&](const Point& p) {
    return surfaces_[0]->locate(p) == Location::inside &&
           surfaces_[1]->locate(p) == Location::inside;
  };
  Point mean;
  for (const Corner& corner : corners) {
    for (int axis = 0; axis < 3; ++axis) {
      mean[axis] += corner.at[axis] / static_cast<double>(corners.size());
    }
  }
  if (is_inside(mean)) return mean;
  std::size_t tries = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t j = i + 1; j < corners.size() && tries < kMostTries; ++j, ++tries) {
      Point middle;
      for (int axis = 0; axis < 3; ++axis) {
        middle[axis] = corners[i].at[axis] / 2 + corners[j].at[axis] / 2;
      }
      if (is_inside(middle)) return middle;
    }
  }
  return std::nullopt;
}

/// The largest depth of all parts. The witness is from the deepest part in which one is found.
double OverlapMeasurer::largest_depth(OverlapExtent& extent) {
  const auto root_of = [&](const Corner& corner) { return parts_.root(corner.triangle); };
  std::stable_sort(corners_.begin(), corners_.end(),
                   [&](const Corner& a, const Corner& b) { return root_of(a) < root_of(b); });
  std::map<Index, std::vector<Index>> members;
  const std::size_t count = triangles_[0].size() + triangles_[1].size();
  for (Index i = 0; i < count; ++i) members[parts_.root(i)].push_back(i);
  double largest = 0;
  double witnessed = -1;
  for (std::size_t begin = 0; begin < corners_.size();) {
    const Index root = root_of(corners_[begin]);
    std::size_t end = begin + 1;
    while (end < corners_.size() && root_of(corners_[end]) == root) ++end;
    const std::span<const Corner> part =
        std::span<const Corner>(corners_).subspan(begin, end - begin);
    const double depth = depth_of(part, members[root]);
    largest = std::max(largest, depth);
    if (depth > witnessed) {
      if (const auto found = witness(part)) {
        extent.witness = found;
        witnessed = depth;
      }
    }
    begin = end;
  }
  return largest;
}

Metres moved(const Metres& a, const Metres& direction, double factor) {
  return {a[0] + factor * direction[0], a[1] + factor * direction[1], a[2] + factor * direction[2]};
}

double distance_to_segment(const Metres& p, const Metres& a, const Metres& b) {
  const Metres along = b - a;
  const double squared = dot(along, along);
  const double share = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0;
  const Metres offset = p - moved(a, along, share);
  return std::sqrt(dot(offset, offset));
}

double distance_to_triangle(const Metres& p, const std::array<Metres, 3>& t) {
  const Metres normal = triangle_normal(t[0], t[1], t[2]);
  double distance = std::numeric_limits<double>::infinity();
  bool is_above = true;  // the foot of the perpendicular lies in the triangle
  for (std::size_t i = 0; i < 3; ++i) {
    const Metres& a = t[i];
    const Metres& b = t[(i + 1) % 3];
    distance = std::min(distance, distance_to_segment(p, a, b));
    const Metres along = b - a;
    const Metres inward = cross(normal, along);
    is_above = is_above && dot(inward, p - a) >= 0;
  }
  return is_above ? std::abs(dot(normal, p - t[0])) : distance;
}

/// Searches for a point of one boundary that lies further inside the other solid than rounding can
/// move it, and, where boundaries lie on each other, for a point that far inside both solids. Where
/// two solids overlap, an edge of one enters the other, or both boundaries lie on each other.
class OverlapProver {
 public:
  OverlapProver(const RegionSurface& first, const RegionSurface& second,
                const StepMetres& step_metres, double rounding)
      : surfaces_{&first, &second},
        step_metres_(step_metres),
        rounding_(rounding),
        common_(common_box(first, second)) {}

  bool run() const { return finds_point(0) || finds_point(1); }

 private:
  Metres metres(const Point& p) const {
    return {(p.x - common_.min.x) * step_metres_[0][0], (p.y - common_.min.y) * step_metres_[1][1],
            (p.z - common_.min.z) * step_metres_[2][2]};
  }

  bool finds_point(std::size_t side) const {
    const std::vector<Index> triangles = surfaces_[side]->triangles_in(common_);
    return std::any_of(triangles.begin(), triangles.end(), [&](Index triangle) {
      const std::array<Point, 3> t = surfaces_[side]->corners(triangle);
      if (is_behind_inside(t)) return true;
      for (std::size_t edge = 0; edge < 3; ++edge) {
        if (enters(t[edge], t[(edge + 1) % 3], *surfaces_[1 - side])) return true;
      }
      return is_deep(centroid(t), *surfaces_[1 - side], 2 * rounding_);
    });
  }

  static Point centroid(const std::array<Point, 3>& t) {
    Point result;
    for (const Point& p : t) {
      for (int axis = 0; axis < 3; ++axis) result[axis] += p[axis] / 3;
    }
    return result;
  }

  /// True if a point a little behind the middle of a triangle is deep inside both solids.
  bool is_behind_inside(const std::array<Point, 3>& t) const {
    const Metres normal = triangle_normal(metres(t[0]), metres(t[1]), metres(t[2]));
    Point p = centroid(t);
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      p[axis] -= 8 * rounding_ * normal[at] / step_metres_[at][at];
    }
    return is_deep(p, *surfaces_[0], rounding_) && is_deep(p, *surfaces_[1], rounding_);
  }

  /// True if the segment pq has a point deep inside the other solid. Tried are p and the middles of
  /// the pieces into which the surface of the other solid cuts the segment.
  bool enters(const Point& p, const Point& q, const RegionSurface& other) const {
    Box box;
    box.include(p);
    box.include(q);
    if (!box.overlaps(common_)) return false;
    std::vector<double> shares{0, 1};
    const Metres along = metres(q) - metres(p);
    for (const Index found : other.triangles_in(box)) {
      const auto point = crossing(p, q, other.corners(found));
      if (!point) continue;
      shares.push_back(dot(metres(*point) - metres(p), along) / dot(along, along));
    }
    std::sort(shares.begin(), shares.end());
    for (std::size_t i = 0; i + 1 < shares.size(); ++i) {
      const double share = shares[i] / 2 + shares[i + 1] / 2;
      const Point middle{p.x + share * (q.x - p.x), p.y + share * (q.y - p.y),
                         p.z + share * (q.z - p.z)};
      if (is_deep(middle, other, 2 * rounding_)) return true;
    }
    return is_deep(p, other, 2 * rounding_);
  }

  /// True if p is inside the surface and further than `distance` metres from all its triangles.
  bool is_deep(const Point& p, const RegionSurface& surface, double distance) const {
    if (!common_.overlaps(Box{p, p}) || surface.locate(p) != Location::inside) return false;
    Box near{p, p};
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      near.min[axis] -= distance / step_metres_[at][at];
      near.max[axis] += distance / step_metres_[at][at];
    }
    const std::vector<Index> triangles = surface.triangles_in(near);
    return std::all_of(triangles.begin(), triangles.end(), [&](Index triangle) {
      const std::array<Point, 3> t = surface.corners(triangle);
      return distance_to_triangle(metres(p), {metres(t[0]), metres(t[1]), metres(t[2])}) > distance;
    });
  }

  std::array<const RegionSurface*, 2> surfaces_;
  StepMetres step_metres_;
  double rounding_;
  Box common_;
};

}  // namespace

bool is_overlap_certain(const RegionSurface& first, const RegionSurface& second,
                        const StepMetres& step_metres, double rounding) {
  return OverlapProver(first, second, step_metres, rounding).run();
}

OverlapExtent measure_overlap(const RegionSurface& first, const RegionSurface& second,
                              const StepMetres& step_metres) {
  return OverlapMeasurer(first, second, step_metres).run();
}

}  // namespace watertight::validate
