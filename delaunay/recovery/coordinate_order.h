// SPDX-License-Identifier: GPL-3.0-or-later
//
// A numbering of vertices that depends on their coordinates alone. Private to delaunay/.
#pragma once

#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::delaunay {

/// Vertices in the order of their coordinates, so that a result does not depend on the numbering.
struct CoordinateOrder {
  std::vector<Index> vertex_at;  // rank -> vertex
  std::vector<Index> rank_of;    // vertex -> rank
};

/// Requires distinct points.
CoordinateOrder order_of(std::span<const Point> points);

/// A positive tetrahedron with its smallest vertices first, still positive.
geometry::Tetrahedron normalized(geometry::Tetrahedron t);

}  // namespace watertight::delaunay
