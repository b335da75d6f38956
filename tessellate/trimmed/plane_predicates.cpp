// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/trimmed/plane_predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace watertight::tessellate {
namespace {

/// Whether a, b, c, d are the corners of a rectangle with sides along the axes, as cells of grids
/// are.
bool is_upright_rectangle(const Point& a, const Point& b, const Point& c, const Point& d) {
  return (a.x == b.x && b.y == c.y && c.x == d.x && d.y == a.y) ||
         (a.y == b.y && b.x == c.x && c.y == d.y && d.x == a.x);
}

}  // namespace

int side_of_circle(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double ax = a.x - d.x;
  const double ay = a.y - d.y;
  const double bx = b.x - d.x;
  const double by = b.y - d.y;
  const double cx = c.x - d.x;
  const double cy = c.y - d.y;
  const double bc = bx * cy;
  const double cb = cx * by;
  const double ca = cx * ay;
  const double ac = ax * cy;
  const double ab = ax * by;
  const double ba = bx * ay;
  const double a2 = ax * ax + ay * ay;
  const double b2 = bx * bx + by * by;
  const double c2 = cx * cx + cy * cy;
  const double value = a2 * (bc - cb) + b2 * (ca - ac) + c2 * (ab - ba);
  const double size = a2 * (std::abs(bc) + std::abs(cb)) + b2 * (std::abs(ca) + std::abs(ac)) +
                      c2 * (std::abs(ab) + std::abs(ba));
  constexpr double kError = 32.0 / 9007199254740992.0;  // more than the roundings above can cause
  constexpr double kSmall = 1e-150;                     // more than underflow can cause
  constexpr double kLarge = 1e300;
  if (std::abs(value) > kError * size + kSmall && size < kLarge) return value > 0 ? 1 : -1;
  if (is_upright_rectangle(a, b, c, d)) return 0;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto in_plane = [](const Point& p) { return Kernel::Point_2(p.x, p.y); };
  return CGAL::side_of_oriented_circle(in_plane(a), in_plane(b), in_plane(c), in_plane(d));
}

}  // namespace watertight::tessellate
