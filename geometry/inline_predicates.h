// SPDX-License-Identifier: GPL-3.0-or-later
//
// The predicates of predicates.h with CGAL's static filters inlined: for inner loops of this
// folder's sources. Private to geometry/ (it includes CGAL).
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "geometry/point.h"

namespace watertight {

struct InlinePredicates {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

  static int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
    return Kernel::Orientation_3()(in_space(a), in_space(b), in_space(c), in_space(d));
  }
  static int orient2d(const Point& a, const Point& b, const Point& c, int axis) {
    return Kernel::Orientation_2()(in_plane(a, axis), in_plane(b, axis), in_plane(c, axis));
  }

 private:
  static Kernel::Point_3 in_space(const Point& p) { return {p.x, p.y, p.z}; }
  static Kernel::Point_2 in_plane(const Point& p, int axis) {
    return {p[axis == 2 ? 0 : axis + 1], p[axis == 0 ? 2 : axis == 1 ? 0 : 1]};
  }
};

}  // namespace watertight
