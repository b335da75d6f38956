// SPDX-License-Identifier: GPL-3.0-or-later
//
// Facts about an encoded feature that an index needs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The skeleton of the feature's city model (formats/city_json/city_json.h), a part of its text; ""
/// without one.
std::string_view model_text(const EncodedFeature& feature);

/// The ids by which a feature is found: its own, and those of its city objects or of the objects of
/// its solids; each once, without "". Cost: linear in the skeleton.
std::vector<std::string> ids_of(const EncodedFeature& feature);

/// FeatureRecord::box of a feature whose proven solids are decoded: the box around all of its
/// solids; nullopt without solids. Errors: malformed when the skeleton does not fit.
Result<std::optional<store::StoredBox>> box_of(const EncodedFeature& feature,
                                               std::span<const Decoded> solids,
                                               const Limits& limits = {});

}  // namespace watertight::pipeline
