// SPDX-License-Identifier: GPL-3.0-or-later
//
// The loops of a curved face as closed polygons in the plane of (u, v), with the face on their
// left. Surfaces that close are cut along a seam, which is in no file; a pole becomes two points of
// the plane.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "surfaces/boundary_representation.h"
#include "surfaces/vertex_pool.h"

namespace watertight::surfaces {

struct LoopPoint {
  Index vertex = kNone;  // of the pool
  Parameters at{};
  Index edge = kNone;  // on which the way to the next point runs; kNone: a seam or a pole
};
using FaceLoop = std::vector<LoopPoint>;

struct FaceLoops {
  std::vector<FaceLoop> loops;
  bool is_turned = false;  // the loops of the file have the face on their right: its sense is wrong
  double gap = 0;          // metres: the largest distance of a point of an edge from the surface
};

/// The loops of a face on `surface`, which is that of the face or, if `is_transposed`, has u and v
/// exchanged. `chord` says how far a seam may be from the surface. Errors: unsupported with the
/// reason if the loops bound no part of the surface, or wind around its second direction
/// (winds_around_v(): then transposing helps).
Result<FaceLoops> loops_of(const BoundaryFace& face, const Surface& surface, bool is_transposed,
                           const std::vector<EdgeSamples>& edges, double tolerance, double chord,
                           VertexPool& pool);

bool winds_around_v(const Error& error);

}  // namespace watertight::surfaces
