// SPDX-License-Identifier: GPL-3.0-or-later
//
// The findings of stored features as pins in a tileset.
#pragma once

#include <vector>

#include "pipeline/pipeline.h"
#include "tiles/feature_mesh.h"

namespace watertight::server {

/// The most pins of one feature; findings beyond are in its report.
inline constexpr std::size_t kMostPins = 100;

/// A pin for each finding of a feature that is not proven, at the place of the finding; one without
/// a place is in the middle of the feature's box. A pin has the id of the feature, and the members
/// of the finding as properties. A feature without findings (a limit was reached) has one pin.
/// `srid`: the storage CRS. None for a feature that has no place in the frame. Errors: those of
/// pipeline::unpack().
Result<std::vector<tiles::FeatureMesh>> pins_of(StoredFeature stored, std::uint32_t srid,
                                                const tiles::Frame& frame, const Limits& limits);

}  // namespace watertight::server
