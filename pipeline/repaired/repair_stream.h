// SPDX-License-Identifier: GPL-3.0-or-later
//
// Repairs a CityJSONSeq line by line.
#pragma once

#include <functional>
#include <string_view>

#include "formats/feature_reader.h"
#include "pipeline/repaired/repair_document.h"
#include "pipeline/validate_stream.h"

namespace watertight::pipeline {

/// Takes the next part of a text. Called from one thread at a time.
using TextSink = std::function<Status(std::string_view)>;

/// Repairs the solids of the features that a reader of a sequence gives, on `threads` threads, and
/// gives `sink` the sequence: lines of features without a repaired solid as they were read, blank
/// lines left out. In memory are a few features per thread, and the outcome. Errors: those of the
/// reader, of repair_feature() and of the sink; cancelled. Cost: that of repair::repair().
Result<DocumentRepair> repair_stream(formats::FeatureReader& reader,
                                     delaunay::EngineWorkers* workers,
                                     const repair::RepairOptions& options, std::size_t threads,
                                     const TextSink& sink);

/// The same, and validates each feature as it is written, by `validation`. `on_feature` gets them
/// in order, with what became of their solids. Cost: that of validate_stream() on top.
Result<DocumentRepair> repair_and_validate(formats::FeatureReader& reader,
                                           delaunay::EngineWorkers* workers,
                                           const repair::RepairOptions& options,
                                           const StreamOptions& validation, const TextSink& sink,
                                           const FeatureSink& on_feature);

}  // namespace watertight::pipeline
