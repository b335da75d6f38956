// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes a whole collection of a store, in order of place numbers (SolidStore::walk), so that
// neighbours share pages. Memory does not grow with the collection: one batch of features, or one
// block of a Watertight file, at a time. When features change meanwhile, the export holds old or
// new ones, and a feature that moves may be in it twice; each feature is whole.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/cancel.h"
#include "codec/blob.h"
#include "pipeline/container.h"
#include "pipeline/sequences/sequence_plan.h"
#include "store/solid_store.h"

namespace watertight::pipeline {

enum class ExportFormat : std::uint8_t {
  container,  // a Watertight file: any number of documents, solids in pages or blobs
  sequence    // a CityJSONSeq; for features that can share one header
};

/// The features of an export: all, those that are proven (FeatureRecord::is_proven()), or the
/// others.
enum class ExportScope : std::uint8_t { all, proven, unproven };

struct Exported {
  std::uint64_t features = 0;
  std::uint64_t solids = 0;
  std::uint64_t generic = 0;  // features of a sequence that came without a city model
};

/// An export that is under way. The store must outlive it. Not thread-safe.
class CollectionExport {
 public:
  /// Starts an export, of the features for which the filter is true. Errors: those of the store;
  /// not_found (no collection, no features; but an export of what is not proven may be empty);
  /// those of SequencePlan::make(); unsupported when the features need several sequences.
  static Result<CollectionExport> start(SolidStore& store, const std::string& collection,
                                        ExportFormat format, const ContainerOptions& options = {},
                                        ExportScope scope = ExportScope::all,
                                        std::optional<store::Filter> filter = {});
  /// Starts the export of one sequence of a plan, by its number. Errors: those of the store;
  /// invalid_argument when the plan has no such sequence.
  static Result<CollectionExport> start_sequence(SolidStore& store, const std::string& collection,
                                                 std::shared_ptr<const SequencePlan> plan,
                                                 std::size_t sequence,
                                                 ExportScope scope = ExportScope::all,
                                                 std::optional<store::Filter> filter = {});

  /// The next bytes of the file: a batch of a sequence, some blocks of a Watertight file; the first
  /// call returns after one feature. Empty after the last ones. Errors: those of the store;
  /// malformed when a stored feature is damaged; unsupported as for start(); cancelled, asked for
  /// before each feature. After an error the file has no end.
  Result<Bytes> next(const CancelPoll& is_cancelled = {});

  /// True when the last bytes have been returned.
  bool is_at_end() const { return is_last_; }
  /// The numbers of features and solids that next() has read so far.
  const Exported& exported() const { return exported_; }

 private:
  CollectionExport(SolidStore& store, std::string collection)
      : store_(&store), collection_(std::move(collection)) {}
  Status add(StoredFeature feature, Bytes& bytes);
  Status add_line(StoredFeature feature, Bytes& bytes);

  SolidStore* store_;
  std::string collection_;
  ExportScope scope_ = ExportScope::all;
  std::optional<store::Filter> filter_;
  std::optional<ContainerWriter> container_;  // none for a sequence
  std::shared_ptr<const SequencePlan> plan_;  // of a sequence
  std::size_t sequence_ = 0;                  // its number in the plan
  std::string after_;                         // where the next batch starts
  std::string key_;                           // FeatureBatch::key of the first batch
  bool is_first_ = true;
  bool is_last_ = false;
  Exported exported_;
};

}  // namespace watertight::pipeline
