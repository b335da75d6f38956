// SPDX-License-Identifier: GPL-3.0-or-later
//
// Changes attributes in the text of a feature; all other bytes stay as they are.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace watertight::formats {

/// The deepest nesting of a patch, as of documents.
constexpr int kDeepestPatch = 64;

/// The JSON object `target` after a merge patch (RFC 7396), which is a JSON object too: members
/// that are null are removed, objects are merged, other values replace those of the same name or
/// are added at the end. Errors: malformed if one of the texts is no JSON object; limit_exceeded
/// for a patch that is nested deeper than kDeepestPatch. Cost: linear in both for each level of
/// objects in the patch.
Result<std::string> merge_patch(std::string_view target, std::string_view patch);

/// The text of a feature (a skeleton or a CityJSONFeature) in which the attributes of one city
/// object are changed by a merge patch. Errors: those of merge_patch(); not_found if the text has
/// no such object. Cost: linear.
Result<std::string> patch_attributes(std::string_view feature, const std::string& object,
                                     std::string_view patch);

}  // namespace watertight::formats
