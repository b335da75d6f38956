// SPDX-License-Identifier: GPL-3.0-or-later
//
// Packs the features of a document for a store: the first ones wait until it is known whether a
// dictionary of their own is worth its bytes.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/pipeline.h"
#include "pipeline/streaming/feature_spool.h"

namespace watertight::pipeline {

/// A feature on its way into the spool.
struct PreparedFeature {
  EncodedFeature encoded;  // not used when `packed` is there
  std::string text;        // stored_text(encoded); the same
  std::optional<StoredFeature> packed;
};

class FeaturePacker {
 public:
  /// Gives texts of features that are stored.
  using Samples = std::function<Result<std::vector<std::string>>()>;
  /// `current` is the dictionary of the collection, null for none, `stored` the number of features
  /// that it has; `samples` are asked for rarely. Waiting features are packed on `threads` threads.
  FeaturePacker(packing::DictionaryPointer current, std::uint64_t stored, Samples samples,
                std::size_t threads)
      : dictionary_(std::move(current)),
        stored_(stored),
        samples_(std::move(samples)),
        threads_(threads) {}

  /// Does the work that needs no order; from any thread. Errors: those of pack().
  Result<PreparedFeature> prepare(EncodedFeature encoded);
  /// Adds a feature to the spool, at once or later, in the order of calls. Errors: those of pack(),
  /// packing::best_dictionary(), the samples and the spool.
  Status add(PreparedFeature feature, FeatureSpool& spool);
  /// Adds all that wait. Errors: those of add().
  Status finish(FeatureSpool& spool);
  /// The number of features that wait.
  std::size_t waiting() const { return waiting_.size(); }
  void clear() { waiting_.clear(); }

 private:
  Status choose(std::uint64_t expected, FeatureSpool& spool);
  Result<packing::DictionaryPointer> dictionary_for(const std::vector<PreparedFeature>& features,
                                                    std::uint64_t expected) const;

  std::mutex mutex_;  // of the next two
  packing::DictionaryPointer dictionary_;
  bool is_chosen_ = false;
  std::uint64_t stored_;
  Samples samples_;
  std::size_t threads_;
  std::vector<PreparedFeature> waiting_;
  std::size_t waiting_bytes_ = 0;
};

}  // namespace watertight::pipeline
