// SPDX-License-Identifier: GPL-3.0-or-later
//
// The order in which small_delaunay.cpp inserts points: for speed only. Private to delaunay/.
#pragma once

#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::delaunay {

/// All indices of `points`, whose coordinates are integers in [0, 2^30): in rounds, each eight
/// times as large as the one before, and in each round along a Hilbert curve, so that each point
/// is near the one before and the tetrahedra stay well shaped whatever the input's order.
/// Deterministic. Cost: O(n log n).
/// Source: Amenta, Choi & Rote, "Incremental constructions con BRIO" (2003), with rounds chosen by
/// a hash of the index instead of at random.
std::vector<Index> insertion_order(std::span<const Point> points);

}  // namespace watertight::delaunay
