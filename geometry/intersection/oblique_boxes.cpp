// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/intersection/oblique_boxes.h"

#include <cmath>
#include <optional>

#include "geometry/vector3.h"

namespace watertight::geometry {
namespace {

/// More than the rounding error of every double in this file. Unit vectors and scaled coordinates
/// along axes are about 1 at most and take some ten operations with an error of 2^-53 each.
constexpr double kMargin = 1e-14;

/// (p - q) / 2, which cannot overflow.
Vector3 half_difference(const Point& p, const Point& q) {
  return {0.5 * p.x - 0.5 * q.x, 0.5 * p.y - 0.5 * q.y, 0.5 * p.z - 0.5 * q.z};
}

double largest_component(const Vector3& v) {
  return std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2]));
}

/// The unit vector in the direction of v. Nothing if v is zero, or so short that doubles do not
/// hold its direction.
std::optional<Vector3> unit(Vector3 v) {
  constexpr double kSmallest = 1e-290;
  const double largest = largest_component(v);
  if (!(largest > kSmallest)) return std::nullopt;
  for (double& component : v) component /= largest;
  const double length = std::sqrt(dot(v, v));
  for (double& component : v) component /= length;
  return v;
}

BoxMember<6> extended(const BoxMember<3>& box) {
  BoxMember<6> result{};
  result.triangle = box.triangle;
  std::copy(box.low.begin(), box.low.end(), result.low.begin());
  std::copy(box.high.begin(), box.high.end(), result.high.begin());
  return result;
}

void set_bounds(BoxMember<6>& box, std::size_t axis, double low, double high) {
  box.low[axis] = rounded_down(low - kMargin);
  box.high[axis] = rounded_up(high + kMargin);
}

/// The dominant direction of a matrix that is a sum of v v^T, by power iteration. The result is a
/// unit vector even if the iteration does not converge; any unit vector is correct.
Vector3 dominant(const std::array<Vector3, 3>& matrix) {
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (matrix[i][i] > matrix[longest][longest]) longest = i;
  }
  Vector3 fallback{};
  fallback[longest] = 1;
  Vector3 v = unit(matrix[longest]).value_or(fallback);
  for (int i = 0; i < 16; ++i) {
    v = unit({dot(matrix[0], v), dot(matrix[1], v), dot(matrix[2], v)}).value_or(v);
  }
  return v;
}

void add_square(std::array<Vector3, 3>& matrix, const Vector3& v) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) matrix[i][j] += v[i] * v[j];
  }
}

/// Bounds of the directions between two or three unit vectors.
struct DirectionBounds {
  Vector3 low{1, 1, 1};
  Vector3 high{-1, -1, -1};

  /// Extends the bounds to all directions between the unit vectors `corners`. False if the
  /// directions may be any: if there are fewer than two corners, or if three corners may surround
  /// the apex.
  bool include(std::span<const Vector3> corners);

 private:
  void include_arc(const Vector3& a, const Vector3& b);
  void include_inside(const Vector3& a, const Vector3& b, const Vector3& c);
};

double squared_distance(const Vector3& a, const Vector3& b) {
  const Vector3 way{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return dot(way, way);
}

bool DirectionBounds::include(std::span<const Vector3> corners) {
  // If the triangle of three directions is close to the apex, the angle between two of them is
  // about 120 degrees or more: for a point q = sum of l_i v_i of the triangle, where the l_i add up
  // to 1, |q|^2 = 1 - sum over i < j of l_i l_j |v_i - v_j|^2 >= 1 - largest / 3.
  constexpr double kAround = 2.999;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (corners.size() > 2 && squared_distance(corners[i], corners[j]) > kAround) return false;
      include_arc(corners[i], corners[j]);
    }
  }
  if (corners.size() > 2) include_inside(corners[0], corners[1], corners[2]);
  return corners.size() > 1;
}

/// Extends the bounds to the arc between two unit vectors. A component is largest at an end of the
/// arc unless it grows from both ends inward.
void DirectionBounds::include_arc(const Vector3& a, const Vector3& b) {
  constexpr double kLevel = 1e-13;  // a bound of the rounding errors
  const double cosine = dot(a, b);
  // The arc is at most 1 - sqrt(1 - c^2 / 4) away from its chord, of length c.
  const double lost = std::min(1.0, squared_distance(a, b) / 4);
  const double bulge = lost / 2 + lost * lost / 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double from_a = b[axis] - cosine * a[axis];
    const double from_b = a[axis] - cosine * b[axis];
    const bool has_top = from_a > -kLevel && from_b > -kLevel;
    const bool has_bottom = from_a < kLevel && from_b < kLevel;
    high[axis] = std::max(high[axis], std::max(a[axis], b[axis]) + (has_top ? bulge : 0));
    low[axis] = std::min(low[axis], std::min(a[axis], b[axis]) - (has_bottom ? bulge : 0));
  }
}

/// Extends the bounds to the directions inside three arcs. A component is larger there than on the
/// arcs only if its own axis is inside.
void DirectionBounds::include_inside(const Vector3& a, const Vector3& b, const Vector3& c) {
  constexpr double kFlat = 1e-10;
  const std::array<Vector3, 3> normals{cross(a, b), cross(b, c), cross(c, a)};
  const double volume = dot(normals[0], c);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::abs(volume) < kFlat) {
      // The space between the arcs is no wider than 1e-5. An axis in it is so close to an arc that
      // the component exceeds 1 - 1e-10 on that arc.
      constexpr double kNearly = 0.999;
      if (high[axis] > kNearly) high[axis] = 1;
      if (low[axis] < -kNearly) low[axis] = -1;
      continue;
    }
    double least = 1;
    double most = -1;
    for (const Vector3& normal : normals) {
      least = std::min(least, volume > 0 ? normal[axis] : -normal[axis]);
      most = std::max(most, volume > 0 ? normal[axis] : -normal[axis]);
    }
    if (least > -kFlat) high[axis] = 1;
    if (most < kFlat) low[axis] = -1;
  }
}

}  // namespace

BoxMember<6> seen_from(Index apex, std::span<const Point> points, const Triangle& triangle,
                       const BoxMember<3>& box) {
  BoxMember<6> result = extended(box);
  std::array<Vector3, 3> directions{};
  std::size_t count = 0;
  bool is_anywhere = false;
  for (const Index vertex : triangle) {
    if (vertex == apex) continue;
    const auto direction = unit(half_difference(points[vertex], points[apex]));
    // A vertex without a direction is at the apex or too close to it for doubles: any triangle at
    // the apex can meet this one there.
    is_anywhere = is_anywhere || !direction;
    if (direction) directions[count++] = *direction;
  }
  const std::span<const Vector3> seen(directions.data(), count);
  DirectionBounds bounds;
  if (is_anywhere || !bounds.include(seen)) bounds = {{-1, -1, -1}, {1, 1, 1}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    set_bounds(result, axis + 3, std::max(bounds.low[axis], -1.0),
               std::min(bounds.high[axis], 1.0));
  }
  return result;
}

ObliqueAxes::ObliqueAxes(std::span<const Point> points, std::span<const Triangle> triangles,
                         std::span<const Index> members) {
  if (members.empty()) return;
  centre_ = points[triangles[members.front()][0]];
  std::array<Vector3, 3> edges{};
  std::array<Vector3, 3> normals{};
  double farthest = 0;
  for (const Index member : members) {
    std::array<Vector3, 3> sides{};
    Vector3 longest{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Point& from = points[triangles[member][i]];
      farthest = std::max(farthest, largest_component(half_difference(from, centre_)));
      sides[i] = half_difference(points[triangles[member][i == 2 ? 0 : i + 1]], from);
      if (largest_component(sides[i]) > largest_component(longest)) longest = sides[i];
    }
    const auto edge = unit(longest);
    if (!edge) continue;
    add_square(edges, *edge);
    const auto normal = unit(cross(unit(sides[0]).value_or(*edge), unit(sides[1]).value_or(*edge)));
    if (normal) add_square(normals, *normal);
  }
  constexpr double kSmallest = 1e-290;
  scale_ = farthest > kSmallest ? 1 / farthest : 0;
  axes_[0] = dominant(edges);
  const Vector3 normal = dominant(normals);
  std::size_t smallest = 0;  // the axis of space that makes the largest angle with axes_[0]
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(axes_[0][i]) < std::abs(axes_[0][smallest])) smallest = i;
  }
  Vector3 across{};
  across[smallest] = 1;
  axes_[2] = unit(cross(axes_[0], normal)).value_or(unit(cross(axes_[0], across)).value_or(across));
  axes_[1] = unit(cross(axes_[2], axes_[0])).value_or(across);
}

BoxMember<6> ObliqueAxes::box(std::span<const Point> points, const Triangle& triangle,
                              const BoxMember<3>& box) const {
  BoxMember<6> result = extended(box);
  std::array<Vector3, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = half_difference(points[triangle[i]], centre_);
    for (double& component : corners[i]) component *= scale_;  // now at most 1
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::array<double, 3> heights{dot(axes_[axis], corners[0]), dot(axes_[axis], corners[1]),
                                        dot(axes_[axis], corners[2])};
    set_bounds(result, axis + 3, *std::min_element(heights.begin(), heights.end()),
               *std::max_element(heights.begin(), heights.end()));
  }
  return result;
}

}  // namespace watertight::geometry
