// SPDX-License-Identifier: GPL-3.0-or-later
//
// One feature through validation and encoding. Internal to pipeline/.
#pragma once

#include <optional>

#include "pipeline/indoor/cells.h"
#include "pipeline/instances.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// A feature that was validated, and encoded if it is valid.
struct ProcessedFeature {
  FeatureOutcome outcome;
  std::optional<EncodedFeature> encoded;
};

/// The values that all features of a document share, reduced to what the contract promises.
struct SharedPart {
  Document document;                        // format, header and framing; no features
  std::optional<formats::CityHeader> city;  // the header as values; absent unless a city model
};

/// Errors: malformed header.
Result<SharedPart> shared_part(const Document& document, formats::Contract contract);

/// Validates a feature of the document that `shared` is a part of, and encodes it if it is valid.
/// Errors: those of encode_feature().
Result<ProcessedFeature> process(Feature feature, const SharedPart& shared,
                                 delaunay::EngineWorkers* workers, const IngestOptions& options,
                                 TemplateInspector& templates, CellInspector& cells);

}  // namespace watertight::pipeline
