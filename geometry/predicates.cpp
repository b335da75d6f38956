// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace watertight {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 in_space(const Point& p) { return {p.x, p.y, p.z}; }

Kernel::Point_2 in_plane(const Point& p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

}  // namespace

int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  return CGAL::orientation(in_space(a), in_space(b), in_space(c), in_space(d));
}

int orient2d(const Point& a, const Point& b, const Point& c, int axis) {
  return CGAL::orientation(in_plane(a, axis), in_plane(b, axis), in_plane(c, axis));
}

bool are_collinear(const Point& a, const Point& b, const Point& c) {
  return CGAL::collinear(in_space(a), in_space(b), in_space(c));
}

bool is_on_segment(const Point& a, const Point& b, const Point& q) {
  if (!are_collinear(a, b, q)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_between =
        (a[axis] <= q[axis] && q[axis] <= b[axis]) || (b[axis] <= q[axis] && q[axis] <= a[axis]);
    if (!is_between) return false;
  }
  return true;
}

}  // namespace watertight
