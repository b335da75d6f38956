// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surfaces over triangulations as JSON (docs/schema/spline-1.schema.json).
#pragma once

#include <string>

#include "spline/dms_surface.h"

namespace watertight::spline {

/// `{"type": "watertight_spline", "schema": 1, "degree", "vertices", "clouds", "triangles",
/// "coefficients"}`: vertices and knots as pairs, the knots of each vertex in a list, triangles as
/// numbers of vertices, and for each triangle its coefficients in the order of DmsDomain. Numbers
/// read back as the same doubles.
std::string to_json(const DmsSurface& surface);

}  // namespace watertight::spline
