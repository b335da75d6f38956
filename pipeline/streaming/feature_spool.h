// SPDX-License-Identifier: GPL-3.0-or-later
//
// Encoded features between their validation and the moment when the whole document is known to be
// good: one batch in memory, the others in a temporary file without a name.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "base/temporary_file.h"
#include "store/solid_store.h"

namespace watertight::pipeline {

class FeatureSpool final : public store::FeatureBatches {
 public:
  /// A batch is full with this many bytes, or with 5,000 features.
  explicit FeatureSpool(std::size_t batch_bytes) : batch_bytes_(batch_bytes) {}

  /// Adds a feature, in memory if it fits the first batch. Errors: unavailable when the folder for
  /// temporary files (TMPDIR, else /tmp) cannot take it.
  Status add(StoredFeature feature);
  /// Removes all features.
  void clear();
  std::uint64_t size() const { return size_; }
  /// The features when one batch holds them all.
  bool is_one_batch() const { return batches_.empty(); }
  std::span<const StoredFeature> open_batch() const { return open_; }

  Status rewind() override;
  Result<std::span<const StoredFeature>> next() override;

 private:
  struct Batch {
    std::uint64_t features = 0;
    std::uint64_t offset = 0;  // in the file
    std::size_t bytes = 0;
  };
  Status write_batch();
  Status read_batch(const Batch& batch);
  std::uint64_t number_of(const SharedText& header);
  std::uint64_t number_of(const packing::DictionaryPointer& dictionary);

  std::size_t batch_bytes_;
  std::vector<StoredFeature> open_;  // the last batch, which is not in the file
  std::size_t open_bytes_ = 0;
  std::optional<TemporaryFile> file_;
  std::vector<Batch> batches_;       // the batches in the file
  std::vector<SharedText> headers_;  // the headers of the features in the file
  std::map<SharedText, std::uint64_t> header_numbers_;
  std::vector<packing::DictionaryPointer> dictionaries_;  // those of the features in the file
  std::vector<StoredFeature> read_;                       // the batch that next() returned
  std::size_t given_ = 0;  // the number of batches that next() has returned
  std::uint64_t size_ = 0;
};

}  // namespace watertight::pipeline
