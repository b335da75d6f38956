// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/predicates/predicates.h"

#include "geometry/predicates/inline_predicates.h"

namespace watertight::geometry {

int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  return InlinePredicates::orient3d(a, b, c, d);
}

int orient2d(const Point& a, const Point& b, const Point& c, int axis) {
  return InlinePredicates::orient2d(a, b, c, axis);
}

bool are_collinear(const Point& a, const Point& b, const Point& c) {
  for (int axis = 2; axis >= 0; --axis) {
    if (InlinePredicates::orient2d(a, b, c, axis) != 0) return false;
  }
  return true;
}

bool is_on_segment(const Point& a, const Point& b, const Point& q) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_between =
        (a[axis] <= q[axis] && q[axis] <= b[axis]) || (b[axis] <= q[axis] && q[axis] <= a[axis]);
    if (!is_between) return false;
  }
  return are_collinear(a, b, q);
}

}  // namespace watertight::geometry
