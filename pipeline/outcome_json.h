// SPDX-License-Identifier: GPL-3.0-or-later
//
// Outcomes and measures as JSON text, for the store, the service and the command line.
// validate/report_json.h writes the reports of single solids.
#pragma once

#include <string>

#include "base/json_text.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The text {"volume", "area", "boxMin", "boxMax", "genus", "vertices", "facets", "rings",
/// "shells"}.
std::string measures_json(const geometry::Measures& measures);

/// The text {"verdict", "stored", "counts": {"features", "valid", "invalid", "undecided"},
/// "featuresOmitted", "features": [{"id", "verdict", "stored", "solids": [{"object",
/// "geometryType", "lod", "geometry", "ordinal", "pointer", "blobBytes", "report"}], "groups":
/// [{"kind", "object", "lod", "solids", "verdict", "findings", "findingsOmitted", "notRun"}]}]}.
/// Features without groups have no "groups"; "solid" in a finding of a group is an index into the
/// feature's "solids".
std::string outcome_json(const IngestOutcome& outcome);

}  // namespace watertight::pipeline
