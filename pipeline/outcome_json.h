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

/// One feature on a line of its own: {"line", "id", "verdict"}, and for a feature that is not valid
/// its "solids", "leftOut" and "groups" as in outcome_json().
std::string feature_line(const FeatureOutcome& feature);

/// The defects of a feature that are of none of its own solids alone, as a JSON array: the groups
/// that are not valid, and the instances of geometry templates that are not. "" without any.
std::string feature_findings_json(const InspectedFeature& feature);

/// Which solids of a stored feature are proven, with measures and reports, the defects that are of
/// none of its solids alone, and the number of its other geometries by type.
std::string proof_json(const EncodedFeature& feature);

}  // namespace watertight::pipeline
