// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rows of puts and removes. Statements are sent together as far as none needs the result of
// another.
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <string_view>
#include <tuple>

#include "store/attributes/attribute_rows.h"
#include "store/rows/feature_rows.h"
#include "store/rows/packed_solids.h"
#include "store/rows/place.h"
#include "store/rows/sent_rows.h"

namespace watertight::store {
namespace {

// The bytes of the rows in one statement: few enough for the server's memory. A row that is larger
// is sent all the same.
constexpr std::size_t kStatementBytes = 64ULL << 20;

/// The features in order of (collection, id): concurrent writers lock rows in one order and cannot
/// deadlock.
std::vector<std::size_t> sorted_by_key(FeatureRefs features) {
  std::vector<std::size_t> order(features.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(features[a]->collection, features[a]->id) <
           std::tie(features[b]->collection, features[b]->id);
  });
  return order;
}

/// The features of one collection in a write.
struct Part {
  std::string_view collection;
  std::vector<std::size_t> places;  // their indices, in order of id
  std::size_t lock = 0;             // the index of the result that has the collection's CRS
  std::size_t rows = 0;             // the index of the first result that has new versions
  std::size_t end = 0;              // the index behind the last
};

std::vector<Part> parts_of(FeatureRefs features) {
  std::vector<Part> parts;
  for (const std::size_t i : sorted_by_key(features)) {
    const std::string& collection = features[i]->collection;
    if (parts.empty() || parts.back().collection != collection) parts.push_back({collection, {}});
    parts.back().places.push_back(i);
  }
  return parts;
}

// While this lock is held, no other transaction can rename or remove the collection.
constexpr const char* kLockCollection =
    "SELECT srid FROM watertight.collection WHERE name = $1 FOR KEY SHARE";

// The same, with whether attributes are chosen.
constexpr const char* kLockWithChoice =
    "SELECT srid, EXISTS (SELECT FROM watertight.attribute_name n WHERE n.collection = c.key"
    " AND n.name IS NOT NULL)::int::int8 FROM watertight.collection c WHERE name = $1"
    " FOR KEY SHARE OF c";

/// Creates the collections that do not exist.
void send_collections(DatabaseSession& connection, FeatureRefs features,
                      const std::vector<Part>& parts, const Digests& digests) {
  for (const Part& part : parts) {
    const StoredFeature& first = *features[part.places.front()];
    send_gate(connection, part.collection, Gate::shared);
    send_collection(connection, first, digests);
  }
}

std::string crs_name(std::uint32_t srid) {
  return srid == 0 ? "no stated CRS" : "EPSG:" + std::to_string(srid);
}

/// Ok when each collection is there and has the CRS of its features.
Status check_collections(DatabaseSession& connection, FeatureRefs features,
                         const std::vector<Part>& parts, const std::vector<Rows>& results) {
  for (const Part& part : parts) {
    const Rows& locked = results[part.lock];
    if (locked.size() != 1) {
      return connection.collide("a collection was removed or renamed meanwhile");
    }
    const auto srid = static_cast<std::uint32_t>(locked.int8(0, 0));
    for (const std::size_t i : part.places) {
      if (features[i]->srid == srid) continue;
      return Error{ErrorCode::conflict, "collection '" + features[i]->collection + "' has " +
                                            crs_name(srid) + ", feature '" + features[i]->id +
                                            "' has " + crs_name(features[i]->srid)};
    }
  }
  return Done{};
}

/// The failure of a write that found another version (0: none) than those it was to replace.
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

constexpr const char* kLockFeatures = R"(
  SELECT f.id, f.version FROM unnest($2::text[]) AS w (id) JOIN watertight.feature_row f
    ON hashtextextended(f.id, 0) = hashtextextended(w.id, 0) AND f.id = w.id
  WHERE f.collection = (SELECT key FROM watertight.collection WHERE name = $1)
  ORDER BY f.id FOR UPDATE OF f)";

/// Locks the features that exist, waits, and checks the version of each. After that no other
/// transaction can change a feature that exists, but one can still add a feature that does not.
Status check_condition(DatabaseSession& connection, FeatureRefs features,
                       const std::vector<Part>& parts, const WriteCondition& condition) {
  std::vector<std::size_t> locks;
  for (const Part& part : parts) {
    std::vector<std::string_view> ids;
    for (const std::size_t i : part.places) ids.push_back(features[i]->id);
    locks.push_back(
        connection.send(kLockFeatures, Parameters().text(part.collection).text_array(ids)));
  }
  const Result<std::vector<Rows>> results = connection.results();
  if (!results) return results.error();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Rows& rows = (*results)[locks[p]];
    int row = 0;
    for (const std::size_t i : parts[p].places) {
      const std::string& id = features[i]->id;
      const bool exists = row < rows.size() && rows.text(row, 0) == id;
      const std::uint64_t version = exists ? static_cast<std::uint64_t>(rows.int8(row++, 1)) : 0;
      if (!holds(condition, version)) return failed_precondition(id, version);
    }
  }
  return Done{};
}

std::int64_t blob_bytes_of(const StoredFeature& feature) {
  std::size_t bytes = feature.page.size();
  for (const StoredSolid& solid : feature.solids) bytes += solid.blob.size();
  return static_cast<std::int64_t>(bytes);
}

/// The columns of the table `feature_row` for one statement.
struct FeatureColumns {
  std::vector<std::string_view> id, type, format;
  std::vector<ByteView> header, text;
  std::vector<Bytes> packed_solids;
  std::vector<std::int64_t> dictionary, solids, blob_bytes, place, unproven, is_proven, version;
  std::array<std::vector<std::optional<double>>, 6> box;
  std::size_t bytes = 0;

  void add(const StoredFeature& feature, const Bytes& digest, std::int64_t dictionary_key,
           Versions versions) {
    version.push_back(versions == Versions::kept ? static_cast<std::int64_t>(feature.version) : 0);
    id.push_back(feature.id);
    type.push_back(feature.type);
    format.push_back(feature.format);
    header.push_back(digest);
    text.push_back(feature.skeleton.bytes);
    dictionary.push_back(dictionary_key);
    packed_solids.push_back(pack_solids(feature));
    solids.push_back(static_cast<std::int64_t>(feature.solids.size()));
    blob_bytes.push_back(blob_bytes_of(feature));
    place.push_back(place_number(feature.box));
    unproven.push_back(static_cast<std::int64_t>(feature.unproven()));
    is_proven.push_back(feature.is_proven() ? 1 : 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box[axis].push_back(feature.box ? std::optional(feature.box->min[axis]) : std::nullopt);
      box[axis + 3].push_back(feature.box ? std::optional(feature.box->max[axis]) : std::nullopt);
    }
    bytes += feature.id.size() + feature.skeleton.bytes.size() + packed_solids.back().size() + 512;
  }
  Parameters parameters(std::string_view collection, const WriteCondition& condition) const {
    const std::vector<ByteView> solid_bytes(packed_solids.begin(), packed_solids.end());
    Parameters p;
    p.text(collection).text_array(id).text_array(type).text_array(format);
    p.bytea_array(header).int8_array(dictionary).bytea_array(solid_bytes).bytea_array(text);
    p.int8_array(solids).int8_array(blob_bytes);
    for (const auto& side : box) p.float8_array(side);
    p.int8_array(place).int8_array(unproven).int8_array(is_proven);
    p.int8(condition.kind == WriteCondition::Kind::absent ? 0 : 1).int8_array(version);
    return p;
  }
};

// PostgreSQL draws the new version after it locked the row, so the version is above every earlier
// version of the row. Where $20 is 0, a feature that exists is left as it is and not returned; nor
// is one whose hash another id has.
constexpr const char* kPutFeatures = R"(
  INSERT INTO watertight.feature_row AS f (version, collection, id, kind, dictionary, packed_solids,
    packed_text, solids, blob_bytes, min_x, min_y, min_z, max_x, max_y, max_z, place,
    unproven, is_proven)
  SELECT CASE WHEN r = 0 THEN nextval('watertight.feature_version') ELSE r END, c.key, i, k.key,
    CASE WHEN d = 0 THEN 0
         ELSE (SELECT key FROM watertight.dictionary WHERE key = d AND collection = c.key) END,
    s, x, n, b, x0, y0, z0, x1, y1, z1, p, w, v = 1
  FROM unnest($2::text[], $3::text[], $4::text[], $5::bytea[], $6::int8[], $7::bytea[],
    $8::bytea[], $9::int8[], $10::int8[], $11::float8[], $12::float8[], $13::float8[],
    $14::float8[], $15::float8[], $16::float8[], $17::int8[], $18::int8[], $19::int8[],
    $21::int8[]) WITH ORDINALITY AS u (i, t, m, h, d, s, x, n, b, x0, y0, z0, x1, y1, z1, p, w, v, r, number)
  LEFT JOIN watertight.collection c ON c.name = $1
  LEFT JOIN watertight.document o ON o.digest = h
  LEFT JOIN watertight.kind k
    ON k.collection = c.key AND k.document = o.key AND k.format = m AND k.type = t
  ORDER BY number
  ON CONFLICT (collection, hashtextextended(id, 0)) DO UPDATE SET
    version = nextval('watertight.feature_version'), kind = excluded.kind,
    dictionary = excluded.dictionary, packed_solids = excluded.packed_solids,
    packed_text = excluded.packed_text, solids = excluded.solids,
    blob_bytes = excluded.blob_bytes,
    min_x = excluded.min_x, min_y = excluded.min_y, min_z = excluded.min_z,
    max_x = excluded.max_x, max_y = excluded.max_y, max_z = excluded.max_z, place = excluded.place,
    unproven = excluded.unproven, is_proven = excluded.is_proven
    WHERE $20 = 1 AND f.id = excluded.id
  RETURNING f.version, f.id)";

/// Sends the features of a part.
void send_features(DatabaseSession& connection, FeatureRefs features, Part& part,
                   const Digests& digests, const WriteCondition& condition,
                   const DictionaryKeys& dictionaries, Versions versions) {
  FeatureColumns columns;
  for (const std::size_t i : part.places) {
    columns.add(*features[i], digests.at(features[i]->header), dictionaries.of(*features[i]),
                versions);
    const bool is_last = i == part.places.back();
    if (columns.bytes < kStatementBytes && !is_last) continue;
    const std::size_t sent =
        connection.send(kPutFeatures, columns.parameters(part.collection, condition));
    if (part.end == 0) part.rows = sent;
    part.end = sent + 1;
    columns = {};
  }
}

/// Puts the new version of each feature of a part at its index of `versions`. False when the rows
/// are not those of the features that were sent.
bool read_versions(FeatureRefs features, const Part& part, const std::vector<Rows>& results,
                   std::vector<std::uint64_t>& versions) {
  auto place = part.places.begin();
  for (std::size_t i = part.rows; i < part.end; ++i) {
    const Rows& rows = results[i];
    for (int row = 0; row < rows.size(); ++row, ++place) {
      if (place == part.places.end() || rows.text(row, 1) != features[*place]->id) return false;
      versions[*place] = static_cast<std::uint64_t>(rows.int8(row, 0));
    }
  }
  return place == part.places.end();
}

/// The columns of repack_features() for one statement.
struct RepackColumns {
  std::vector<std::string_view> id;
  std::vector<ByteView> text;
  std::vector<Bytes> packed_solids;
  std::vector<std::int64_t> version, dictionary, blob_bytes;

  void add(const StoredFeature& feature, std::int64_t dictionary_key) {
    id.push_back(feature.id);
    version.push_back(static_cast<std::int64_t>(feature.version));
    dictionary.push_back(dictionary_key);
    packed_solids.push_back(pack_solids(feature));
    blob_bytes.push_back(blob_bytes_of(feature));
    text.push_back(feature.skeleton.bytes);
  }
  Parameters parameters(std::string_view collection) const {
    const std::vector<ByteView> solid_bytes(packed_solids.begin(), packed_solids.end());
    Parameters p;
    p.text(collection).text_array(id).int8_array(version).int8_array(dictionary);
    p.bytea_array(solid_bytes).bytea_array(text).int8_array(blob_bytes);
    return p;
  }
};

// A row that is locked is being changed: it is left alone.
constexpr const char* kRepackFeatures = R"(
  WITH w AS MATERIALIZED (
    SELECT f.collection, f.id, u.d, u.s, u.x, u.n
    FROM unnest($2::text[], $3::int8[], $4::int8[], $5::bytea[], $6::bytea[], $7::int8[])
      AS u (i, v, d, s, x, n)
    JOIN watertight.feature_row f
      ON hashtextextended(f.id, 0) = hashtextextended(u.i, 0) AND f.id = u.i AND f.version = u.v
    WHERE f.collection = (SELECT key FROM watertight.collection WHERE name = $1)
    FOR UPDATE OF f SKIP LOCKED)
  UPDATE watertight.feature_row f SET packed_solids = w.s, packed_text = w.x,
    blob_bytes = w.n,
    dictionary = CASE WHEN w.d = 0 THEN 0 ELSE (SELECT key FROM watertight.dictionary
                        WHERE key = w.d AND collection = w.collection) END
  FROM w WHERE f.collection = w.collection
    AND hashtextextended(f.id, 0) = hashtextextended(w.id, 0) AND f.id = w.id
  RETURNING 1::int8)";

/// The failure of a put whose rows were not all written.
Error not_all_written(DatabaseSession& connection, FeatureRefs features,
                      const std::vector<Part>& parts, const WriteCondition& condition) {
  if (condition.kind == WriteCondition::Kind::absent) {  // another writer was first
    Status found = check_condition(connection, features, parts, condition);
    if (!found) return std::move(found).error();
  }
  for (const StoredFeature* feature : features) {
    const Result<Rows> other = connection.ask(
        "SELECT id FROM watertight.feature_row WHERE collection ="
        " (SELECT key FROM watertight.collection WHERE name = $1)"
        " AND hashtextextended(id, 0) = hashtextextended($2, 0) AND id <> $2",
        Parameters().text(feature->collection).text(feature->id));
    if (!other) return other.error();
    if (other->size() == 0) continue;
    return {ErrorCode::conflict, "feature '" + feature->id + "' cannot be stored beside '" +
                                     std::string(other->text(0, 0)) +
                                     "': their ids have the same hash"};
  }
  return {ErrorCode::unavailable, "the database answered with other rows than were sent"};
}

/// Keeps the values of chosen attributes where a collection has any. The features are locked by
/// now.
Status keep_attributes(DatabaseSession& connection, FeatureRefs features,
                       const std::vector<Part>& parts, const std::vector<Rows>& results,
                       const AttributeReader& reader) {
  for (const Part& part : parts) {
    if (results[part.lock].int8(0, 1) == 0) continue;
    std::vector<const StoredFeature*> of_part;
    for (const std::size_t i : part.places) of_part.push_back(features[i]);
    Status kept = write_attributes(connection, part.collection, of_part, reader);
    if (!kept) return kept;
  }
  return Done{};
}

}  // namespace

Result<std::vector<std::uint64_t>> write_features(DatabaseSession& connection, FeatureRefs features,
                                                  const WriteCondition& condition,
                                                  SharedRows& shared, const AttributeReader& reader,
                                                  Versions kept) {
  const Result<Digests> digests = send_documents(connection, features, shared);
  if (!digests) return digests.error();
  std::vector<Part> parts = parts_of(features);
  send_collections(connection, features, parts, *digests);
  send_kinds(connection, features, *digests);
  const Result<DictionaryKeys> dictionaries = DictionaryKeys::add(connection, features, shared);
  if (!dictionaries) return dictionaries.error();
  if (condition.kind != WriteCondition::Kind::none) {
    Status checked = check_condition(connection, features, parts, condition);
    if (!checked) return std::move(checked).error();
  }
  for (Part& part : parts) {
    // Versions are kept when rows are moved from old tables, before there is a choice.
    part.lock = connection.send(kept == Versions::kept ? kLockCollection : kLockWithChoice,
                                Parameters().text(part.collection));
    send_features(connection, features, part, *digests, condition, *dictionaries, kept);
  }
  const Result<std::vector<Rows>> results = connection.results();
  if (!results) {
    shared.forget_keys();
    return results.error();
  }
  if (Status same = check_collections(connection, features, parts, *results); !same) {
    return std::move(same).error();
  }
  std::vector<std::uint64_t> versions(features.size());
  for (const Part& part : parts) {
    if (!read_versions(features, part, *results, versions)) {
      return not_all_written(connection, features, parts, condition);
    }
  }
  if (kept == Versions::kept) return versions;
  if (Status done = keep_attributes(connection, features, parts, *results, reader); !done) {
    return std::move(done).error();
  }
  return versions;
}

Result<std::uint64_t> repack_features(DatabaseSession& connection, FeatureRefs features,
                                      SharedRows& shared) {
  const Result<DictionaryKeys> dictionaries = DictionaryKeys::add(connection, features, shared);
  if (!dictionaries) return dictionaries.error();
  std::uint64_t repacked = 0;
  for (const Part& part : parts_of(features)) {
    RepackColumns columns;
    for (const std::size_t i : part.places) {
      columns.add(*features[i], dictionaries->of(*features[i]));
    }
    const Result<Rows> rows = connection.ask(kRepackFeatures, columns.parameters(part.collection));
    if (!rows) {
      shared.forget_keys();
      return rows.error();
    }
    repacked += static_cast<std::uint64_t>(rows->size());
  }
  return repacked;
}

Result<Done> delete_feature(DatabaseSession& connection, const std::string& collection,
                            const std::string& id, const WriteCondition& condition) {
  send_gate(connection, collection, Gate::shared);
  connection.send(kLockCollection, Parameters().text(collection));
  const std::string_view wanted[] = {id};
  const Result<Rows> rows =
      connection.ask(kLockFeatures, Parameters().text(collection).text_array(wanted));
  if (!rows) return rows.error();
  if (rows->size() == 0) return no_feature(collection, id);
  const auto version = static_cast<std::uint64_t>(rows->int8(0, 1));
  if (!holds(condition, version)) return failed_precondition(id, version);
  const Result<Rows> gone = connection.ask(
      "DELETE FROM watertight.feature_row WHERE id = $2"
      " AND hashtextextended(id, 0) = hashtextextended($2, 0) AND collection ="
      " (SELECT key FROM watertight.collection WHERE name = $1)",
      Parameters().text(collection).text(id));
  if (!gone) return gone.error();
  return Done{};
}

}  // namespace watertight::store
