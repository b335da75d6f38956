// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points on an edge that both of its faces share.
#pragma once

#include <vector>

#include "base/result.h"
#include "surfaces/boundary_representation.h"

namespace watertight::surfaces {

struct EdgePoints {
  std::vector<Vector3> inner;  // from the start of the edge to its end, without both
  double gap = 0;              // metres: the larger distance of a vertex from the curve
};

/// Samples an edge so that its chords are nowhere farther than `chord` from the curve, and turn by
/// a quarter at most. Errors: limit_exceeded for more than `most` points. Cost: linear in them.
Result<EdgePoints> sample_edge(const BoundaryRepresentation& solid, Index edge, double chord,
                               std::size_t most);

}  // namespace watertight::surfaces
