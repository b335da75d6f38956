// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangles of a surface over a hole. Internal to repair/.
#pragma once

#include <optional>
#include <span>

#include "repair/smooth/smooth_patch.h"
#include "spline/dms_surface.h"

namespace watertight::repair {

/// A surface over a collar and its hole. Vertices of the domain: the border of the hole, the rest
/// of the collar, new ones.
struct SampledHole {
  const spline::DmsSurface& surface;
  std::span<const geometry::Vector3> border;  // the places of the border's vertices, metres
  std::size_t first_new = 0;                  // the first new vertex of the domain
  std::size_t collar_triangles = 0;           // those of the hole come after them
};

/// Samples the surface at new vertices of the domain and, where an inner edge is more than
/// `chord_metres` from the surface in its middle, there too, round by round. The border
/// keeps its vertices and its straight edges: what the surface differs from the vertices is spread
/// inward, and beside an edge the way from the edge to the surface's curve over it is taken off,
/// less of it with the distance, so that a patch with many vertices does not lie across its border.
/// Fills new vertices, triangles and measures of the patch. Cost: linear in samples times edges of
/// the border, and a sparse Cholesky factorization.
std::optional<Refused> sample(const SampledHole& hole, double chord_metres,
                              std::size_t most_vertices, SmoothPatch& patch);

}  // namespace watertight::repair
