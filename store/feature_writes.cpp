// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <tuple>

#include "store/feature_rows.h"
#include "store/place.h"

namespace watertight::store {
namespace {

// A B-tree entry of PostgreSQL holds 2704 bytes; two ids and a collection name must fit together.
constexpr std::size_t kLongestId = 1024;
// The bytes of the rows in one statement: so many that round trips do not matter, and few enough
// for the server's memory. A row that is larger is sent all the same.
constexpr std::size_t kStatementBytes = 64ULL << 20;

/// Well-formed UTF-8 (no overlong forms, no surrogates) without NUL, which PostgreSQL's text cannot
/// hold.
bool is_plain_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t offset) -> unsigned {
      return i + offset < text.size() ? static_cast<unsigned char>(text[i + offset]) : 0U;
    };
    const unsigned lead = byte(0);
    std::size_t length = 0;
    unsigned low = 0x80;
    unsigned high = 0xBF;
    if (lead >= 0x01 && lead <= 0x7F) length = 1;
    if (lead >= 0xC2 && lead <= 0xDF) length = 2;
    if (lead >= 0xE0 && lead <= 0xEF) length = 3;
    if (lead >= 0xF0 && lead <= 0xF4) length = 4;
    if (length == 0) return false;
    if (lead == 0xE0) low = 0xA0;
    if (lead == 0xED) high = 0x9F;
    if (lead == 0xF0) low = 0x90;
    if (lead == 0xF4) high = 0x8F;
    for (std::size_t k = 1; k < length; ++k) {
      if (byte(k) < low || byte(k) > high) return false;
      low = 0x80;
      high = 0xBF;
    }
    i += length;
  }
  return true;
}

Error bad(const std::string& what) { return {ErrorCode::invalid_argument, what}; }

Status check_id(std::string_view id, const char* what) {
  if (id.size() > kLongestId) {
    return bad(std::string(what) + " is longer than " + std::to_string(kLongestId) + " bytes");
  }
  if (!is_plain_utf8(id)) return bad(std::string(what) + " is not UTF-8 text without NUL");
  return Done{};
}

Status check_solids(const StoredFeature& feature) {
  std::set<std::tuple<std::string_view, std::uint32_t, std::uint32_t>> keys;
  for (const StoredSolid& solid : feature.solids) {
    if (Status checked = check_id(solid.object_id, "an object id"); !checked) return checked;
    if (!is_plain_utf8(solid.lod)) return bad("a level of detail is not UTF-8 text without NUL");
    if (!is_plain_utf8(solid.measures) || !is_plain_utf8(solid.report)) {
      return bad("measures or report are not UTF-8 text without NUL");
    }
    if (!keys.emplace(solid.object_id, solid.geometry, solid.ordinal).second) {
      return bad("feature '" + feature.id + "' has one solid twice (object '" + solid.object_id +
                 "', geometry " + std::to_string(solid.geometry) + ", solid " +
                 std::to_string(solid.ordinal) + ")");
    }
  }
  return Done{};
}

Status check_feature(const StoredFeature& feature) {
  if (Status checked = check_collection_id(feature.collection); !checked) return checked;
  if (feature.id.empty()) return bad("a feature has no id");
  if (feature.id == "." || feature.id == "..") {
    return bad("a feature cannot have the id '" + feature.id + "', which no URL can name");
  }
  if (Status checked = check_id(feature.id, "a feature id"); !checked) return checked;
  if (!is_plain_utf8(feature.type) || !is_plain_utf8(feature.format)) {
    return bad("the type or format of feature '" + feature.id + "' is not UTF-8 text without NUL");
  }
  if (feature.box) {
    if (Status checked = check_box(*feature.box); !checked) return checked;
  }
  return check_solids(feature);
}

using Order = std::vector<std::size_t>;

/// The indices of the features in order of (collection, id): concurrent writers lock rows in one
/// order and cannot deadlock.
Order sorted_by_key(std::span<const StoredFeature> features) {
  Order order(features.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(features[a].collection, features[a].id) <
           std::tie(features[b].collection, features[b].id);
  });
  return order;
}

/// Stores each distinct header once. Returns the SHA-256 of each header.
Result<std::map<SharedText, Bytes>> write_headers(DatabaseSession& connection,
                                                  std::span<const StoredFeature> features) {
  std::map<SharedText, Bytes> digests;
  for (const StoredFeature& feature : features) digests.try_emplace(feature.header);
  for (auto& [header, digest] : digests) {
    const Result<Rows> rows = connection.run(
        "WITH added AS (INSERT INTO watertight.document_header (digest, content)"
        " VALUES (sha256($1), $1) ON CONFLICT DO NOTHING) SELECT sha256($1)",
        Parameters().bytea(as_bytes(header.str())));
    if (!rows) return rows.error();
    const ByteView found = as_bytes(rows->text(0, 0));
    digest.assign(found.begin(), found.end());
  }
  return digests;
}

/// What the transaction knows about a collection: no other can rename or remove it meanwhile.
struct LockedCollection {
  std::string key;
  std::uint32_t srid = 0;
};
using LockedCollections = std::map<std::string_view, LockedCollection>;

// A key is never used for two collections, also while rows of a removed one are being deleted.
constexpr const char* kAddCollection = R"(
  INSERT INTO watertight.collection (id, name, srid, header)
  SELECT CASE WHEN EXISTS (SELECT FROM watertight.collection WHERE id = $1)
           THEN '#' || nextval('watertight.collection_key') ELSE $1 END, $1, $2, $3
  WHERE NOT EXISTS (SELECT FROM watertight.collection WHERE name = $1)
  ON CONFLICT DO NOTHING)";

constexpr const char* kLockCollection =
    "SELECT id, srid FROM watertight.collection WHERE name = $1 FOR KEY SHARE";

/// Creates the collections that do not exist, and locks all.
Result<LockedCollections> write_collections(DatabaseSession& connection,
                                            std::span<const StoredFeature> features,
                                            const Order& order,
                                            const std::map<SharedText, Bytes>& digests) {
  LockedCollections locked;
  for (const std::size_t i : order) {
    const StoredFeature& feature = features[i];
    if (locked.contains(feature.collection)) continue;
    const Result<Rows> added = connection.run(
        kAddCollection,
        Parameters().text(feature.collection).int8(feature.srid).bytea(digests.at(feature.header)));
    if (!added) return added.error();
    const Result<Rows> rows =
        connection.run(kLockCollection, Parameters().text(feature.collection));
    if (!rows) return rows.error();
    if (rows->size() != 1)
      return connection.collide("a collection was removed or renamed meanwhile");
    locked[feature.collection] = {std::string(rows->text(0, 0)),
                                  static_cast<std::uint32_t>(rows->int8(0, 1))};
  }
  return locked;
}

std::string crs_name(std::uint32_t srid) {
  return srid == 0 ? "no stated CRS" : "EPSG:" + std::to_string(srid);
}

Status check_crs(std::span<const StoredFeature> features, const LockedCollections& collections) {
  for (const StoredFeature& feature : features) {
    const std::uint32_t srid = collections.at(feature.collection).srid;
    if (feature.srid == srid) continue;
    return Error{ErrorCode::conflict, "collection '" + feature.collection + "' has " +
                                          crs_name(srid) + ", feature '" + feature.id + "' has " +
                                          crs_name(feature.srid)};
  }
  return Done{};
}

/// The columns of the table `feature` for one statement.
struct FeatureColumns {
  std::vector<std::string_view> collection, id, type, format;
  std::vector<ByteView> header, skeleton;
  std::vector<std::int64_t> srid, solids, blob_bytes, place;
  std::array<std::vector<std::optional<double>>, 6> box;
  std::size_t bytes = 0;

  void add(const StoredFeature& feature, const std::string& key, const Bytes& digest) {
    collection.push_back(key);
    id.push_back(feature.id);
    type.push_back(feature.type);
    format.push_back(feature.format);
    header.push_back(digest);
    skeleton.push_back(feature.skeleton.bytes);
    srid.push_back(feature.srid);
    solids.push_back(static_cast<std::int64_t>(feature.solids.size()));
    std::size_t blobs = 0;
    for (const StoredSolid& solid : feature.solids) blobs += solid.blob.size();
    blob_bytes.push_back(static_cast<std::int64_t>(blobs));
    place.push_back(place_number(feature.box));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box[axis].push_back(feature.box ? std::optional(feature.box->min[axis]) : std::nullopt);
      box[axis + 3].push_back(feature.box ? std::optional(feature.box->max[axis]) : std::nullopt);
    }
    bytes += feature.id.size() + feature.skeleton.bytes.size() + 256;
  }
  Parameters parameters(bool may_replace) const {
    Parameters p;
    p.text_array(collection).text_array(id).text_array(type).text_array(format);
    p.int8_array(srid).bytea_array(header).bytea_array(skeleton);
    p.int8_array(solids).int8_array(blob_bytes);
    for (const auto& side : box) p.float8_array(side);
    p.int8_array(place).int8(may_replace ? 1 : 0);
    return p;
  }
};

// PostgreSQL draws the new version after it locked the row, so the version is above every earlier
// version of the row.
constexpr const char* kPutFeatures = R"(
  INSERT INTO watertight.feature AS f (collection, id, type, format, srid, header, skeleton,
    solids, blob_bytes, min_x, min_y, min_z, max_x, max_y, max_z, place)
  SELECT * FROM unnest($1::text[], $2::text[], $3::text[], $4::text[], $5::int8[], $6::bytea[],
    $7::bytea[], $8::int8[], $9::int8[], $10::float8[], $11::float8[], $12::float8[],
    $13::float8[], $14::float8[], $15::float8[], $16::int8[])
  ON CONFLICT (collection, id) DO UPDATE SET
    version = nextval('watertight.feature_version'), type = excluded.type,
    format = excluded.format, srid = excluded.srid, header = excluded.header,
    skeleton = excluded.skeleton, solids = excluded.solids, blob_bytes = excluded.blob_bytes,
    min_x = excluded.min_x, min_y = excluded.min_y, min_z = excluded.min_z,
    max_x = excluded.max_x, max_y = excluded.max_y, max_z = excluded.max_z, place = excluded.place
    WHERE $17 = 1
  RETURNING f.version, f.id)";

constexpr const char* kDropSolids = R"(
  DELETE FROM watertight.solid s
  USING unnest($1::text[], $2::text[]) AS k (collection, feature)
  WHERE s.collection = k.collection AND s.feature = k.feature)";

/// The features with the indices `places`, and all that their rows need.
struct FeatureSlice {
  std::span<const StoredFeature> features;
  std::span<const std::size_t> places;
  const LockedCollections& collections;
  const std::map<SharedText, Bytes>& digests;
};

/// The failure of a write that found versions other than those it was to replace.
Error failed_precondition(const std::string& id, std::uint64_t version) {
  std::string text = "feature '" + id + "' ";
  text += version == 0 ? "does not exist" : "has version " + std::to_string(version);
  return {ErrorCode::precondition_failed, std::move(text)};
}

bool holds(const WriteCondition& condition, std::uint64_t version) {
  switch (condition.kind) {
    case WriteCondition::Kind::none:
      return true;
    case WriteCondition::Kind::absent:
      return version == 0;
    case WriteCondition::Kind::present:
      return version != 0;
    case WriteCondition::Kind::versions:
      return version != 0 && std::find(condition.versions.begin(), condition.versions.end(),
                                       version) != condition.versions.end();
  }
  return false;
}

constexpr const char* kLockFeature =
    "SELECT version FROM watertight.feature WHERE collection = $1 AND id = $2 FOR UPDATE";

/// Locks a feature and checks its version.
Status check_condition(DatabaseSession& connection, const std::string& key, const std::string& id,
                       const WriteCondition& condition) {
  const Result<Rows> rows = connection.run(kLockFeature, Parameters().text(key).text(id));
  if (!rows) return rows.error();
  const std::uint64_t version =
      rows->size() == 0 ? 0 : static_cast<std::uint64_t>(rows->int8(0, 0));
  if (!holds(condition, version)) return failed_precondition(id, version);
  return Done{};
}

/// The failure of a write of new features whose rows were not all added: another writer was first.
Error exists_already(DatabaseSession& connection, const FeatureSlice& slice,
                     const WriteCondition& condition) {
  for (const std::size_t i : slice.places) {
    const StoredFeature& feature = slice.features[i];
    const std::string& key = slice.collections.at(feature.collection).key;
    Status checked = check_condition(connection, key, feature.id, condition);
    if (!checked) return std::move(checked).error();
  }
  return {ErrorCode::unavailable, "the database answered with other rows than were sent"};
}

/// Writes a slice, puts the version of each feature at its index of `versions`, and deletes the
/// solids that the features had.
Status write_feature_rows(DatabaseSession& connection, const FeatureSlice& slice,
                          const WriteCondition& condition, std::span<std::uint64_t> versions) {
  FeatureColumns columns;
  for (const std::size_t i : slice.places) {
    const StoredFeature& feature = slice.features[i];
    columns.add(feature, slice.collections.at(feature.collection).key,
                slice.digests.at(feature.header));
  }
  const bool may_replace = condition.kind != WriteCondition::Kind::absent;
  const Result<Rows> rows = connection.run(kPutFeatures, columns.parameters(may_replace));
  if (!rows) return rows.error();
  if (static_cast<std::size_t>(rows->size()) != slice.places.size()) {
    return exists_already(connection, slice, condition);
  }
  for (int row = 0; row < rows->size(); ++row) {
    const std::size_t place = slice.places[static_cast<std::size_t>(row)];
    if (rows->text(row, 1) != slice.features[place].id) {
      return Error{ErrorCode::unavailable, "the database answered with other rows than were sent"};
    }
    versions[place] = static_cast<std::uint64_t>(rows->int8(row, 0));
  }
  const Result<Rows> dropped = connection.run(
      kDropSolids, Parameters().text_array(columns.collection).text_array(columns.id));
  if (!dropped) return dropped.error();
  return Done{};
}

/// The columns of the table `solid` for one statement.
struct SolidColumns {
  std::vector<std::string_view> collection, feature, object, lod, measures, report;
  std::vector<std::int64_t> geometry, ordinal, position;
  std::vector<ByteView> blob;
  std::size_t bytes = 0;

  void add(const StoredFeature& owner, const std::string& key, std::size_t place) {
    const StoredSolid& solid = owner.solids[place];
    collection.push_back(key);
    feature.push_back(owner.id);
    object.push_back(solid.object_id);
    geometry.push_back(solid.geometry);
    ordinal.push_back(solid.ordinal);
    position.push_back(static_cast<std::int64_t>(place));
    lod.push_back(solid.lod);
    blob.push_back(solid.blob);
    measures.push_back(solid.measures);
    report.push_back(solid.report);
    bytes += solid.blob.size() + solid.measures.size() + solid.report.size() + 256;
  }
  Parameters parameters() const {
    Parameters p;
    p.text_array(collection).text_array(feature).text_array(object).int8_array(geometry);
    p.int8_array(ordinal).int8_array(position).text_array(lod).bytea_array(blob);
    p.text_array(measures).text_array(report);
    return p;
  }
};

constexpr const char* kPutSolids = R"(
  INSERT INTO watertight.solid (collection, feature, object_id, geometry, ordinal, position, lod,
    blob, measures, report)
  SELECT c, f, o, g, n, p, l, b, nullif(m, '')::jsonb, nullif(r, '')::jsonb
  FROM unnest($1::text[], $2::text[], $3::text[], $4::int8[], $5::int8[], $6::int8[], $7::text[],
    $8::bytea[], $9::text[], $10::text[]) AS u (c, f, o, g, n, p, l, b, m, r))";

Status flush_solids(DatabaseSession& connection, SolidColumns& columns) {
  if (columns.blob.empty()) return Done{};
  const Result<Rows> done = connection.run(kPutSolids, columns.parameters());
  columns = {};
  if (!done) return done.error();
  return Done{};
}

Status write_solids(DatabaseSession& connection, std::span<const StoredFeature> features,
                    const Order& order, const LockedCollections& collections) {
  SolidColumns columns;
  for (const std::size_t i : order) {
    const std::string& key = collections.at(features[i].collection).key;
    for (std::size_t place = 0; place < features[i].solids.size(); ++place) {
      columns.add(features[i], key, place);
      if (columns.bytes < kStatementBytes) continue;
      if (Status done = flush_solids(connection, columns); !done) return done;
    }
  }
  return flush_solids(connection, columns);
}

}  // namespace

Status check_collection_id(const std::string& id) {
  const auto allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
  };
  if (id.empty() || id.size() > 64 || !std::all_of(id.begin(), id.end(), allowed)) {
    return bad("a collection id is 1 to 64 of the characters A-Z a-z 0-9 _ . -");
  }
  return Done{};
}

bool is_possible_id(const std::string& id) { return !id.empty() && check_id(id, "").has_value(); }

Status check_box(const StoredBox& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool ordered = box.min[axis] <= box.max[axis];  // false for NaN
    if (!ordered || !std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) {
      return bad("a box needs finite numbers with minimum <= maximum");
    }
  }
  return Done{};
}

Status check_features(std::span<const StoredFeature> features) {
  std::set<std::pair<std::string_view, std::string_view>> keys;
  for (const StoredFeature& feature : features) {
    if (Status checked = check_feature(feature); !checked) return checked;
    if (!keys.emplace(feature.collection, feature.id).second) {
      return Error{ErrorCode::conflict, "feature '" + feature.id + "' is there twice"};
    }
  }
  return Done{};
}

Result<std::vector<std::uint64_t>> write_features(DatabaseSession& connection,
                                                  std::span<const StoredFeature> features,
                                                  const WriteCondition& condition) {
  const Order order = sorted_by_key(features);
  const auto digests = write_headers(connection, features);
  if (!digests) return digests.error();
  const auto collections = write_collections(connection, features, order, *digests);
  if (!collections) return collections.error();
  if (Status same = check_crs(features, *collections); !same) return std::move(same).error();
  if (condition.kind != WriteCondition::Kind::none) {
    for (const std::size_t i : order) {
      const std::string& key = collections->at(features[i].collection).key;
      Status checked = check_condition(connection, key, features[i].id, condition);
      if (!checked) return std::move(checked).error();
    }
  }
  std::vector<std::uint64_t> versions(features.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    for (std::size_t bytes = 0; end < order.size() && bytes < kStatementBytes; ++end) {
      bytes += features[order[end]].skeleton.bytes.size() + 512;
    }
    const FeatureSlice slice{features, std::span(order).subspan(begin, end - begin), *collections,
                             *digests};
    if (Status done = write_feature_rows(connection, slice, condition, versions); !done) {
      return std::move(done).error();
    }
    begin = end;
  }
  if (Status done = write_solids(connection, features, order, *collections); !done) {
    return std::move(done).error();
  }
  return versions;
}

Result<Done> delete_feature(DatabaseSession& connection, const std::string& collection,
                            const std::string& id, const WriteCondition& condition) {
  const Result<Rows> locked = connection.run(kLockCollection, Parameters().text(collection));
  if (!locked) return locked.error();
  if (locked->size() == 0) return no_feature(collection, id);
  const std::string key(locked->text(0, 0));
  const Result<Rows> rows = connection.run(kLockFeature, Parameters().text(key).text(id));
  if (!rows) return rows.error();
  if (rows->size() == 0) return no_feature(collection, id);
  const auto version = static_cast<std::uint64_t>(rows->int8(0, 0));
  if (!holds(condition, version)) return failed_precondition(id, version);
  const Result<Rows> gone =
      connection.run("DELETE FROM watertight.feature WHERE collection = $1 AND id = $2",
                     Parameters().text(key).text(id));
  if (!gone) return gone.error();
  return Done{};
}

}  // namespace watertight::store
