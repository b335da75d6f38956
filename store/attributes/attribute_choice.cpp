// SPDX-License-Identifier: GPL-3.0-or-later
//
// The choice of attributes: names are added and removed at one moment, while no writer is under
// way. So every writer after that keeps the values of its features itself, and the values of those
// that were there before are filled in, in order of the hashes of their ids.
#include <algorithm>
#include <set>

#include "store/attributes/attribute_rows.h"
#include "store/attributes/attribute_values.h"

namespace watertight::store {
namespace {

constexpr std::int64_t kChoiceBatch = 200;
constexpr std::int64_t kBatchBytes = 16 << 20;  // of packed texts and solids

// An attribute that is not complete has less than the whole share.
constexpr const char* kRead = R"(
  SELECT n.name, CASE WHEN n.is_complete THEN 1 ELSE
      least(0.999, coalesce(n.filled::float8 / 18446744073709551616 + 0.5, 0)) END::float8,
    EXISTS (SELECT FROM watertight.attribute_value v
            WHERE v.attribute = n.key AND v.number IS NOT NULL)::int::int8,
    EXISTS (SELECT FROM watertight.attribute_value v
            WHERE v.attribute = n.key AND v.text IS NOT NULL)::int::int8,
    EXISTS (SELECT FROM watertight.attribute_value v
            WHERE v.attribute = n.key AND v.truth IS NOT NULL)::int::int8
  FROM watertight.attribute_name n JOIN watertight.collection c ON c.key = n.collection
  WHERE c.name = $1 AND n.name IS NOT NULL ORDER BY n.name)";

constexpr const char* kAdd = R"(
  INSERT INTO watertight.attribute_name (collection, name)
  SELECT c.key, u.name FROM watertight.collection c, unnest($2::text[]) AS u (name)
  WHERE c.name = $1 ON CONFLICT (collection, name) DO NOTHING)";

constexpr const char* kRemove = R"(
  UPDATE watertight.attribute_name n SET name = NULL, is_complete = false
  FROM watertight.collection c
  WHERE c.key = n.collection AND c.name = $1 AND n.name = ANY ($2::text[]))";

// Those that are filled least, with a lock that makes other fillers wait.
constexpr const char* kToFill = R"(
  SELECT n.key::int8, n.name, n.filled FROM watertight.attribute_name n
  WHERE NOT n.is_complete AND n.name IS NOT NULL AND n.collection = (
    SELECT key FROM watertight.collection WHERE name = $1)
  ORDER BY n.filled NULLS FIRST, n.name FOR UPDATE OF n)";

constexpr const char* kNext = R"(
  SELECT f.id, hashtextextended(f.id, 0),
    (octet_length(f.packed_text) + octet_length(f.packed_solids))::int8
  FROM watertight.feature_row f WHERE f.collection = (
    SELECT key FROM watertight.collection WHERE name = $1)
  AND ($2 = '' OR hashtextextended(f.id, 0) > nullif($2, '')::int8)
  ORDER BY hashtextextended(f.id, 0) LIMIT $3)";

constexpr const char* kFilled = R"(
  UPDATE watertight.attribute_name SET filled = nullif($2, '')::int8, is_complete = $3 = 1
  WHERE key = ANY ($1::int8[]))";

/// The attributes that are filled up to one hash, the lowest; `filled` is "" for none.
struct ToFill {
  AttributeKeys attributes;
  std::string filled;
};

std::string hash_text(const Rows& rows, int row, int column) {
  return rows.is_null(row, column) ? std::string() : std::to_string(rows.int8(row, column));
}

Result<ToFill> read_to_fill(DatabaseSession& connection, const std::string& collection) {
  const Result<Rows> rows = connection.ask(kToFill, Parameters().text(collection));
  if (!rows) return rows.error();
  ToFill least;
  for (int row = 0; row < rows->size(); ++row) {
    const std::string filled = hash_text(*rows, row, 2);
    if (row == 0) least.filled = filled;
    if (filled != least.filled) break;
    least.attributes.keys.push_back(rows->int8(row, 0));
    least.attributes.names.emplace_back(rows->text(row, 1));
  }
  return least;
}

/// The ids of the next features, in order; the hash of the last; and whether there are more.
struct NextFeatures {
  std::vector<std::string> ids;
  std::string last;
  bool is_end = true;
};

Result<NextFeatures> read_next(DatabaseSession& connection, const std::string& collection,
                               const std::string& after) {
  const Result<Rows> rows =
      connection.ask(kNext, Parameters().text(collection).text(after).int8(kChoiceBatch));
  if (!rows) return rows.error();
  NextFeatures next{{}, after, rows->size() < kChoiceBatch};
  std::int64_t bytes = 0;
  for (int row = 0; row < rows->size(); ++row) {
    bytes += rows->int8(row, 2);
    if (bytes > kBatchBytes && row > 0) {
      next.is_end = false;
      break;
    }
    next.ids.emplace_back(rows->text(row, 0));
    next.last = hash_text(*rows, row, 1);
  }
  std::sort(next.ids.begin(), next.ids.end());  // writers lock in this order too
  return next;
}

}  // namespace

Result<std::vector<ChosenAttribute>> read_attributes(DatabaseSession& connection,
                                                     const std::string& collection) {
  const Result<Rows> rows = connection.ask(kRead, Parameters().text(collection));
  if (!rows) return rows.error();
  if (rows->size() == 0) {
    if (auto found = read_collection(connection, collection); !found) {
      return std::move(found).error();
    }
  }
  std::vector<ChosenAttribute> chosen;
  for (int row = 0; row < rows->size(); ++row) {
    chosen.push_back({std::string(rows->text(row, 0)), rows->float8(row, 1),
                      rows->int8(row, 2) != 0, rows->int8(row, 3) != 0, rows->int8(row, 4) != 0});
  }
  return chosen;
}

Result<Done> choose_attributes(DatabaseSession& connection, const std::string& collection,
                               const AttributeChange& change) {
  send_gate(connection, collection, Gate::alone);
  const auto chosen = read_attributes(connection, collection);
  if (!chosen) return chosen.error();
  std::set<std::string> names;
  for (const ChosenAttribute& one : *chosen) names.insert(one.name);
  for (const std::string& name : change.remove) {
    if (names.erase(name) > 0) continue;
    return Error{ErrorCode::not_found,
                 "the attribute '" + name + "' of collection '" + collection + "' is not chosen"};
  }
  names.insert(change.add.begin(), change.add.end());
  if (names.size() > kMostAttributes) {
    return Error{ErrorCode::invalid_argument,
                 "a collection can choose " + std::to_string(kMostAttributes) + " attributes"};
  }
  const std::vector<std::string_view> removed(change.remove.begin(), change.remove.end());
  const std::vector<std::string_view> added(change.add.begin(), change.add.end());
  connection.send(kRemove, Parameters().text(collection).text_array(removed));
  connection.send(kAdd, Parameters().text(collection).text_array(added));
  if (const auto done = connection.results(); !done) return done.error();
  return Done{};
}

Result<double> fill_attributes(DatabaseSession& connection, const std::string& collection,
                               SharedRows& shared, const AttributeReader& reader) {
  constexpr double kHashes = 18446744073709551616.0;
  send_gate(connection, collection, Gate::shared);
  const auto to_fill = read_to_fill(connection, collection);
  if (!to_fill) return to_fill.error();
  if (to_fill->attributes.keys.empty()) return 1.0;
  const auto next = read_next(connection, collection, to_fill->filled);
  if (!next) return next.error();
  const auto features = lock_features(connection, collection, next->ids, shared);
  if (!features) return features.error();
  std::vector<const StoredFeature*> all;
  for (const StoredFeature& feature : *features) all.push_back(&feature);
  if (Status kept = write_values(connection, all, to_fill->attributes, reader); !kept) {
    return std::move(kept).error();
  }
  const Result<Rows> filled = connection.ask(
      kFilled,
      Parameters().int8_array(to_fill->attributes.keys).text(next->last).int8(next->is_end));
  if (!filled) return filled.error();
  // Others may be filled less far: only a call that finds none to be filled returns 1.
  return next->last.empty() ? 0.0 : std::min(0.999, std::stod(next->last) / kHashes + 0.5);
}

Result<bool> purge_attributes(DatabaseSession& connection) {
  const Result<Rows> removed = connection.ask(
      "SELECT key::int8 FROM watertight.attribute_name WHERE name IS NULL LIMIT 1 FOR UPDATE");
  if (!removed) return removed.error();
  if (removed->size() == 0) return false;
  const std::int64_t key = removed->int8(0, 0);
  for (const char* column : {"number", "text", "truth"}) {
    const Result<Rows> gone = connection.ask(
        std::string("WITH gone AS (DELETE FROM watertight.attribute_value WHERE ctid = ANY (ARRAY("
                    "SELECT ctid FROM watertight.attribute_value WHERE attribute = $1::int8::int4"
                    " AND ")
            .append(column)
            .append(" IS NOT NULL LIMIT 10000)) RETURNING 1)"
                    " SELECT count(*)::int8 FROM gone"),
        Parameters().int8(key));
    if (!gone) return gone.error();
    if (gone->int8(0, 0) > 0) return true;
  }
  const Result<Rows> last = connection.ask("DELETE FROM watertight.attribute_name WHERE key = $1",
                                           Parameters().int8(key));
  if (!last) return last.error();
  return true;
}

}  // namespace watertight::store
