// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures, reports and findings of a feature as lines of text in front of its skeleton, made for
// compression. Most follow from the solids and take nothing: measures are computed again, and the
// report of a solid in which nothing was found is always the same but for them. For the others a
// line has what stands between the common start and end of the expected text and the text.
#pragma once

#include <optional>
#include <string>

#include "base/limits.h"
#include "base/result.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The lines, each with a line feed; "" when all is as expected. Cost: decodes and triangulates
/// the solids.
std::string report_lines(const EncodedFeature& feature);

/// The measures of a solid whose facets have triangulations; nothing for another. Cost: that of
/// triangulating the facets.
std::optional<geometry::Measures> measures_of(const Solid& submitted);

/// Takes the lines of report_lines() off the front of the skeleton. Sets the findings, and measures
/// and reports of the chosen solids. Errors: malformed.
Status take_report_lines(EncodedFeature& feature, Reports reports, const Limits& limits);

}  // namespace watertight::pipeline
