// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/canonical_delaunay.h"

#include "delaunay/canonical/cgal_delaunay.h"
#include "delaunay/canonical/small_delaunay.h"

namespace watertight::delaunay {

Result<CanonicalDelaunay> canonical_delaunay(std::span<const Point> points,
                                             std::uint64_t max_tetrahedra,
                                             const CancelPoll& is_cancelled) {
  if (is_small_grid(points)) return small_delaunay(points, max_tetrahedra, is_cancelled);
  return cgal_delaunay(points, max_tetrahedra, is_cancelled);
}

}  // namespace watertight::delaunay
