// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/stored/solid_page.h"

#include <algorithm>
#include <utility>

#include "codec/page.h"

namespace watertight::pipeline {
namespace {

/// Whether a solid is in the page of its feature.
bool is_in_page(const store::FeatureRecord& feature, const StoredSolid& solid) {
  return !feature.page.empty() && solid.is_proven && solid.blob.empty();
}

/// The solids of the page of a feature; none without a page.
Result<std::vector<Decoded>> decode_own_page(const store::FeatureRecord& feature,
                                             const Limits& limits) {
  if (feature.page.empty()) return std::vector<Decoded>();
  auto decoded = codec::decode_page(feature.page, limits);
  const auto in_page =
      std::count_if(feature.solids.begin(), feature.solids.end(),
                    [&](const StoredSolid& solid) { return is_in_page(feature, solid); });
  if (decoded && decoded->size() != static_cast<std::size_t>(in_page)) {
    return Error{ErrorCode::malformed, "a page with another number of solids than its feature"};
  }
  return decoded;
}

}  // namespace

bool may_share_page(const store::FeatureRecord& feature) {
  return feature.page.empty() &&
         std::count_if(feature.solids.begin(), feature.solids.end(),
                       [](const StoredSolid& solid) { return solid.is_proven; }) > 1;
}

Status put_in_page(store::FeatureRecord& feature) {
  if (!may_share_page(feature)) return Done{};
  std::vector<ByteView> blobs;
  for (const StoredSolid& solid : feature.solids) {
    if (solid.is_proven) blobs.push_back(solid.blob);
  }
  auto page = codec::page_of_blobs(blobs);
  if (!page) return std::move(page).error();
  if (!*page) return Done{};
  feature.page = **std::move(page);
  for (StoredSolid& solid : feature.solids) solid.blob.clear();
  return Done{};
}

Result<std::vector<Decoded>> decode_solids(const store::FeatureRecord& feature,
                                           const Limits& limits) {
  auto of_page = decode_own_page(feature, limits);
  if (!of_page) return of_page;
  auto next = of_page->begin();
  std::vector<Decoded> solids;
  for (const StoredSolid& solid : feature.solids) {
    if (!solid.is_proven) continue;
    if (is_in_page(feature, solid)) {
      solids.push_back(std::move(*next++));
      continue;
    }
    auto decoded = decode(solid.blob, limits);
    if (!decoded) return std::move(decoded).error();
    solids.push_back(*std::move(decoded));
  }
  return solids;
}

Result<Bytes> blob_of(const store::FeatureRecord& feature, std::size_t solid,
                      const Limits& limits) {
  if (!is_in_page(feature, feature.solids[solid])) return feature.solids[solid].blob;
  const auto before = std::count_if(
      feature.solids.begin(), feature.solids.begin() + static_cast<std::ptrdiff_t>(solid),
      [&](const StoredSolid& other) { return is_in_page(feature, other); });
  return codec::blob_in_page(feature.page, static_cast<std::size_t>(before), limits);
}

}  // namespace watertight::pipeline
