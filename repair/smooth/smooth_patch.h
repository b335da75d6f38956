// SPDX-License-Identifier: GPL-3.0-or-later
//
// A patch over a hole that goes on as the surface around it does: a triangular B-spline (DMS
// spline) of least thin-plate energy, sampled to triangles. Internal to repair/.
//
// Based on: R. Pfeifle, H.-P. Seidel, Triangular B-Splines for Blending and Filling of Polygonal
// Holes, 1996, sections 3 and 4. Addition: the surface around the hole is a mesh, so the old region
// is a spline that comes near the vertices of a collar (docs/decisions/0051-smooth-patches.md).
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "repair/smooth/collar.h"
#include "repair/smooth/smooth_options.h"

namespace watertight::repair {

struct SmoothPatch {
  std::vector<Index> border;                    // vertices of the solid
  std::vector<geometry::Vector3> new_vertices;  // metres, as metres_of() gives them
  /// Corners are numbers of the border and, from border.size() on, of new vertices.
  std::vector<Triangle> triangles;
  SmoothMeasures measures;
  std::string spline;  // docs/schema/spline-1.schema.json, in world coordinates
};

/// The patch over the hole of these loops. A collar that does not lie in the plane one-to-one
/// loses rings. `closing` has triangles that close it (vertices of the
/// solid), for the map into the plane; may be empty. Cost: that of sparse Cholesky factorizations
/// with six unknowns for each triangle of collar and hole.
std::variant<SmoothPatch, Refused> smooth_patch(const EditedSolid& solid,
                                                const ShellSurface& surface, const HoleLoops& loops,
                                                std::span<const Triangle> closing,
                                                const SmoothOptions& options);

}  // namespace watertight::repair
