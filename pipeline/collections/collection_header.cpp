// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/collections/collection_header.h"

namespace watertight::pipeline {

Result<std::string> collection_header(SolidStore& store, const std::string& collection) {
  // So many that there is another header among them if there is one: each format may come once.
  constexpr std::uint64_t kFormats = 16;
  const auto documents = store.documents(collection, kFormats);
  if (!documents) return documents.error();
  std::string header;
  for (const store::StoredHeader& document : *documents) {
    if (document.header.empty() || document.header == header) continue;
    if (header.empty()) {
      header = document.header;
      continue;
    }
    return Error{ErrorCode::conflict,
                 "collection '" + collection +
                     "' has features under several headers, so the transform of a CityJSONFeature "
                     "alone is not known: send a CityJSONSeq whose first line is the header"};
  }
  if (!header.empty()) return header;
  const auto found = store.collection(collection);
  if (found) return found->header;
  if (found.error().code == ErrorCode::not_found) return std::string();
  return found.error();
}

}  // namespace watertight::pipeline
