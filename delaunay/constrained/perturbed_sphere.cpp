// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: Devillers & Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D
// triangulations" (2011), section 3, as delaunay/canonical/grid_predicates.h states it.
#include "delaunay/constrained/perturbed_sphere.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <utility>

#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 converted(const Point& p) { return {p.x, p.y, p.z}; }

}  // namespace

bool is_in_perturbed_sphere(const std::array<const Point*, 4>& t, const Point& p) {
  const CGAL::Oriented_side side = Kernel().side_of_oriented_sphere_3_object()(
      converted(*t[0]), converted(*t[1]), converted(*t[2]), converted(*t[3]), converted(p));
  if (side != CGAL::ON_ORIENTED_BOUNDARY) return side == CGAL::ON_POSITIVE_SIDE;
  std::array<std::pair<const Point*, std::size_t>, 5> greatest{
      {{t[0], 0}, {t[1], 1}, {t[2], 2}, {t[3], 3}, {&p, 4}}};
  std::sort(greatest.begin(), greatest.end(),
            [](const auto& a, const auto& b) { return *b.first < *a.first; });
  for (const auto& [point, place] : greatest) {
    if (place == 4) return false;
    std::array<const Point*, 4> replaced = t;
    replaced[place] = &p;
    const int sign = geometry::orient3d(*replaced[0], *replaced[1], *replaced[2], *replaced[3]);
    if (sign != 0) return sign > 0;
  }
  return false;
}

}  // namespace watertight::delaunay
