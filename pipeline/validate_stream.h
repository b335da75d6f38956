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
#include "pipeline/streaming/feature_stream.h"

namespace watertight::pipeline {

/// A feature and the results of its validation.
struct ValidatedFeature {
  std::uint64_t number = 0;  // number in the document, from 0
  InspectedFeature inspected;
  formats::FeaturePlace place = {};  // the line, in a sequence
};

/// Takes features in document order, from one thread at a time. An error ends the run.
using FeatureSink = std::function<Status(ValidatedFeature&&)>;
/// Takes the error of a feature, or of the rest of the document, that could not be read.
using ErrorSink = std::function<Status(const Error&)>;

struct StreamOptions {
  CertifyOptions certify;
  validate::GroupOptions groups;
  std::size_t threads = 1;  // threads for the features; a document of one feature uses all
  CancelPoll is_cancelled = {};
  /// Called with each feature that was read before it is validated, from several threads at once;
  /// may change it. The result is called before the feature is handed on.
  std::function<Delivery(const formats::FeatureText&, Feature&)> prepare = {};
  /// Called with the numbers of features done and of bytes read, from one thread at a time.
  std::function<void(std::uint64_t, std::uint64_t)> progress = {};
};

struct StreamOutcome {
  std::uint64_t features = 0;    // the number of features that were validated
  std::uint64_t unreadable = 0;  // the number of features that could not be read
  Verdict verdict = Verdict::valid;
};

/// Validates all features of a reader. The sinks are called in the order of the document, whatever
/// `threads` is. At most a few features per thread are in memory at once. Errors: cancelled; those
/// of the sinks. An error of the reader is passed to `on_error`, and the run goes on with the next
/// feature.
Result<StreamOutcome> validate_stream(formats::FeatureReader& reader,
                                      delaunay::EngineWorkers* workers,
                                      const StreamOptions& options, const FeatureSink& on_feature,
                                      const ErrorSink& on_error);

}  // namespace watertight::pipeline
