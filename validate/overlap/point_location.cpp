// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/overlap/point_location.h"

#include <algorithm>

#include "geometry/predicates/predicates.h"

namespace watertight::validate {
namespace {

constexpr int kDropZ = 2;

int sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

bool is_same_in_plan(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

/// The sign of the turn a, b, p in plan after p is moved: 0 only if a and b are the same in plan.
/// The turn grows with p.x by -(b.y - a.y) and with p.y by b.x - a.x.
int moved_turn(const Point& a, const Point& b, const Point& p) {
  if (is_same_in_plan(a, b)) return 0;
  if (!is_same_in_plan(a, p) && !is_same_in_plan(b, p)) {
    const int turn = geometry::orient2d(a, b, p, kDropZ);
    if (turn != 0) return turn;
  }
  const int along_x = sign(a.y - b.y);
  return along_x != 0 ? along_x : sign(b.x - a.x);
}

bool is_in_closed_box(const Point& p, const Point& a, const Point& b, const Point& c) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({a[axis], b[axis], c[axis]});
    if (p[axis] < low || p[axis] > high) return false;
  }
  return true;
}

/// True if p is in the closed triangle abc. Requires p on the plane of abc and in the box of abc.
/// Decides in a projection in which abc has an area.
bool is_in_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  if (p == a || p == b || p == c) return true;
  for (int axis = 0; axis < 3; ++axis) {
    const int turn = geometry::orient2d(a, b, c, axis);
    if (turn == 0) continue;
    const auto side = [&](const Point& from, const Point& to) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      const bool is_end = (from[u] == p[u] && from[v] == p[v]) || (to[u] == p[u] && to[v] == p[v]);
      return is_end ? 0 : geometry::orient2d(from, to, p, axis) * turn;
    };
    return side(a, b) >= 0 && side(b, c) >= 0 && side(c, a) >= 0;
  }
  return false;
}

/// Counts, modulo 2, the triangles above a point, one triangle at a time.
class RayParity {
 public:
  RayParity(const Point& p, std::span<const Point> vertices) : p_(p), vertices_(vertices) {}

  void meet(const Triangle& t) {
    const Point& a = vertices_[t[0]];
    const Point& b = vertices_[t[1]];
    const Point& c = vertices_[t[2]];
    if (is_on_boundary_ || is_missed(a, b, c)) return;
    int height = 2;  // the sign of orient3d, or 2 as long as it is not known
    if (is_in_closed_box(p_, a, b, c)) {
      const bool is_corner = p_ == a || p_ == b || p_ == c;
      height = is_corner ? 0 : geometry::orient3d(a, b, c, p_);
      is_on_boundary_ = height == 0 && is_in_triangle(p_, a, b, c);
      if (is_on_boundary_) return;
    }
    const int turn = moved_turn(a, b, p_);
    if (turn == 0 || moved_turn(b, c, p_) != turn || moved_turn(c, a, p_) != turn) return;
    if (height == 2) height = geometry::orient3d(a, b, c, p_);
    // For a triangle that turns left in plan, orient3d is positive if the point is above it.
    if (height * turn < 0) is_inside_ = !is_inside_;
  }

  Location location() const {
    if (is_on_boundary_) return Location::boundary;
    return is_inside_ ? Location::inside : Location::outside;
  }

 private:
  bool is_missed(const Point& a, const Point& b, const Point& c) const {
    const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
    const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
    return p_.x < low_x || p_.x > high_x || p_.y < low_y || p_.y > high_y ||
           p_.z > std::max({a.z, b.z, c.z});
  }

  Point p_;
  std::span<const Point> vertices_;
  bool is_inside_ = false;
  bool is_on_boundary_ = false;
};

}  // namespace

PointLocator::PointLocator(std::span<const Point> vertices, std::span<const Triangle> triangles)
    : vertices_(vertices), triangles_(triangles), tree_(boxes_of(vertices, triangles)) {}

Location PointLocator::locate(const Point& p) const {
  RayParity parity(p, vertices_);
  tree_.visit(
      [&](const Box& box) {
        return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y &&
               p.z <= box.max.z;
      },
      [&](Index triangle) { parity.meet(triangles_[triangle]); });
  return parity.location();
}

Location locate(const Point& p, std::span<const Point> vertices,
                std::span<const Triangle> triangles) {
  RayParity parity(p, vertices);
  for (const Triangle& t : triangles) parity.meet(t);
  return parity.location();
}

}  // namespace watertight::validate
