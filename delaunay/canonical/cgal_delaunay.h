// SPDX-License-Identifier: GPL-3.0-or-later
//
// The canonical Delaunay tetrahedralization by CGAL: for all points that small_delaunay.h does not
// take. Private to delaunay/: others call canonical_delaunay().
#pragma once

#include <cstdint>
#include <span>

#include "base/cancel.h"
#include "base/result.h"
#include "delaunay/canonical_delaunay.h"

namespace watertight::delaunay {

/// Does what canonical_delaunay() does, for any finite points.
Result<CanonicalDelaunay> cgal_delaunay(std::span<const Point> points,
                                        std::uint64_t max_tetrahedra = 64'000'000,
                                        const CancelPoll& is_cancelled = {});

}  // namespace watertight::delaunay
