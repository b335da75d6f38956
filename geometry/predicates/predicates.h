// SPDX-License-Identifier: GPL-3.0-or-later
//
// The exact decisions of this program, correct for any finite doubles. A filter in doubles decides
// most calls, 128-bit integers decide calls with small integers, CGAL decides the others. The
// filter cannot decide an exact zero, so callers avoid calls with a repeated point.
#pragma once

#include "geometry/point.h"

namespace watertight::geometry {

/// The sign of det(b-a, c-a, d-a), six times the signed volume of tetrahedron abcd: +1 when a, b, c
/// turn counter-clockwise as seen from d, -1 when clockwise, 0 when the points are coplanar. For an
/// outward oriented facet (a, b, c) a point inside the solid beside it gives -1.
int orient3d(const Point& a, const Point& b, const Point& c, const Point& d);

/// The sign of the turn a, b, c in the plane of two axes when `axis` (0 x, 1 y, 2 z) is dropped.
/// The two axes are (y, z), (z, x) or (x, y), so that the plane keeps right-handedness. +1 is a
/// left turn.
int orient2d(const Point& a, const Point& b, const Point& c, int axis);

/// True if the three points lie on one line, exactly.
bool are_collinear(const Point& a, const Point& b, const Point& c);

/// True if q lies on the closed segment ab, exactly.
bool is_on_segment(const Point& a, const Point& b, const Point& q);

}  // namespace watertight::geometry
