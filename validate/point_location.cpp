// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/point_location.h"

#include <algorithm>

#include "geometry/predicates.h"

namespace watertight {
namespace {

constexpr int kDropZ = 2;

int sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

bool is_same_in_plan(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

/// Side of the moved point to the line ab in plan: 0 only if a and b have the same plan position.
/// The turn a, b, p grows with p.x by -(b.y - a.y) and with p.y by b.x - a.x.
int moved_turn(const Point& a, const Point& b, const Point& p) {
  if (is_same_in_plan(a, b)) return 0;
  if (!is_same_in_plan(a, p) && !is_same_in_plan(b, p)) {
    const int turn = orient2d(a, b, p, kDropZ);
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

/// Requires p on the plane of abc and in its box. Decides in a projection where abc has an area.
bool is_in_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  if (p == a || p == b || p == c) return true;
  for (int axis = 0; axis < 3; ++axis) {
    const int turn = orient2d(a, b, c, axis);
    if (turn == 0) continue;
    const auto side = [&](const Point& from, const Point& to) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      const bool is_end = (from[u] == p[u] && from[v] == p[v]) || (to[u] == p[u] && to[v] == p[v]);
      return is_end ? 0 : orient2d(from, to, p, axis) * turn;
    };
    return side(a, b) >= 0 && side(b, c) >= 0 && side(c, a) >= 0;
  }
  return false;
}

}  // namespace

Location locate(const Point& p, std::span<const Point> vertices,
                std::span<const Triangle> triangles) {
  bool is_inside = false;
  for (const Triangle& t : triangles) {
    const Point& a = vertices[t[0]];
    const Point& b = vertices[t[1]];
    const Point& c = vertices[t[2]];
    const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
    const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
    if (p.x < low_x || p.x > high_x || p.y < low_y || p.y > high_y) continue;
    if (p.z > std::max({a.z, b.z, c.z})) continue;
    int height = 2;  // not known yet; else the sign of orient3d
    if (is_in_closed_box(p, a, b, c)) {
      const bool is_corner = p == a || p == b || p == c;
      height = is_corner ? 0 : orient3d(a, b, c, p);
      if (height == 0 && is_in_triangle(p, a, b, c)) return Location::boundary;
    }
    const int turn = moved_turn(a, b, p);
    if (turn == 0 || moved_turn(b, c, p) != turn || moved_turn(c, a, p) != turn) continue;
    if (height == 2) height = orient3d(a, b, c, p);
    // From below, a triangle that turns left in plan turns clockwise: orient3d is positive above.
    if (height * turn < 0) is_inside = !is_inside;
  }
  return is_inside ? Location::inside : Location::outside;
}

}  // namespace watertight
