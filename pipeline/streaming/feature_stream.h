// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads features one at a time, works on them on several threads, and hands the results on in the
// order of the document. For validate_stream() and Ingestion.
#pragma once

#include <cstdint>
#include <functional>

#include "base/cancel.h"
#include "formats/feature_reader.h"
#include "pipeline/streaming/stage_times.h"

namespace watertight::pipeline {

/// Hands the result of one feature on. Called in document order, from one thread at a time.
using Delivery = std::function<Status()>;
/// Works on the text of a feature, or on the error of the rest of the document. `number` is the
/// number in the document, from 0. Called from several threads at once.
using TextWork = std::function<Delivery(std::uint64_t number, Result<formats::FeatureText> text)>;
/// Works on a feature, or on the error of a feature or of the rest of the document that could not
/// be read (then without a place). `number` is the number in the document, from 0; `text` has the
/// place and, in a sequence, the line. Called from several threads at once.
using FeatureWork = std::function<Delivery(std::uint64_t number, const formats::FeatureText& text,
                                           Result<Feature> feature)>;

struct FeatureStreamOptions {
  std::size_t threads = 1;
  CancelPoll is_cancelled = {};
  /// Called with the number of bytes read, after each delivery, from one thread at a time.
  std::function<void(std::uint64_t)> progress = {};
  StageTimes* stages = nullptr;  // IngestOptions::stages
};

/// Works on the texts of all features of a reader; returns their number. At most a few features per
/// thread are in memory at once. Errors: cancelled; those of the deliveries, the first of which
/// ends the run.
Result<std::uint64_t> stream_texts(formats::FeatureReader& reader,
                                   const FeatureStreamOptions& options, const TextWork& work);

/// stream_texts() with each text read. Returns the number of features, unreadable ones included.
Result<std::uint64_t> stream_features(formats::FeatureReader& reader,
                                      const FeatureStreamOptions& options, const FeatureWork& work);

}  // namespace watertight::pipeline
