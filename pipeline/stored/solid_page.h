// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solids of a feature in a store: those of one feature share most of their vertices, and take
// fewer bytes as one page (codec/page.h) than as blobs.
#pragma once

#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// Whether put_in_page() may change the feature.
bool may_share_page(const store::FeatureRecord& feature);
/// Puts the proven solids of a feature in a page when that is smaller than their blobs. Cost: that
/// of encoding them twice, nothing for a feature with fewer than two. Errors: those of decode().
Status put_in_page(store::FeatureRecord& feature);

}  // namespace watertight::pipeline
