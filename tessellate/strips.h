// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangles as strips, in the order that OpenGL draws them: every three vertices in turn are a
// triangle, every second one the other way round, and one with two equal vertices is none.
//
// Based on: K. Akeley, P. Haeberli, D. Burns, tomesh, 1990: a strip starts where the fewest
// neighbours are left.
#pragma once

#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::tessellate {

using Strip = std::vector<Index>;

/// Strips that have each triangle once. A vertex is repeated where that goes on with a strip.
/// Requires that triangles that share an edge turn the same way, and indices below `point_count`.
/// Cost: linear.
std::vector<Strip> strips_of(std::span<const Triangle> triangles, std::size_t point_count);

/// The triangles of a strip.
std::vector<Triangle> triangles_of(const Strip& strip);

}  // namespace watertight::tessellate
