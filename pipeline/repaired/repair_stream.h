// SPDX-License-Identifier: GPL-3.0-or-later
//
// Repairs a CityJSONSeq line by line.
#pragma once

#include <functional>
#include <string_view>

#include "formats/feature_reader.h"
#include "pipeline/repaired/repair_document.h"

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

}  // namespace watertight::pipeline
