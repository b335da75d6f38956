// SPDX-License-Identifier: GPL-3.0-or-later
// Writes and reads features as rows: the SQL of postgres_store. Each function is a part of a
// transaction that the caller begins and ends. For postgres_store.cpp only.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "base/shared_text.h"
#include "store/connection.h"
#include "store/rows/shared_rows.h"
#include "store/solid_store.h"

namespace watertight::store {

/// Ok when every feature can be stored as it is: ids are present, short enough for an index and
/// UTF-8 without NUL, boxes are finite, and no feature or solid occurs twice. Errors:
/// invalid_argument, conflict.
Status check_features(std::span<const StoredFeature> features);
Status check_box(const StoredBox& box);
/// Well-formed UTF-8 (no overlong forms, no surrogates) without NUL, which PostgreSQL's text cannot
/// hold.
bool is_plain_utf8(std::string_view text);
/// False for an id that no stored feature can have.
bool is_possible_id(const std::string& id);

using FeatureRefs = std::span<const StoredFeature* const>;

/// Whether a feature gets a new version or that of FeatureRecord::version.
enum class Versions : std::uint8_t { drawn, kept };

/// Writes documents, collections, kinds, dictionaries and features, and the values of chosen
/// attributes unless versions are kept. Returns the version of each feature. Requires
/// check_features(). Errors: conflict when the CRS of a feature is not that of its collection.
Result<std::vector<std::uint64_t>> write_features(DatabaseSession& connection, FeatureRefs features,
                                                  const WriteCondition& condition,
                                                  SharedRows& shared, const AttributeReader& reader,
                                                  Versions versions = Versions::drawn);
/// Replaces the packed texts and solids of features whose versions are those of the rows, and
/// returns how many that were. Requires check_features().
Result<std::uint64_t> repack_features(DatabaseSession& connection, FeatureRefs features,
                                      SharedRows& shared);

/// Errors: not_found, precondition_failed.
Result<Done> delete_feature(DatabaseSession& connection, const std::string& collection,
                            const std::string& id, const WriteCondition& condition);

/// Writers of a collection share its gate until they end; who changes its name has the gate alone.
/// The gate is fair, which the lock of the collection's row is not: without it, new writers would
/// keep a change of the name waiting for ever.
enum class Gate : std::uint8_t { shared, alone };
void send_gate(DatabaseSession& connection, std::string_view collection, Gate gate);

/// Makes a collection one without a name, which no reader or writer finds. Returns its key. Waits
/// for the writers of the collection. Errors: not_found.
Result<std::string> hide_collection(DatabaseSession& connection, const std::string& id);
/// Errors: not_found, conflict.
/// Sets the policy of a collection. Errors: not_found.
Result<Done> make_collection(DatabaseSession& connection, const std::string& id,
                             std::uint32_t srid);
Result<Done> set_policy(DatabaseSession& connection, const std::string& id, Policy policy);
Result<Done> set_rules(DatabaseSession& connection, const std::string& id,
                       const std::string& rules);
Result<Done> rename_collection(DatabaseSession& connection, const std::string& id,
                               const std::string& new_id);
/// The key of a collection without a name; "" when there is none.
Result<std::string> read_hidden_collection(DatabaseSession& connection);
/// Deletes up to 1,000 features of a collection without a name, those after `after`. Returns the
/// place of the last of them; or "" when there was none left, and then deletes the collection.
Result<std::string> purge_step(DatabaseSession& connection, const std::string& key,
                               const std::string& after);

// The largest page or batch.
constexpr std::uint64_t kLargestPage = 10'000;

/// The error for a collection that does not exist.
Error no_collection(const std::string& id);
Error no_feature(const std::string& collection, const std::string& id);
/// The box in six columns: the minima on x, y and z, then the maxima. Nothing where they are NULL.
std::optional<StoredBox> box_of(const Rows& rows, int row, int first_column);

Result<CollectionPage> read_collections(DatabaseSession& connection, std::uint64_t limit,
                                        const std::string& after);
Result<StoredCollection> read_collection(DatabaseSession& connection, const std::string& id);
/// Brings the counts and boxes of all collections up to date with their changes. Does nothing while
/// another session does it.
Result<Done> fold_changes(DatabaseSession& connection);
/// Counts a collection from its features. Errors: not_found.
Result<StoredCollection> recount_collection(DatabaseSession& connection, const std::string& id);

Result<StoredFeature> read_feature(DatabaseSession& connection, const std::string& collection,
                                   const std::string& id, SharedRows& shared);
/// The features of these ids that exist, in order of their ids; `ids` are in order. No other
/// transaction changes them before the end of this one.
Result<std::vector<StoredFeature>> lock_features(DatabaseSession& connection,
                                                 const std::string& collection,
                                                 std::span<const std::string> ids,
                                                 SharedRows& shared);
/// The newest dictionary of a collection; null: none.
Result<packing::DictionaryPointer> read_dictionary(DatabaseSession& connection,
                                                   const std::string& collection,
                                                   SharedRows& shared);
Result<std::uint64_t> read_version(DatabaseSession& connection, const std::string& collection,
                                   const std::string& id);
/// The key of a collection. Errors: not_found.
Result<std::string> key_of_collection(DatabaseSession& connection, const std::string& id);
Result<FeaturePage> read_page(DatabaseSession& connection, const FeatureQuery& query);
Result<FeatureBatch> read_batch(DatabaseSession& connection, const std::string& collection,
                                std::uint64_t limit, const std::string& after,
                                const std::optional<Filter>& filter, SharedRows& shared);
Result<std::vector<Twins>> read_twins(DatabaseSession& connection, const std::string& collection,
                                      std::span<const std::string> ids);
Result<PlacedPage> read_places(DatabaseSession& connection, const std::string& collection,
                               std::uint64_t limit, const std::string& after, bool only_unproven);
Result<std::vector<std::string>> read_ranked(DatabaseSession& connection, const RankQuery& query,
                                             std::uint64_t limit);
Result<std::vector<StoredHeader>> read_documents(DatabaseSession& connection,
                                                 const std::string& collection,
                                                 std::uint64_t limit);

}  // namespace watertight::store
