// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "store/rows/feature_rows.h"

namespace watertight::store {
namespace {

constexpr std::int64_t kBatchBytes = 16 << 20;  // the most bytes of blobs and skeletons in a batch

/// The FROM and WHERE clauses of a query: $1 is the collection and, if there is a box, $2 ... $7
/// are its smallest and largest coordinates. The index of boxes finds candidates in x and y;
/// PostgreSQL's box operator is generous by 1e-6, so none is missed. The comparison of the six
/// numbers decides. For a small box the appended '' keeps PostgreSQL from narrowing the candidates
/// down by an index that holds all features of the collection; for a larger one PostgreSQL chooses
/// between place and id; for a box around everything a search by place would save nothing.
std::string matching(const FeatureQuery& query) {
  constexpr const char* kFeatures = " FROM watertight.feature WHERE ";
  constexpr const char* kOfCollection = "= (SELECT id FROM watertight.collection WHERE name = $1)";
  constexpr const char* kCandidates =
      " AND watertight.index_box(min_x, min_y, max_x, max_y)"
      " && watertight.index_box($2, $3, $5, $6)";
  constexpr const char* kInBox =
      " AND min_x IS NOT NULL AND min_x <= $5 AND min_y <= $6 AND min_z <= $7"
      " AND max_x >= $2 AND max_y >= $3 AND max_z >= $4";
  constexpr double kSmall = 1.0 / 16;
  const bool is_small = query.box && query.share < kSmall;
  std::string clauses = kFeatures;
  clauses.append(is_small ? "collection || '' " : "collection ").append(kOfCollection);
  if (query.box && query.share < 1) clauses.append(kCandidates);
  if (query.box) clauses.append(kInBox);
  if (query.is_proven) clauses.append(*query.is_proven ? " AND is_proven" : " AND NOT is_proven");
  return clauses;
}

constexpr const char* kSolidColumns =
    "s.object_id, s.geometry, s.ordinal, s.lod, s.blob, s.measures::text, s.report::text";

const char* const kFeatureColumns =
    "SELECT id, version, type, format, srid, header, skeleton,"
    " min_x, min_y, min_z, max_x, max_y, max_z, findings::text";

/// The feature in a row, whose columns are kFeatureColumns, without solids. Its header is what is
/// in the header's column.
StoredFeature feature_of(const Rows& rows, int row, const std::string& collection) {
  StoredFeature feature;
  feature.collection = collection;
  feature.id = rows.text(row, 0);
  feature.version = static_cast<std::uint64_t>(rows.int8(row, 1));
  feature.type = rows.text(row, 2);
  feature.format = rows.text(row, 3);
  feature.srid = static_cast<std::uint32_t>(rows.int8(row, 4));
  feature.header = std::string(rows.text(row, 5));
  const ByteView skeleton = as_bytes(rows.text(row, 6));
  feature.skeleton.bytes.assign(skeleton.begin(), skeleton.end());
  feature.box = box_of(rows, row, 7);
  feature.findings = rows.text(row, 13);
  return feature;
}

/// Replaces the digest in the header of each feature by the text of the header. The query asks for
/// each digest once, and the features with equal headers share one copy of the text. No header is
/// missing: all queries of a read see one state of the database, in which features refer to headers
/// that exist.
void set_headers(const Rows& rows, std::vector<StoredFeature>& features) {
  std::map<std::string, SharedText> contents;
  for (int row = 0; row < rows.size(); ++row) {
    contents[std::string(rows.text(row, 0))] = std::string(rows.text(row, 1));
  }
  for (StoredFeature& feature : features) feature.header = contents[feature.header.str()];
}

/// The solid in a row, whose columns from `column` on are kSolidColumns.
StoredSolid solid_of(const Rows& rows, int row, int column) {
  StoredSolid solid;
  solid.object_id = rows.text(row, column);
  solid.geometry = static_cast<std::uint32_t>(rows.int8(row, column + 1));
  solid.ordinal = static_cast<std::uint32_t>(rows.int8(row, column + 2));
  solid.lod = rows.text(row, column + 3);
  solid.is_proven = !rows.is_null(row, column + 4);
  const ByteView blob = as_bytes(rows.text(row, column + 4));
  solid.blob.assign(blob.begin(), blob.end());
  solid.measures = rows.text(row, column + 5);
  solid.report = rows.text(row, column + 6);
  return solid;
}

void add_solids(const Rows& rows, std::vector<StoredFeature>& features) {
  std::map<std::string_view, StoredFeature*> by_id;
  for (StoredFeature& feature : features) by_id[feature.id] = &feature;
  for (int row = 0; row < rows.size(); ++row) {
    const auto owner = by_id.find(rows.text(row, 0));
    if (owner != by_id.end()) owner->second->solids.push_back(solid_of(rows, row, 1));
  }
}

/// Completes features that feature_of() has made with the digests of their headers.
Status fill(DatabaseSession& connection, const std::string& collection,
            std::vector<StoredFeature>& features) {
  std::set<std::string_view> distinct;
  std::vector<std::string_view> ids;
  for (const StoredFeature& feature : features) {
    distinct.insert(feature.header.str());
    ids.push_back(feature.id);
  }
  std::vector<ByteView> digests;
  for (const std::string_view digest : distinct) digests.push_back(as_bytes(digest));
  const std::size_t headers = connection.send(
      "SELECT digest, content FROM watertight.document_header WHERE digest = ANY($1)",
      Parameters().bytea_array(digests));
  const std::size_t solids = connection.send(
      std::string("SELECT feature, ") + kSolidColumns +
          " FROM watertight.solid s WHERE collection ="
          " (SELECT id FROM watertight.collection WHERE name = $1) AND feature = ANY($2)"
          " ORDER BY feature, position",
      Parameters().text(collection).text_array(ids));
  const Result<std::vector<Rows>> results = connection.results();
  if (!results) return results.error();
  set_headers((*results)[headers], features);
  add_solids((*results)[solids], features);
  return Done{};
}

/// The parameters of matching(): $1 is the collection and, if there is a box, $2 ... $7 are its
/// smallest and largest coordinates.
Parameters filter_parameters(const FeatureQuery& query) {
  Parameters parameters;
  parameters.text(query.collection);
  if (query.box) {
    for (const double value : query.box->min) parameters.float8(value);
    for (const double value : query.box->max) parameters.float8(value);
  }
  return parameters;
}

Result<Rows> summary_rows(DatabaseSession& connection, const FeatureQuery& query,
                          std::int64_t limit) {
  Parameters parameters = filter_parameters(query);
  parameters.text(query.after).int8(limit);
  const char* const rest =
      query.box ? " AND id > $8 ORDER BY id LIMIT $9" : " AND id > $2 ORDER BY id LIMIT $3";
  return connection.ask(
      "SELECT id, type, version, solids, blob_bytes, min_x, min_y, min_z, max_x, max_y, max_z,"
      " unproven, is_proven::int::int8" +
          matching(query) + rest,
      parameters);
}

FeatureSummary summary_of(const Rows& rows, int row) {
  FeatureSummary summary;
  summary.id = rows.text(row, 0);
  summary.type = rows.text(row, 1);
  summary.version = static_cast<std::uint64_t>(rows.int8(row, 2));
  summary.solids = static_cast<std::uint64_t>(rows.int8(row, 3));
  summary.blob_bytes = static_cast<std::uint64_t>(rows.int8(row, 4));
  summary.box = box_of(rows, row, 5);
  summary.unproven = static_cast<std::uint64_t>(rows.int8(row, 11));
  summary.is_proven = rows.int8(row, 12) != 0;
  return summary;
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
Result<Rows> walk_rows(DatabaseSession& connection, const std::string& columns,
                       const std::string& collection, const WalkPlace& after, std::int64_t limit) {
  return connection.ask(columns +
                            ", place FROM watertight.feature WHERE collection ="
                            "(SELECT id FROM watertight.collection WHERE name = $1)"
                            " AND (place, id) > ($2, $3) ORDER BY place, id LIMIT $4",
                        Parameters().text(collection).int8(after.place).text(after.id).int8(limit));
}

/// How many of the next features make a batch, and whether it is the last batch.
struct BatchSize {
  std::int64_t features = 0;
  bool is_last = true;
};

Result<BatchSize> batch_size(DatabaseSession& connection, const std::string& collection,
                             const WalkPlace& after, std::int64_t limit) {
  const Result<Rows> rows =
      walk_rows(connection, "SELECT (blob_bytes + octet_length(skeleton))::int8", collection, after,
                limit + 1);
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

/// The key of a collection. Errors: not_found.
Result<std::string> key_of_collection(DatabaseSession& connection, const std::string& id) {
  const Result<Rows> exists = connection.ask(
      "SELECT id::text FROM watertight.collection WHERE name = $1", Parameters().text(id));
  if (!exists) return exists.error();
  if (exists->size() == 0) return no_collection(id);
  return std::string(exists->text(0, 0));
}

}  // namespace

Error no_feature(const std::string& collection, const std::string& id) {
  return {ErrorCode::not_found, "collection '" + collection + "' has no feature '" + id + "'"};
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
                                   const std::string& id) {
  // A row for each solid, the first of which has what is large in the feature.
  static const std::string statement =
      std::string(
          "SELECT f.id, f.version, f.type, f.format, f.srid,"
          " CASE WHEN coalesce(s.position, 0) = 0 THEN h.content END,"
          " CASE WHEN coalesce(s.position, 0) = 0 THEN f.skeleton END,"
          " f.min_x, f.min_y, f.min_z, f.max_x, f.max_y, f.max_z, f.findings::text, s.position, ") +
      kSolidColumns +
      " FROM watertight.feature f JOIN watertight.document_header h ON h.digest = f.header"
      " LEFT JOIN watertight.solid s ON s.collection = f.collection AND s.feature = f.id"
      " WHERE f.collection = (SELECT id FROM watertight.collection WHERE name = $1)"
      " AND f.id = $2 ORDER BY s.position";
  const Result<Rows> rows = connection.ask(statement, Parameters().text(collection).text(id));
  if (!rows) return rows.error();
  if (rows->size() == 0) return no_feature(collection, id);
  StoredFeature feature = feature_of(*rows, 0, collection);
  for (int row = 0; row < rows->size(); ++row) {
    if (!rows->is_null(row, 14)) feature.solids.push_back(solid_of(*rows, row, 15));
  }
  return feature;
}

Result<std::uint64_t> read_version(DatabaseSession& connection, const std::string& collection,
                                   const std::string& id) {
  const Result<Rows> rows = connection.ask(
      "SELECT version FROM watertight.feature WHERE collection ="
      " (SELECT id FROM watertight.collection WHERE name = $1) AND id = $2",
      Parameters().text(collection).text(id));
  if (!rows) return rows.error();
  if (rows->size() == 0) return no_feature(collection, id);
  return static_cast<std::uint64_t>(rows->int8(0, 0));
}

Result<FeaturePage> read_page(DatabaseSession& connection, const FeatureQuery& query) {
  const std::uint64_t limit = std::min(query.limit, kLargestPage);
  FeaturePage page;
  // One feature more than asked for shows whether there is a next page.
  const Result<Rows> rows = summary_rows(connection, query, static_cast<std::int64_t>(limit) + 1);
  if (!rows) return rows.error();
  for (int row = 0; row < rows->size(); ++row) page.features.push_back(summary_of(*rows, row));
  if (page.features.empty()) {
    const auto exists = key_of_collection(connection, query.collection);
    if (!exists) return exists.error();
  }
  const bool has_more = page.features.size() > limit;
  if (has_more) page.features.resize(limit);
  if (has_more && limit > 0) page.next = page.features.back().id;
  return page;
}

Result<FeatureBatch> read_batch(DatabaseSession& connection, const std::string& collection,
                                std::uint64_t limit, const std::string& after) {
  const Result<WalkPlace> start = walk_place(after);
  if (!start) return start.error();
  const auto at_most = static_cast<std::int64_t>(std::clamp<std::uint64_t>(limit, 1, kLargestPage));
  auto key = key_of_collection(connection, collection);
  if (!key) return std::move(key).error();
  const Result<BatchSize> size = batch_size(connection, collection, *start, at_most);
  if (!size) return size.error();
  FeatureBatch batch;
  batch.key = *std::move(key);
  if (size->features == 0) return batch;
  const Result<Rows> rows =
      walk_rows(connection, kFeatureColumns, collection, *start, size->features);
  if (!rows) return rows.error();
  for (int row = 0; row < rows->size(); ++row) {
    batch.features.push_back(feature_of(*rows, row, collection));
  }
  if (!size->is_last) {
    batch.next = to_string({rows->int8(rows->size() - 1, 14), batch.features.back().id});
  }
  if (Status done = fill(connection, collection, batch.features); !done) {
    return std::move(done).error();
  }
  return batch;
}

Result<std::vector<StoredHeader>> read_documents(DatabaseSession& connection,
                                                 const std::string& collection,
                                                 std::uint64_t limit) {
  const Result<Rows> rows = connection.ask(
      "WITH RECURSIVE document AS ((SELECT format, header FROM watertight.feature"
      " WHERE collection ="
      "(SELECT id FROM watertight.collection WHERE name = $1) ORDER BY format, header LIMIT 1)"
      " UNION ALL SELECT next.* FROM document d, LATERAL (SELECT format, header"
      " FROM watertight.feature WHERE collection ="
      "(SELECT id FROM watertight.collection WHERE name = $1) AND (format, header) > (d.format, "
      "d.header)"
      " ORDER BY format, header LIMIT 1) next)"
      " SELECT d.format, h.content FROM (SELECT * FROM document LIMIT $2) d"
      " JOIN watertight.document_header h ON h.digest = d.header ORDER BY d.format, d.header",
      Parameters().text(collection).int8(static_cast<std::int64_t>(std::min(limit, kLargestPage))));
  if (!rows) return rows.error();
  std::vector<StoredHeader> found;
  for (int row = 0; row < rows->size(); ++row) {
    found.push_back({std::string(rows->text(row, 0)), std::string(rows->text(row, 1))});
  }
  return found;
}

}  // namespace watertight::store
