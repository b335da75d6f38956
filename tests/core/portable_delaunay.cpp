// SPDX-License-Identifier: GPL-3.0-or-later
//
// Replaces delaunay/canonical_delaunay.cpp where CGAL is not to be linked: takes whole coordinates
// in a box below 2^30 only, as our own Delaunay tetrahedralization does. Only mode bitmap meets
// other coordinates. A linker that finds this definition first leaves cgal_delaunay.cpp out.
#include "delaunay/canonical/small_delaunay.h"
#include "delaunay/canonical_delaunay.h"

namespace watertight::delaunay {

Result<CanonicalDelaunay> canonical_delaunay(std::span<const Point> points,
                                             std::uint64_t max_tetrahedra,
                                             const CancelPoll& is_cancelled) {
  if (is_small_grid(points)) return small_delaunay(points, max_tetrahedra, is_cancelled);
  return Error{ErrorCode::unsupported, "coordinates that only CGAL takes"};
}

}  // namespace watertight::delaunay
