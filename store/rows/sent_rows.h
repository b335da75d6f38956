// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rows that features refer to, written before them: documents, collections, kinds,
// dictionaries. Each function is a part of a transaction.
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

#include "base/bytes.h"
#include "base/result.h"
#include "base/shared_text.h"
#include "store/connection.h"
#include "store/rows/feature_rows.h"
#include "store/rows/shared_rows.h"

namespace watertight::store {

/// The SHA-256 of headers.
using Digests = std::map<SharedText, Bytes>;

/// Sends each distinct header once. Returns the SHA-256 of each; waits for those that are new.
Result<Digests> send_documents(DatabaseSession& connection, FeatureRefs features,
                               SharedRows& shared);

/// Sends the collection of a feature, which is made with the feature's header and CRS if it does
/// not exist. Requires send_documents().
void send_collection(DatabaseSession& connection, const StoredFeature& feature,
                     const Digests& digests);

/// Sends the kinds of features. Requires send_collection() for each collection.
void send_kinds(DatabaseSession& connection, FeatureRefs features, const Digests& digests);

/// The keys of dictionaries in the collections of a write.
class DictionaryKeys {
 public:
  /// Writes the dictionaries of the features that their collections do not have. Waits if there is
  /// any that `shared` does not know. Requires that the collections exist.
  static Result<DictionaryKeys> add(DatabaseSession& connection, FeatureRefs features,
                                    SharedRows& shared);
  /// The key of the dictionary of one of the features; 0 without one.
  std::int64_t of(const StoredFeature& feature) const;

 private:
  std::map<std::pair<std::string_view, const packing::TextDictionary*>, std::int64_t> keys_;
};

}  // namespace watertight::store
