// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/stored/samples.h"

#include <utility>

namespace watertight::pipeline {

Result<std::vector<StoredFeature>> sample_features(SolidStore& store, const std::string& collection,
                                                   std::uint64_t number) {
  store::FeatureQuery query;
  query.collection = collection;
  query.limit = number;
  const auto page = store.list(query);
  if (!page) return page.error();
  std::vector<StoredFeature> samples;
  for (const store::FeatureSummary& summary : page->features) {
    auto feature = store.get(collection, summary.id);
    if (!feature && feature.error().code == ErrorCode::not_found) continue;  // removed meanwhile
    if (!feature) return std::move(feature).error();
    samples.push_back(*std::move(feature));
  }
  return samples;
}

}  // namespace watertight::pipeline
