// SPDX-License-Identifier: GPL-3.0-or-later
//
// A solid as triangles with looks, for glTF.
#pragma once

#include "base/result.h"
#include "geometry/solid.h"
#include "tiles/feature_mesh.h"

namespace watertight::sql {

/// The canonical triangles of a solid that was accepted, in metres from the low corner of its box,
/// along the axes of its reference system. Facets look like roofs, walls or grounds by their tilt.
/// Volume and area are properties. Errors: those of tiles::Frame::place(). Cost: that of
/// triangulating the facets.
Result<tiles::FeatureMesh> model_of(const Solid& solid);

}  // namespace watertight::sql
