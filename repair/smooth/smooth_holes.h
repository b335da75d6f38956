// SPDX-License-Identifier: GPL-3.0-or-later
//
// Smooth patches in the place of flat fillings. Internal to repair/.
#pragma once

#include <span>
#include <vector>

#include "base/cancel.h"
#include "repair/hole_groups.h"
#include "repair/remedies.h"
#include "repair/shell_surface.h"

namespace watertight::repair {

/// A hole and the facets that close it.
struct ClosedHole {
  HoleLoops loops;
  HoleFill fill;
  std::vector<EditedFacet> facets;
  std::vector<Triangle> triangles;  // the same surface
};

/// Gives each hole a smooth patch, whose vertices are appended to the solid. A hole whose patch is
/// refused, or would meet a facet, itself or another patch, keeps its filling and gets the reason.
/// Where the border has edges that belong to no loop, that is the reason.
/// Cost: that of the patches, and of a search for intersections.
void smooth_holes(EditedSolid& solid, const ShellSurface& surface, std::span<ClosedHole> holes,
                  const SmoothOptions& options, const CancelPoll& is_cancelled);

}  // namespace watertight::repair
