// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/streaming/feature_packer.h"

#include <bit>
#include <utility>

#include "geometry/parallel.h"

namespace watertight::pipeline {
namespace {

constexpr std::size_t kMostWaiting = 2000;
constexpr std::size_t kMostWaitingBytes = 8 << 20;
// A document with more features than wait is expected to have so many times as many.
constexpr std::uint64_t kLonger = 4;

}  // namespace

Result<PreparedFeature> FeaturePacker::prepare(EncodedFeature encoded) {
  PreparedFeature feature{std::move(encoded), {}, {}};
  feature.text = stored_text(feature.encoded);
  packing::DictionaryPointer dictionary;
  {
    const std::lock_guard lock(mutex_);
    if (!is_chosen_) return feature;
    dictionary = dictionary_;
  }
  auto packed = pack(feature.text, std::move(feature.encoded), dictionary);
  if (!packed) return std::move(packed).error();
  feature.packed = *std::move(packed);
  return feature;
}

Status FeaturePacker::add(PreparedFeature feature, FeatureSpool& spool) {
  if (feature.packed) return spool.add(*std::move(feature.packed));
  waiting_bytes_ += feature.text.size();
  waiting_.push_back(std::move(feature));
  const bool is_full = waiting_.size() >= kMostWaiting || waiting_bytes_ >= kMostWaitingBytes;
  return is_full || is_chosen_ ? choose(waiting_.size() * kLonger, spool) : Done{};
}

Status FeaturePacker::finish(FeatureSpool& spool) { return choose(waiting_.size(), spool); }

/// The collection's dictionary, or a new one. A document asks for one when the number of features
/// passes a power of two, with stored features as samples if it has few; one of many features also
/// when there is none, and when the newest no longer fits.
Result<packing::DictionaryPointer> FeaturePacker::dictionary_for(
    const std::vector<PreparedFeature>& features, std::uint64_t expected) const {
  std::vector<std::string> texts;
  for (const PreparedFeature& feature : features) texts.push_back(feature.text);
  const bool has_grown = std::bit_width(stored_) < std::bit_width(stored_ + texts.size()) &&
                         stored_ + texts.size() >= packing::kFewestSamples;
  if (texts.size() < packing::kFewestSamples && !has_grown) return dictionary_;
  if (has_grown && stored_ > 0 && texts.size() < packing::kEnoughSamples) {
    auto samples = samples_();
    if (!samples) return std::move(samples).error();
    texts.insert(texts.end(), samples->begin(), samples->end());
  }
  if (!has_grown) {
    const auto fits = packing::still_fits(dictionary_.get(), texts);
    if (!fits) return fits.error();
    if (*fits) return dictionary_;
  }
  return packing::best_dictionary(texts, stored_ + expected, dictionary_);
}

Status FeaturePacker::choose(std::uint64_t expected, FeatureSpool& spool) {
  std::vector<PreparedFeature> features = std::exchange(waiting_, {});
  if (!is_chosen_) {
    auto dictionary = dictionary_for(features, expected);
    if (!dictionary) return std::move(dictionary).error();
    const std::lock_guard lock(mutex_);
    dictionary_ = *std::move(dictionary);
    is_chosen_ = true;
  }
  std::vector<std::optional<Result<StoredFeature>>> packed(features.size());
  geometry::for_each_piece(
      features.size(), static_cast<unsigned>(threads_), [&](std::size_t i, bool) {
        packed[i] = pack(features[i].text, std::move(features[i].encoded), dictionary_);
      });
  for (std::optional<Result<StoredFeature>>& feature : packed) {
    if (!*feature) return std::move(*feature).error();
    if (Status added = spool.add(**std::move(feature)); !added) return added;
  }
  return Done{};
}

}  // namespace watertight::pipeline
