// SPDX-License-Identifier: GPL-3.0-or-later
//
// Stores documents of any length: features are read, validated and encoded one at a time, wait in a
// spool until all are known to be good, and are stored in one transaction. Memory: a few features
// per thread, a batch of the spool, and the ids.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_set>
#include <vector>

#include "formats/feature_reader.h"
#include "pipeline/pipeline.h"
#include "pipeline/streaming/container_parts.h"
#include "pipeline/streaming/feature_packer.h"
#include "pipeline/streaming/feature_spool.h"

namespace watertight::pipeline {

/// Takes the outcomes of features in document order, from one thread at a time, before anything is
/// stored. An error ends the run.
using OutcomeSink = std::function<Status(FeatureOutcome&&)>;
/// Called with the numbers of features done and of bytes of the reader, from one thread at a time.
using IngestProgress = std::function<void(std::uint64_t, std::uint64_t)>;

/// One document, or the documents of one Watertight file, on the way into a store: all features are
/// stored if all are valid, else none (refuse_document) or the valid ones (skip).
class Ingestion {
 public:
  /// The store must outlive the ingestion.
  Ingestion(SolidStore& store, delaunay::EngineWorkers* workers, IngestOptions options,
            OutcomeSink on_feature, IngestProgress progress = {});

  /// Validates and encodes all features of a reader; may be called for several readers, whose
  /// features then count as one document. Nothing is stored yet, and nothing may be stored after an
  /// error. Errors: those of the reader and of encode(); malformed (two features of one id, an
  /// empty id), invalid_argument (an id that the store cannot keep), with the place; conflict
  /// (another CRS than the collection's); cancelled; those of the sink; unavailable (the spool).
  Status add(formats::FeatureReader& reader);
  /// The same for all documents of a Watertight file. City models are checked as their texts would
  /// be. Memory: one part of the file, or a CityJSON that the file holds as a whole. Errors: those
  /// of add() and of ContainerParts.
  Status add_container(ByteView bytes, const Limits& limits = {},
                       WholeModels models = WholeModels::refuse);

  /// Stores the features in one transaction. Nothing is stored after an error. Errors: cancelled;
  /// those of SolidStore::put().
  Result<IngestCounts> finish();
  /// Whether nothing is stored, because a feature is not valid and the policy is to refuse.
  bool is_refused() const {
    return counts_.verdict != Verdict::valid &&
           options_.policy.value_or(Policy::refuse) == Policy::refuse;
  }
  /// The first stored features that have the box of another one; empty before finish().
  const std::vector<store::Twins>& twins() const { return twins_; }
  /// The versions of the stored features in their order; empty before finish().
  const std::vector<std::uint64_t>& versions() const { return versions_; }

 private:
  struct Processed;
  Result<std::vector<SolidRepair>> repair_in(Feature& feature) const;
  Status take(Processed processed);
  Status look_up_collection();
  Status check_srid(const FeatureOutcome& outcome, std::uint32_t srid);
  Status check_id(FeatureOutcome& outcome);
  void find_twins();

  SolidStore& store_;
  delaunay::EngineWorkers* workers_;
  IngestOptions options_;
  OutcomeSink on_feature_;
  IngestProgress progress_;
  FeatureSpool spool_;
  std::optional<FeaturePacker> packer_;  // present after look_up_collection()
  std::unordered_set<std::string> ids_;
  bool has_looked_up_ = false;
  std::optional<Policy> new_policy_;   // of the collection that this write makes
  std::optional<std::uint32_t> srid_;  // that of the collection, or of the first feature
  std::uint64_t unnamed_ = 0;          // the number of features without an id
  IngestCounts counts_;
  std::vector<std::uint64_t> versions_;
  std::vector<store::Twins> twins_;
};

/// Keeps the outcomes of features for an answer: all while they are few and their reports short,
/// else the first of those that are not valid. One is kept, however long its reports are.
class OutcomeKeeper {
 public:
  OutcomeKeeper(std::size_t most, std::uint64_t most_bytes)
      : most_(most), most_bytes_(most_bytes) {}
  void add(FeatureOutcome&& outcome);
  /// The outcomes with what finish() of the ingestion has made of them and counted.
  IngestOutcome outcome(const IngestCounts& counts, const Ingestion& ingestion) &&;

 private:
  struct Kept {
    FeatureOutcome outcome;
    std::uint64_t bytes = 0;  // of its reports
    std::uint64_t rank = 0;   // the number of features to be stored before it
  };
  bool is_full_with(std::uint64_t bytes) const {
    return kept_.size() == most_ || (!kept_.empty() && bytes_ + bytes > most_bytes_);
  }

  std::size_t most_;
  std::uint64_t most_bytes_;
  std::uint64_t bytes_ = 0;  // of the reports that are kept
  bool has_all_ = true;
  std::uint64_t stored_ = 0;
  std::vector<Kept> kept_;
};

/// Validates, encodes and stores the features of a reader; the outcome has all of them. Errors:
/// those of Ingestion.
Result<IngestOutcome> ingest(formats::FeatureReader& reader, SolidStore& store,
                             delaunay::EngineWorkers* workers, const IngestOptions& options);

}  // namespace watertight::pipeline
