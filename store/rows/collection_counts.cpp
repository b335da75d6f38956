// SPDX-License-Identifier: GPL-3.0-or-later
//
// The counts and boxes of collections. Triggers (store/migrations.cpp) note the changes of every
// write in rows of their own, in its transaction; a collection's counts are those of its row and
// these changes. So no reader counts features, and no writer waits for another's commit.
#include <algorithm>

#include "store/rows/feature_rows.h"

namespace watertight::store {
namespace {

// One session at a time changes the counts in the collections' rows: "countbox" in ASCII.
constexpr const char* kCountsLock = "x'636f756e74626f78'::bigint";

const char* const kCounts =
    "c.features, c.solids, c.blob_bytes, c.min_x, c.min_y, c.min_z, c.max_x, c.max_y, c.max_z,"
    " c.generation, c.changes, c.unproven, c.unproven_features, c.policy::int8, c.rules";

/// The changes of each collection, summed up, from a table of changes.
std::string summed(const char* changes) {
  return std::string(
             "SELECT collection, sum(features)::int8 AS features, sum(solids)::int8 AS solids,"
             " sum(blob_bytes)::int8 AS blob_bytes, sum(unproven)::int8 AS unproven,"
             " sum(unproven_features)::int8 AS unproven_features,"
             " min(min_x) AS min_x, min(min_y) AS min_y,"
             " min(min_z) AS min_z, max(max_x) AS max_x, max(max_y) AS max_y,"
             " max(max_z) AS max_z, count(*) AS changes FROM ") +
         changes;
}

/// Selects the collections of a FROM clause as `c`, with the sums of their own changes alone.
std::string collections_from(const char* collections) {
  return "SELECT c.name, c.srid, h.content, c.features + coalesce(d.features, 0),"
         " c.solids + coalesce(d.solids, 0), c.blob_bytes + coalesce(d.blob_bytes, 0),"
         " least(c.min_x, d.min_x), least(c.min_y, d.min_y), least(c.min_z, d.min_z),"
         " greatest(c.max_x, d.max_x), greatest(c.max_y, d.max_y), greatest(c.max_z, d.max_z),"
         " c.generation, c.changes + coalesce(d.changes, 0),"
         " c.unproven + coalesce(d.unproven, 0),"
         " c.unproven_features + coalesce(d.unproven_features, 0), c.policy::int8, c.rules"
         " FROM " +
         std::string(collections) +
         " c JOIN watertight.document h ON h.key = c.document"
         " LEFT JOIN LATERAL (" +
         summed("watertight.collection_change") +
         " WHERE collection = c.key GROUP BY collection) d ON true ORDER BY c.name";
}

StoredCollection collection_of(const Rows& rows, int row) {
  StoredCollection found;
  found.id = rows.text(row, 0);
  found.srid = static_cast<std::uint32_t>(rows.int8(row, 1));
  found.header = rows.text(row, 2);
  found.features = static_cast<std::uint64_t>(rows.int8(row, 3));
  found.solids = static_cast<std::uint64_t>(rows.int8(row, 4));
  found.blob_bytes = static_cast<std::uint64_t>(rows.int8(row, 5));
  if (found.features > 0) found.box = box_of(rows, row, 6);
  found.state = std::to_string(rows.int8(row, 12));
  found.state.append("-").append(std::to_string(rows.int8(row, 13)));
  found.unproven = static_cast<std::uint64_t>(rows.int8(row, 14));
  found.unproven_features = static_cast<std::uint64_t>(rows.int8(row, 15));
  found.policy = static_cast<Policy>(rows.int8(row, 16));
  found.rules = rows.text(row, 17);
  return found;
}

}  // namespace

Error no_collection(const std::string& id) {
  return {ErrorCode::not_found, "there is no collection '" + id + "'"};
}

Result<CollectionPage> read_collections(DatabaseSession& connection, std::uint64_t limit,
                                        const std::string& after) {
  const std::uint64_t at_most = std::min(limit, kLargestPage);
  // One collection more than asked for shows whether there is a next page.
  const Result<Rows> rows =
      connection.ask(collections_from("(SELECT * FROM watertight.collection WHERE name > $1"
                                      " ORDER BY name LIMIT $2)"),
                     Parameters().text(after).int8(static_cast<std::int64_t>(at_most) + 1));
  if (!rows) return rows.error();
  CollectionPage page;
  for (int row = 0; row < rows->size(); ++row) {
    page.collections.push_back(collection_of(*rows, row));
  }
  if (page.collections.size() > at_most) {
    page.collections.resize(at_most);
    if (at_most > 0) page.next = page.collections.back().id;
  }
  return page;
}

Result<StoredCollection> read_collection(DatabaseSession& connection, const std::string& id) {
  const Result<Rows> rows =
      connection.ask(collections_from("(SELECT * FROM watertight.collection WHERE name = $1)"),
                     Parameters().text(id));
  if (!rows) return rows.error();
  if (rows->size() == 0) return no_collection(id);
  return collection_of(*rows, 0);
}

Result<Done> fold_changes(DatabaseSession& connection) {
  const Result<Rows> lock = connection.ask(std::string("SELECT 1::int8 WHERE"
                                                       " pg_try_advisory_xact_lock(") +
                                           kCountsLock + ")");
  if (!lock) return lock.error();
  if (lock->size() == 0) return Done{};
  // All changes that are visible: those of a feature's removal are never without those of its
  // storing, so that counts of 0 mean an empty collection.
  const Result<Rows> folded = connection.ask(
      "WITH gone AS (DELETE FROM watertight.collection_change RETURNING *), d AS (" +
      summed("gone") +
      " GROUP BY collection) UPDATE watertight.collection c SET features = c.features + d.features,"
      " solids = c.solids + d.solids, blob_bytes = c.blob_bytes + d.blob_bytes,"
      " changes = c.changes + d.changes, unproven = c.unproven + d.unproven,"
      " unproven_features = c.unproven_features + d.unproven_features,"
      " min_x = CASE WHEN c.features + d.features > 0 THEN least(c.min_x, d.min_x) END,"
      " min_y = CASE WHEN c.features + d.features > 0 THEN least(c.min_y, d.min_y) END,"
      " min_z = CASE WHEN c.features + d.features > 0 THEN least(c.min_z, d.min_z) END,"
      " max_x = CASE WHEN c.features + d.features > 0 THEN greatest(c.max_x, d.max_x) END,"
      " max_y = CASE WHEN c.features + d.features > 0 THEN greatest(c.max_y, d.max_y) END,"
      " max_z = CASE WHEN c.features + d.features > 0 THEN greatest(c.max_z, d.max_z) END"
      " FROM d WHERE c.key = d.collection");
  if (!folded) return folded.error();
  return Done{};
}

Result<StoredCollection> recount_collection(DatabaseSession& connection, const std::string& id) {
  connection.send(std::string("SELECT pg_advisory_xact_lock(") + kCountsLock + ")");
  // One statement, so that the features that it counts are those whose changes it removes.
  const Result<Rows> counted = connection.ask(
      std::string(
          "WITH k AS (SELECT key FROM watertight.collection WHERE name = $1), gone AS"
          " (DELETE FROM watertight.collection_change WHERE collection = (SELECT key FROM k)"
          " RETURNING 1),"
          " d AS (SELECT count(*) AS features, coalesce(sum(solids), 0)::int8 AS solids,"
          " coalesce(sum(blob_bytes), 0)::int8 AS blob_bytes,"
          " coalesce(sum(unproven), 0)::int8 AS unproven,"
          " count(*) FILTER (WHERE NOT is_proven) AS unproven_features,"
          " min(min_x) AS min_x,"
          " min(min_y) AS min_y, min(min_z) AS min_z, max(max_x) AS max_x,"
          " max(max_y) AS max_y, max(max_z) AS max_z"
          " FROM watertight.feature_row WHERE collection = (SELECT key FROM k))"
          " UPDATE watertight.collection c SET (features, solids, blob_bytes, unproven,"
          " unproven_features, min_x, min_y, min_z, max_x, max_y, max_z) = (SELECT * FROM d),"
          " changes = c.changes + (SELECT count(*) FROM gone)"
          " FROM watertight.document h WHERE c.name = $1 AND h.key = c.document"
          " RETURNING c.name, c.srid, h.content, ") +
          kCounts,
      Parameters().text(id));
  if (!counted) return counted.error();
  if (counted->size() == 0) return no_collection(id);
  return collection_of(*counted, 0);
}

}  // namespace watertight::store
