// SPDX-License-Identifier: GPL-3.0-or-later
//
// Outcomes and measures as JSON text, for the store, the service and the command line. Reports of
// single solids are validate/report_json.h's.
#pragma once

#include <string>

#include "base/json_text.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// {"volume", "area", "boxMin", "boxMax", "genus", "vertices", "facets", "rings", "shells"}
std::string measures_json(const geometry::Measures& measures);

/// {"verdict", "stored", "features": [{"id", "verdict", "stored", "solids": [{"object",
/// "geometryType", "lod", "geometry", "ordinal", "pointer", "blobBytes", "report"}], "groups":
/// [{"kind", "object", "lod", "solids", "verdict", "findings", "findingsOmitted", "notRun"}]}]}
/// "groups" only where there are any; "solid" in their findings is a position in "solids".
std::string outcome_json(const IngestOutcome& outcome);

}  // namespace watertight::pipeline
