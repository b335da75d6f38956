// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "store/attributes/attribute_rows.h"
#include "store/attributes/filter_rows.h"
#include "store/rows/feature_rows.h"
#include "store/rows/packed_solids.h"

namespace watertight::store {
namespace {

constexpr std::int64_t kBatchBytes = 16 << 20;  // the most bytes of blobs and skeletons in a batch

const char* const kFeatureColumns =
    "SELECT f.id, f.version, f.kind::int8, f.dictionary::int8, f.solids::int8, f.packed_solids,"
    " f.packed_text, f.min_x, f.min_y, f.min_z, f.max_x, f.max_y, f.max_z,"
    " (f.is_proven OR f.unproven > 0)::int::int8, c.srid";
constexpr int kColumns = 15;

Error damaged(const std::string& id) {
  return {ErrorCode::unavailable, "the rows of the stored feature '" + id + "' do not fit"};
}

/// The feature in a row, whose columns are kFeatureColumns.
Result<StoredFeature> feature_of(const Rows& rows, int row, const std::string& collection,
                                 const SharedRows::Found& shared) {
  StoredFeature feature;
  feature.collection = collection;
  feature.id = rows.text(row, 0);
  feature.version = static_cast<std::uint64_t>(rows.int8(row, 1));
  const auto kind = shared.kinds.find(rows.int8(row, 2));
  const auto dictionary = shared.dictionaries.find(rows.int8(row, 3));
  const auto unpacked = unpack_solids(feature, static_cast<std::uint64_t>(rows.int8(row, 4)),
                                      as_bytes(rows.text(row, 5)));
  if (kind == shared.kinds.end() || dictionary == shared.dictionaries.end() || !unpacked) {
    return damaged(feature.id);
  }
  feature.type = kind->second.type;
  feature.format = kind->second.format;
  feature.header = kind->second.header;
  const ByteView text = as_bytes(rows.text(row, 6));
  feature.skeleton = {{text.begin(), text.end()}, dictionary->second};
  feature.box = box_of(rows, row, 7);
  feature.has_findings = rows.int8(row, 13) == 0;
  feature.srid = static_cast<std::uint32_t>(rows.int8(row, 14));
  return feature;
}

/// The features in the rows, with what they share. No kind or dictionary is missing: rows refer to
/// those that exist, and a read that sees several states of the database reads one feature.
Result<std::vector<StoredFeature>> features_of(DatabaseSession& connection, const Rows& rows,
                                               const std::string& collection, SharedRows& shared) {
  std::vector<std::int64_t> kinds;
  std::vector<std::int64_t> dictionaries;
  for (int row = 0; row < rows.size(); ++row) {
    kinds.push_back(rows.int8(row, 2));
    dictionaries.push_back(rows.int8(row, 3));
  }
  const auto found = shared.find(connection, kinds, dictionaries);
  if (!found) return found.error();
  std::vector<StoredFeature> features;
  for (int row = 0; row < rows.size(); ++row) {
    auto feature = feature_of(rows, row, collection, *found);
    if (!feature) return std::move(feature).error();
    features.push_back(*std::move(feature));
  }
  return features;
}

/// The place number and the id after which the next batch of features begins.
struct WalkPlace {
  std::int64_t place = -1;  // less than the place number of every feature
  std::string id;
};

std::string to_string(const WalkPlace& after) {
  std::string text = std::to_string(after.place);
  text += ':';
  return text += after.id;
}

Result<WalkPlace> walk_place(const std::string& text) {
  WalkPlace after;
  if (text.empty()) return after;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, after.place);
  if (error == std::errc{} && after.place >= 0 && rest != end && *rest == ':') {
    after.id.assign(rest + 1, end);
    if (is_possible_id(after.id)) return after;
  }
  return Error{ErrorCode::invalid_argument, "a batch cannot start after '" + text + "'"};
}

/// Selects `columns` and the place numbers of the next features, in order of place number and id.
/// With c.name = $1 instead of the subquery PostgreSQL 15 sorts the whole collection for each
/// batch.
Result<Rows> walk_rows(DatabaseSession& connection, const std::string& columns,
                       const std::string& collection, const WalkPlace& after, std::int64_t limit,
                       const std::optional<Filter>& filter, bool only_unproven = false) {
  Parameters parameters;
  parameters.text(collection).int8(after.place).text(after.id).int8(limit);
  std::string statement = columns;
  statement.append(
      ", f.place FROM watertight.feature_row f JOIN watertight.collection c ON c.key = f.collection"
      " WHERE c.key = (SELECT key FROM watertight.collection WHERE name = $1)"
      " AND f.place >= $2 AND (f.place, f.id) > ($2, $3)");
  int next = 5;
  if (filter) statement.append(" AND ").append(filter_clause(*filter, next, parameters));
  if (only_unproven) statement.append(" AND NOT f.is_proven");
  statement.append(" ORDER BY f.place, f.id LIMIT $4");
  return filter ? connection.run(statement, parameters) : connection.ask(statement, parameters);
}

/// How many of the next features make a batch, and whether it is the last batch.
struct BatchSize {
  std::int64_t features = 0;
  bool is_last = true;
};

Result<BatchSize> batch_size(DatabaseSession& connection, const std::string& collection,
                             const WalkPlace& after, std::int64_t limit,
                             const std::optional<Filter>& filter) {
  const Result<Rows> rows = walk_rows(
      connection, "SELECT (octet_length(packed_solids) + octet_length(packed_text))::int8",
      collection, after, limit + 1, filter);
  if (!rows) return rows.error();
  BatchSize size;
  for (std::int64_t bytes = 0; size.features < rows->size() && size.features < limit;) {
    bytes += rows->int8(static_cast<int>(size.features), 0);
    if (bytes > kBatchBytes && size.features > 0) break;
    ++size.features;
  }
  size.is_last = size.features == rows->size();
  return size;
}

}  // namespace

Error no_feature(const std::string& collection, const std::string& id) {
  return {ErrorCode::not_found, "collection '" + collection + "' has no feature '" + id + "'"};
}

Result<std::string> key_of_collection(DatabaseSession& connection, const std::string& id) {
  const Result<Rows> exists = connection.ask(
      "SELECT key::text FROM watertight.collection WHERE name = $1", Parameters().text(id));
  if (!exists) return exists.error();
  if (exists->size() == 0) return no_collection(id);
  return std::string(exists->text(0, 0));
}

std::optional<StoredBox> box_of(const Rows& rows, int row, int first_column) {
  if (rows.is_null(row, first_column)) return std::nullopt;
  StoredBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[static_cast<std::size_t>(axis)] = rows.float8(row, first_column + axis);
    box.max[static_cast<std::size_t>(axis)] = rows.float8(row, first_column + 3 + axis);
  }
  return box;
}

Result<StoredFeature> read_feature(DatabaseSession& connection, const std::string& collection,
                                   const std::string& id, SharedRows& shared) {
  static const std::string statement =
      std::string(kFeatureColumns) +
      " FROM watertight.collection c JOIN watertight.feature_row f ON f.collection = c.key"
      " WHERE c.name = $1 AND hashtextextended(f.id, 0) = hashtextextended($2, 0) AND f.id = $2";
  const Result<Rows> rows = connection.ask(statement, Parameters().text(collection).text(id));
  if (!rows) return rows.error();
  if (rows->size() == 0) return no_feature(collection, id);
  auto features = features_of(connection, *rows, collection, shared);
  if (!features) return std::move(features).error();
  return std::move(features->front());
}

Result<std::vector<StoredFeature>> lock_features(DatabaseSession& connection,
                                                 const std::string& collection,
                                                 std::span<const std::string> ids,
                                                 SharedRows& shared) {
  static const std::string statement =
      std::string(kFeatureColumns) +
      " FROM unnest($2::text[]) AS u (id) JOIN watertight.feature_row f"
      " ON hashtextextended(f.id, 0) = hashtextextended(u.id, 0) AND f.id = u.id"
      " JOIN watertight.collection c ON c.key = f.collection"
      " WHERE c.name = $1 ORDER BY f.id FOR NO KEY UPDATE OF f";
  const std::vector<std::string_view> wanted(ids.begin(), ids.end());
  const Result<Rows> rows =
      connection.ask(statement, Parameters().text(collection).text_array(wanted));
  if (!rows) return rows.error();
  return features_of(connection, *rows, collection, shared);
}

Result<packing::DictionaryPointer> read_dictionary(DatabaseSession& connection,
                                                   const std::string& collection,
                                                   SharedRows& shared) {
  const Result<Rows> rows = connection.ask(
      "SELECT max(key)::int8 FROM watertight.dictionary WHERE collection ="
      " (SELECT key FROM watertight.collection WHERE name = $1)",
      Parameters().text(collection));
  if (!rows) return rows.error();
  const std::int64_t keys[] = {rows->int8(0, 0)};
  const auto found = shared.find(connection, {}, keys);
  if (!found) return found.error();
  const auto newest = found->dictionaries.find(keys[0]);
  // One that was removed since is no matter: nothing is packed with it.
  const packing::DictionaryPointer dictionary =
      newest == found->dictionaries.end() ? nullptr : newest->second;
  shared.set_newest(collection, dictionary);
  if (dictionary) shared.add_key(collection, dictionary, keys[0]);
  return dictionary;
}

Result<std::uint64_t> read_version(DatabaseSession& connection, const std::string& collection,
                                   const std::string& id) {
  const Result<Rows> rows = connection.ask(
      "SELECT version FROM watertight.feature_row WHERE collection ="
      " (SELECT key FROM watertight.collection WHERE name = $1)"
      " AND hashtextextended(id, 0) = hashtextextended($2, 0) AND id = $2",
      Parameters().text(collection).text(id));
  if (!rows) return rows.error();
  if (rows->size() == 0) return no_feature(collection, id);
  return static_cast<std::uint64_t>(rows->int8(0, 0));
}

Result<FeatureBatch> read_batch(DatabaseSession& connection, const std::string& collection,
                                std::uint64_t limit, const std::string& after,
                                const std::optional<Filter>& filter, SharedRows& shared) {
  const Result<WalkPlace> start = walk_place(after);
  if (!start) return start.error();
  const auto at_most = static_cast<std::int64_t>(std::clamp<std::uint64_t>(limit, 1, kLargestPage));
  auto key = key_of_collection(connection, collection);
  if (!key) return std::move(key).error();
  if (filter) {
    const Status able = check_names(connection, collection, names_in(*filter));
    if (!able) return able.error();
  }
  const Result<BatchSize> size = batch_size(connection, collection, *start, at_most, filter);
  if (!size) return size.error();
  FeatureBatch batch;
  batch.key = *std::move(key);
  if (size->features == 0) return batch;
  const Result<Rows> rows =
      walk_rows(connection, kFeatureColumns, collection, *start, size->features, filter);
  if (!rows) return rows.error();
  auto features = features_of(connection, *rows, collection, shared);
  if (!features) return std::move(features).error();
  batch.features = *std::move(features);
  if (!size->is_last) {
    batch.next = to_string({rows->int8(rows->size() - 1, kColumns), batch.features.back().id});
  }
  return batch;
}

Result<std::vector<Twins>> read_twins(DatabaseSession& connection, const std::string& collection,
                                      std::span<const std::string> ids) {
  const auto key = key_of_collection(connection, collection);
  if (!key) return key.error();
  const std::vector<std::string_view> wanted(ids.begin(), ids.end());
  // One other feature is enough, however many there are. OFFSET and LIMIT make the planner look
  // into an index for each id, also before it knows how large the table is.
  const Result<Rows> rows = connection.ask(
      "SELECT f.id, other.id FROM unnest($2::text[]) AS u (id)"
      " CROSS JOIN LATERAL (SELECT * FROM watertight.feature_row f WHERE f.collection = $1::int4"
      " AND hashtextextended(f.id, 0) = hashtextextended(u.id, 0) AND f.id = u.id OFFSET 0) AS f"
      " CROSS JOIN LATERAL (SELECT g.id FROM watertight.feature_row g"
      " WHERE g.collection = f.collection AND g.place = f.place"
      " AND g.id <> f.id AND g.min_x = f.min_x AND g.min_y = f.min_y AND g.min_z = f.min_z"
      " AND g.max_x = f.max_x AND g.max_y = f.max_y AND g.max_z = f.max_z LIMIT 1) AS other"
      " ORDER BY f.id COLLATE \"C\"",
      Parameters().text(*key).text_array(wanted));
  if (!rows) return rows.error();
  std::vector<Twins> found;
  for (int row = 0; row < rows->size(); ++row) {
    found.push_back({std::string(rows->text(row, 0)), std::string(rows->text(row, 1))});
  }
  return found;
}

Result<PlacedPage> read_places(DatabaseSession& connection, const std::string& collection,
                               std::uint64_t limit, const std::string& after, bool only_unproven) {
  const Result<WalkPlace> start = walk_place(after);
  if (!start) return start.error();
  const auto at_most = static_cast<std::int64_t>(std::clamp<std::uint64_t>(limit, 1, kLargestPage));
  const auto key = key_of_collection(connection, collection);
  if (!key) return key.error();
  const Result<Rows> rows = walk_rows(
      connection,
      "SELECT f.min_x, f.min_y, f.min_z, f.max_x, f.max_y, f.max_z, hashtextextended(f.id, 0),"
      " (octet_length(packed_solids) + octet_length(packed_text))::int8, f.id",
      collection, *start, at_most, std::nullopt, only_unproven);
  if (!rows) return rows.error();
  PlacedPage page;
  for (int row = 0; row < rows->size(); ++row) {
    const auto box = box_of(*rows, row, 0);
    if (!box) return page;  // those without a box are last
    page.features.push_back(
        {*box, rows->int8(row, 6), static_cast<std::uint64_t>(rows->int8(row, 7))});
  }
  if (rows->size() == at_most) {
    page.next =
        to_string({rows->int8(rows->size() - 1, 9), std::string(rows->text(rows->size() - 1, 8))});
  }
  return page;
}

Result<std::vector<std::string>> read_ranked(DatabaseSession& connection, const RankQuery& query,
                                             std::uint64_t limit) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  const SizeRank below = query.below.value_or(SizeRank{kLargest, INT64_MAX});
  Parameters parameters;
  parameters.text(query.collection);
  for (const double value : query.min) parameters.float8(value);
  for (const double value : query.max) parameters.float8(value);
  parameters.float8(query.from.size).int8(query.from.number);
  parameters.float8(below.size).int8(below.number);
  parameters.int8(static_cast<std::int64_t>(std::clamp<std::uint64_t>(limit, 1, kLargestPage)));
  // The formula of plane_size(), with the same doubles. PostgreSQL refuses sums that overflow, so
  // coordinates are brought to kFarthest first.
  const std::string_view proof = query.only_unproven ? " AND NOT f.is_proven" : "";
  std::string statement =
      "SELECT id FROM (SELECT id, greatest(high_x - low_x, high_y - low_y) AS size,"
      " hashtextextended(id, 0) AS number, (low_x + high_x) / 2 AS x, (low_y + high_y) / 2 AS y"
      " FROM (SELECT f.id, greatest(least(min_x, 1e18), -1e18) AS low_x,"
      " greatest(least(min_y, 1e18), -1e18) AS low_y,"
      " greatest(least(max_x, 1e18), -1e18) AS high_x,"
      " greatest(least(max_y, 1e18), -1e18) AS high_y FROM watertight.feature_row f"
      " WHERE f.collection = (SELECT key FROM watertight.collection WHERE name = $1)"
      " AND min_x IS NOT NULL AND watertight.index_box(min_x, min_y, max_x, max_y)"
      " && watertight.index_box($2, $3, $4, $5)";
  statement.append(proof).append(
      ") AS boxes) AS ranks"
      " WHERE x >= $2 AND x < $4 AND y >= $3 AND y < $5"
      " AND (size, number) >= ($6, $7) AND (size, number) < ($8, $9)"
      " ORDER BY size DESC, number DESC LIMIT $10");
  const Result<Rows> rows = connection.run(statement, parameters);
  if (!rows) return rows.error();
  if (rows->size() == 0) {
    const auto key = key_of_collection(connection, query.collection);
    if (!key) return key.error();
  }
  std::vector<std::string> ids;
  for (int row = 0; row < rows->size(); ++row) ids.emplace_back(rows->text(row, 0));
  return ids;
}

Result<std::vector<StoredHeader>> read_documents(DatabaseSession& connection,
                                                 const std::string& collection,
                                                 std::uint64_t limit) {
  const Result<Rows> rows = connection.ask(
      "SELECT DISTINCT k.format, d.content, d.digest FROM watertight.collection c"
      " JOIN watertight.kind k ON k.collection = c.key"
      " JOIN watertight.document d ON d.key = k.document"
      " WHERE c.name = $1 AND EXISTS (SELECT FROM watertight.feature_row f WHERE f.kind = k.key)"
      " ORDER BY k.format, d.digest LIMIT $2",
      Parameters().text(collection).int8(static_cast<std::int64_t>(std::min(limit, kLargestPage))));
  if (!rows) return rows.error();
  std::vector<StoredHeader> found;
  for (int row = 0; row < rows->size(); ++row) {
    found.push_back({std::string(rows->text(row, 0)), std::string(rows->text(row, 1))});
  }
  return found;
}

}  // namespace watertight::store
