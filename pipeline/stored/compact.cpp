// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/stored/compact.h"

#include <optional>
#include <utility>
#include <vector>

#include "packing/text_dictionary.h"
#include "pipeline/pipeline.h"
#include "pipeline/stored/samples.h"
#include "pipeline/stored/solid_page.h"

namespace watertight::pipeline {
namespace {

constexpr std::uint64_t kCompactBatch = 200;

bool is_same(const packing::DictionaryPointer& a, const packing::DictionaryPointer& b) {
  return a == b || (a && b && a->content() == b->content());
}

/// The dictionary for all features: the newest, or a better one. Features that an older program
/// wrote have longer texts than this one writes: then it is always a new one.
Result<packing::DictionaryPointer> dictionary_for(SolidStore& store, const std::string& collection,
                                                  std::uint64_t features) {
  auto newest = store.dictionary(collection);
  if (!newest) return newest;
  const auto samples = sample_features(store, collection, packing::kEnoughSamples);
  if (!samples) return samples.error();
  std::vector<std::string> texts;
  bool is_outdated = false;
  for (const StoredFeature& feature : *samples) {
    const auto stored = packing::unpack(feature.skeleton.bytes, feature.skeleton.dictionary.get(),
                                        packing::kMostExampleBytes);
    if (!stored && stored.error().code == ErrorCode::limit_exceeded) continue;  // no example
    if (!stored) return stored.error();
    const auto encoded = unpack(feature);
    if (!encoded) return encoded.error();
    texts.push_back(stored_text(*encoded));
    is_outdated = is_outdated || *stored != texts.back();
  }
  return packing::best_dictionary(texts, features, is_outdated ? nullptr : *newest);
}

/// The feature with a text that is shorter with the dictionary, or with its solids in a page;
/// nothing if neither makes it smaller.
Result<std::optional<StoredFeature>> packed_smaller(StoredFeature feature,
                                                    const packing::DictionaryPointer& dictionary) {
  if (!is_same(feature.skeleton.dictionary, dictionary)) {
    auto encoded = unpack(feature);
    if (!encoded) return std::move(encoded).error();
    auto packed = pack(*std::move(encoded), dictionary);
    if (!packed) return std::move(packed).error();
    if (packed->skeleton.bytes.size() < feature.skeleton.bytes.size()) {
      return std::optional(*std::move(packed));
    }
  }
  if (!may_share_page(feature)) return std::optional<StoredFeature>();
  if (Status put = put_in_page(feature); !put) return std::move(put).error();
  if (feature.page.empty()) return std::optional<StoredFeature>();
  return std::optional(std::move(feature));
}

}  // namespace

Result<CompactCounts> compact(SolidStore& store, const std::string& collection,
                              const CancelPoll& is_cancelled,
                              const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
  const auto found = store.collection(collection);
  if (!found) return found.error();
  const auto dictionary = dictionary_for(store, collection, found->features);
  if (!dictionary) return dictionary.error();
  CompactCounts counts;
  for (std::string after;;) {
    if (is_cancelled && is_cancelled()) {
      return Error{ErrorCode::cancelled, "stopped; what was packed stays packed"};
    }
    auto batch = store.walk(collection, kCompactBatch, after);
    if (!batch) return std::move(batch).error();
    std::vector<StoredFeature> repacked;
    for (StoredFeature& feature : batch->features) {
      const std::uint64_t bytes = feature.skeleton.bytes.size();
      ++counts.features;
      counts.bytes_before += bytes;
      auto smaller = packed_smaller(std::move(feature), *dictionary);
      if (!smaller) return std::move(smaller).error();
      counts.bytes_after += *smaller ? (*smaller)->skeleton.bytes.size() : bytes;
      if (*smaller) repacked.push_back(**std::move(smaller));
    }
    const auto written = store.repack(repacked);
    if (!written) return written.error();
    counts.repacked += *written;
    if (progress) progress(counts.features, found->features);
    if (batch->next.empty()) return counts;
    after = std::move(batch->next);
  }
}

}  // namespace watertight::pipeline
