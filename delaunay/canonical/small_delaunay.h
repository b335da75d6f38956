// SPDX-License-Identifier: GPL-3.0-or-later
//
// The canonical Delaunay tetrahedralization of integer points without any library, for the portable
// decoder. Private to delaunay/: others call canonical_delaunay(). Based on: Bowyer 1981 and Watson
// 1981 (insertion by conflict regions), with an infinite vertex; location by walking (Devillers,
// Pion & Teillaud, "Walking in a triangulation", 2002); the tie rule of canonical_delaunay.h.
#pragma once

#include <cstdint>
#include <span>

#include "base/cancel.h"
#include "base/result.h"
#include "delaunay/canonical_delaunay.h"

namespace watertight::delaunay {

/// True if small_delaunay takes these points: integers up to 2^53 in magnitude, in a box whose
/// sides are below 2^30.
bool is_small_grid(std::span<const Point> points);

/// Does what canonical_delaunay() does, for points that are a small grid. Exact: all decisions are
/// signs of integers. Memory: about 800 bytes per point, in a few vectors.
Result<CanonicalDelaunay> small_delaunay(std::span<const Point> points,
                                         std::uint64_t max_tetrahedra = 64'000'000,
                                         const CancelPoll& is_cancelled = {});

}  // namespace watertight::delaunay
