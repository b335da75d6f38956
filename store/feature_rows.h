// SPDX-License-Identifier: GPL-3.0-or-later
// Writes and reads features as rows: the SQL of postgres_store. Each function is a part of a
// transaction that the caller begins and ends. For postgres_store.cpp only.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "store/connection.h"
#include "store/solid_store.h"

namespace watertight::store {

/// Ok when every feature can be stored as it is: ids are present, short enough for an index and
/// UTF-8 without NUL, boxes are finite, and no feature or solid occurs twice. Errors:
/// invalid_argument, conflict.
Status check_features(std::span<const StoredFeature> features);
Status check_collection_id(const std::string& id);
Status check_box(const StoredBox& box);
/// False for an id that no stored feature can have.
bool is_possible_id(const std::string& id);

/// Writes headers, collections, features and solids. Returns the version of each feature. Requires
/// check_features(). Errors: conflict when the CRS of a feature is not that of its collection.
Result<std::vector<std::uint64_t>> write_features(DatabaseSession& connection,
                                                  std::span<const StoredFeature> features);

/// Errors: not_found.
Result<Done> delete_feature(DatabaseSession& connection, const std::string& collection,
                            const std::string& id);

/// The error for a collection that does not exist.
Error no_collection(const std::string& id);
/// The box in six columns: the minima on x, y and z, then the maxima. Nothing where they are NULL.
std::optional<StoredBox> box_of(const Rows& rows, int row, int first_column);

Result<std::vector<StoredCollection>> read_collections(DatabaseSession& connection);
Result<StoredCollection> read_collection(DatabaseSession& connection, const std::string& id);
/// Brings the counts and boxes of all collections up to date with their changes. Does nothing while
/// another session does it.
Result<Done> fold_changes(DatabaseSession& connection);
/// Counts a collection from its features. Errors: not_found.
Result<StoredCollection> recount_collection(DatabaseSession& connection, const std::string& id);

Result<StoredFeature> read_feature(DatabaseSession& connection, const std::string& collection,
                                   const std::string& id);
Result<FeaturePage> read_page(DatabaseSession& connection, const FeatureQuery& query);
Result<FeatureBatch> read_batch(DatabaseSession& connection, const std::string& collection,
                                std::uint64_t limit, const std::string& after);
Result<std::vector<StoredHeader>> read_documents(DatabaseSession& connection,
                                                 const std::string& collection,
                                                 std::uint64_t limit);

}  // namespace watertight::store
