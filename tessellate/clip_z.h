// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cuts solids at a height: storeys, what a flood covers, what stands above a terrain. For sql.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/solid.h"

namespace watertight::tessellate {

enum class HeightSide : std::uint8_t { below, above };

/// What is left of a facet that is cut: one facet (or several, where the cut separates it), or a
/// facet of each of its triangles. A narrow rest of a facet that is not flat may be too bent to be
/// one facet; that of a triangle never is.
enum class FacetRest : std::uint8_t { whole, triangles };

/// The parts of a solid on one side of a height in world units: several where the cut separates it,
/// none where nothing of it is there. Facets that the height does not meet stay as they are; the
/// canonical triangles of the others are cut; a level facet closes each section. Corners
/// on the height stay. New ones are rounded to a decimal between 10^-9 and 10^-8 of the extent of
/// the solid along x or y, the larger one (less fine where coordinates would need more than 53
/// bits), so the parts are to be judged anew. Whether a corner is below the height is decided on
/// the double nearest to its coordinate.
///
/// Requires a valid solid, whose vertices are merged, and a height that is not NaN. Errors:
/// malformed where a section is narrower than that rounding and so bounds nothing. Cost:
/// O(n log n) for the triangulation of the facets and n corners, linear without a cut.
Result<std::vector<Solid>> clip_z(const Solid& solid, double height, HeightSide side,
                                  FacetRest rest = FacetRest::whole);

}  // namespace watertight::tessellate
