// SPDX-License-Identifier: GPL-3.0-or-later
//
// Validates a repaired document, for the report on the repair.
#pragma once

#include "pipeline/repaired/repair_document.h"
#include "pipeline/validate_stream.h"

namespace watertight::pipeline {

/// Writes the document in a format, reads the text by `reading` and validates it: the report is
/// about the document that the user gets. `on_feature` gets the features in order, with what
/// `outcome` says of their solids. Errors: those of convert_document(), of reading and of the sink;
/// cancelled. Cost: that of validate_stream().
Status validate_repaired(const Document& document, Format format,
                         const formats::ReadOptions& reading, const DocumentRepair& outcome,
                         delaunay::EngineWorkers* workers, const StreamOptions& validation,
                         const FeatureSink& on_feature);

}  // namespace watertight::pipeline
