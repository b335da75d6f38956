// SPDX-License-Identifier: GPL-3.0-or-later
//
// Validation of a document of any length in bounded memory: features are read one at a time,
// validated on all cores and handed on in document order. For the command line and bulk jobs.
#pragma once

#include <cstdint>
#include <functional>

#include "base/cancel.h"
#include "formats/feature_reader.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// A feature with everything that is known of it.
struct ValidatedFeature {
  std::uint64_t number = 0;  // in the document, from 0
  InspectedFeature inspected;
};

/// Takes features in document order, from one thread at a time. An error ends the run.
using FeatureSink = std::function<Status(ValidatedFeature&&)>;
/// Takes what could not be read: one feature, or the rest of the document.
using ErrorSink = std::function<Status(const Error&)>;

struct StreamOptions {
  CertifyOptions certify;
  validate::GroupOptions groups;
  std::size_t threads = 1;  // threads for the features; a document of one feature has them all
  CancelPoll is_cancelled = {};
  /// Called with features done and bytes read; from one thread at a time.
  std::function<void(std::uint64_t, std::uint64_t)> progress = {};
};

struct StreamOutcome {
  std::uint64_t features = 0;    // validated
  std::uint64_t unreadable = 0;  // features that could not be read
  Verdict verdict = Verdict::valid;
};

/// Validates all features of a reader. The order in which sinks are called is the document's and
/// does not depend on `threads`. At most a few features per thread are in memory at once.
/// Errors: cancelled; those of the sinks. An error of the reader is passed to `on_error`, and the
/// run goes on with the next feature.
Result<StreamOutcome> validate_stream(formats::FeatureReader& reader,
                                      delaunay::EngineWorkers* workers,
                                      const StreamOptions& options, const FeatureSink& on_feature,
                                      const ErrorSink& on_error);

}  // namespace watertight::pipeline
