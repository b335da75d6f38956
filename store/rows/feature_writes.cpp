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

#include "store/rows/feature_rows.h"
#include "store/rows/place.h"

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

using Digests = std::map<SharedText, Bytes>;

/// Sends each distinct header once. Returns the SHA-256 of each; waits for those that are new.
Result<Digests> send_headers(DatabaseSession& connection, FeatureRefs features,
                             HeaderDigests& known) {
  Digests digests;
  for (const StoredFeature* feature : features) digests.try_emplace(feature->header);
  std::vector<ByteView> unknown;
  for (auto& [header, digest] : digests) {
    digest = known.find(header);
    if (digest.empty()) unknown.push_back(as_bytes(header.str()));
  }
  if (!unknown.empty()) {
    const Result<Rows> rows = connection.ask(
        "SELECT sha256(c) FROM unnest($1::bytea[]) WITH ORDINALITY AS u (c, n) ORDER BY n",
        Parameters().bytea_array(unknown));
    if (!rows) return rows.error();
    int row = 0;
    for (auto& [header, digest] : digests) {
      if (!digest.empty()) continue;
      const ByteView found = as_bytes(rows->text(row++, 0));
      digest.assign(found.begin(), found.end());
      known.add(header, digest);
    }
  }
  for (const auto& [header, digest] : digests) {
    connection.send(
        "INSERT INTO watertight.document_header (digest, content) VALUES ($1, $2)"
        " ON CONFLICT DO NOTHING",
        Parameters().bytea(digest).bytea(as_bytes(header.str())));
  }
  return digests;
}

// A key is never used for two collections, also while rows of a removed one are being deleted.
constexpr const char* kAddCollection = R"(
  INSERT INTO watertight.collection (id, name, srid, header)
  SELECT CASE WHEN EXISTS (SELECT FROM watertight.collection WHERE id = $1)
           THEN '#' || nextval('watertight.collection_key') ELSE $1 END, $1, $2, $3
  WHERE NOT EXISTS (SELECT FROM watertight.collection WHERE name = $1)
  ON CONFLICT DO NOTHING)";

// While this lock is held, no other transaction can rename or remove the collection.
constexpr const char* kLockCollection =
    "SELECT srid FROM watertight.collection WHERE name = $1 FOR KEY SHARE";

/// Creates the collections that do not exist, and locks all.
void send_collections(DatabaseSession& connection, FeatureRefs features, std::vector<Part>& parts,
                      const Digests& digests) {
  for (Part& part : parts) {
    const StoredFeature& first = *features[part.places.front()];
    send_gate(connection, part.collection, Gate::shared);
    connection.send(
        kAddCollection,
        Parameters().text(part.collection).int8(first.srid).bytea(digests.at(first.header)));
    part.lock = connection.send(kLockCollection, Parameters().text(part.collection));
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
  SELECT id, version FROM watertight.feature
  WHERE collection = (SELECT id FROM watertight.collection WHERE name = $1) AND id = ANY($2)
  ORDER BY id FOR UPDATE)";

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

/// The columns of the table `feature` for one statement.
struct FeatureColumns {
  std::vector<std::string_view> id, type, format, findings;
  std::vector<ByteView> header, skeleton;
  std::vector<std::int64_t> srid, solids, blob_bytes, place, unproven, is_proven;
  std::array<std::vector<std::optional<double>>, 6> box;
  std::size_t bytes = 0;

  void add(const StoredFeature& feature, const Bytes& digest) {
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
    unproven.push_back(static_cast<std::int64_t>(feature.unproven()));
    is_proven.push_back(feature.is_proven() ? 1 : 0);
    findings.push_back(feature.findings);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box[axis].push_back(feature.box ? std::optional(feature.box->min[axis]) : std::nullopt);
      box[axis + 3].push_back(feature.box ? std::optional(feature.box->max[axis]) : std::nullopt);
    }
    bytes += feature.id.size() + feature.skeleton.bytes.size() + feature.findings.size() + 512;
  }
  Parameters parameters(std::string_view collection, const WriteCondition& condition) const {
    Parameters p;
    p.text(collection).text_array(id).text_array(type).text_array(format);
    p.int8_array(srid).bytea_array(header).bytea_array(skeleton);
    p.int8_array(solids).int8_array(blob_bytes);
    for (const auto& side : box) p.float8_array(side);
    p.int8_array(place).int8_array(unproven).int8_array(is_proven).text_array(findings);
    p.int8(condition.kind == WriteCondition::Kind::absent ? 0 : 1);
    return p;
  }
};

// PostgreSQL draws the new version after it locked the row, so the version is above every earlier
// version of the row. Where $20 is 0, a feature that exists is left as it is and not returned.
constexpr const char* kPutFeatures = R"(
  INSERT INTO watertight.feature AS f (collection, id, type, format, srid, header, skeleton,
    solids, blob_bytes, min_x, min_y, min_z, max_x, max_y, max_z, place,
    unproven, is_proven, findings)
  SELECT (SELECT id FROM watertight.collection WHERE name = $1), i, t, m, s, h, k, n, b,
    x0, y0, z0, x1, y1, z1, p, w, v = 1, nullif(r, '')::jsonb
  FROM unnest($2::text[], $3::text[], $4::text[], $5::int8[], $6::bytea[],
    $7::bytea[], $8::int8[], $9::int8[], $10::float8[], $11::float8[], $12::float8[],
    $13::float8[], $14::float8[], $15::float8[], $16::int8[], $17::int8[], $18::int8[], $19::text[])
    AS u (i, t, m, s, h, k, n, b, x0, y0, z0, x1, y1, z1, p, w, v, r)
  ON CONFLICT (collection, id) DO UPDATE SET
    version = nextval('watertight.feature_version'), type = excluded.type,
    format = excluded.format, srid = excluded.srid, header = excluded.header,
    skeleton = excluded.skeleton, solids = excluded.solids, blob_bytes = excluded.blob_bytes,
    min_x = excluded.min_x, min_y = excluded.min_y, min_z = excluded.min_z,
    max_x = excluded.max_x, max_y = excluded.max_y, max_z = excluded.max_z, place = excluded.place,
    unproven = excluded.unproven, is_proven = excluded.is_proven, findings = excluded.findings
    WHERE $20 = 1
  RETURNING f.version, f.id)";

constexpr const char* kDropSolids = R"(
  DELETE FROM watertight.solid
  WHERE collection = (SELECT id FROM watertight.collection WHERE name = $1) AND feature = ANY($2))";

/// Sends the features of a part, and the deletion of the solids that they had.
void send_features(DatabaseSession& connection, FeatureRefs features, Part& part,
                   const Digests& digests, const WriteCondition& condition) {
  std::vector<std::string_view> ids;
  FeatureColumns columns;
  for (const std::size_t i : part.places) {
    ids.push_back(features[i]->id);
    columns.add(*features[i], digests.at(features[i]->header));
    const bool is_last = ids.size() == part.places.size();
    if (columns.bytes < kStatementBytes && !is_last) continue;
    const std::size_t sent =
        connection.send(kPutFeatures, columns.parameters(part.collection, condition));
    if (part.end == 0) part.rows = sent;
    part.end = sent + 1;
    columns = {};
  }
  connection.send(kDropSolids, Parameters().text(part.collection).text_array(ids));
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

/// The columns of the table `solid` for one statement.
struct SolidColumns {
  std::vector<std::string_view> feature, object, lod, measures, report;
  std::vector<std::int64_t> geometry, ordinal, position;
  std::vector<ByteView> blob;
  std::size_t bytes = 0;

  void add(const std::string& owner, const StoredSolid& solid, std::size_t place) {
    feature.push_back(owner);
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
  Parameters parameters(std::string_view collection) const {
    Parameters p;
    p.text(collection).text_array(feature).text_array(object).int8_array(geometry);
    p.int8_array(ordinal).int8_array(position).text_array(lod).bytea_array(blob);
    p.text_array(measures).text_array(report);
    return p;
  }
};

constexpr const char* kPutSolids = R"(
  INSERT INTO watertight.solid (collection, feature, object_id, geometry, ordinal, position, lod,
    blob, measures, report)
  SELECT (SELECT id FROM watertight.collection WHERE name = $1),
    f, o, g, n, p, l, nullif(b, ''::bytea), nullif(m, '')::jsonb, nullif(r, '')::jsonb
  FROM unnest($2::text[], $3::text[], $4::int8[], $5::int8[], $6::int8[], $7::text[],
    $8::bytea[], $9::text[], $10::text[]) AS u (f, o, g, n, p, l, b, m, r))";

void send_solids(DatabaseSession& connection, FeatureRefs features, const Part& part) {
  SolidColumns columns;
  const auto flush = [&] {
    if (columns.blob.empty()) return;
    connection.send(kPutSolids, columns.parameters(part.collection));
    columns = {};
  };
  for (const std::size_t i : part.places) {
    for (std::size_t place = 0; place < features[i]->solids.size(); ++place) {
      columns.add(features[i]->id, features[i]->solids[place], place);
      if (columns.bytes >= kStatementBytes) flush();
    }
  }
  flush();
}

/// The failure of a put whose rows were not all written.
Error not_all_written(DatabaseSession& connection, FeatureRefs features,
                      const std::vector<Part>& parts, const WriteCondition& condition) {
  if (condition.kind == WriteCondition::Kind::absent) {  // another writer was first
    Status found = check_condition(connection, features, parts, condition);
    if (!found) return std::move(found).error();
  }
  return {ErrorCode::unavailable, "the database answered with other rows than were sent"};
}

}  // namespace

Bytes HeaderDigests::find(const SharedText& header) const {
  const std::lock_guard lock(mutex_);
  const auto found = digests_.find(header);
  return found == digests_.end() ? Bytes() : found->second;
}

void HeaderDigests::add(const SharedText& header, const Bytes& digest) {
  constexpr std::size_t kMostBytes = 8 << 20;
  const std::lock_guard lock(mutex_);
  if (bytes_ + header.str().size() > kMostBytes) {
    digests_.clear();
    bytes_ = 0;
  }
  if (header.str().size() > kMostBytes) return;
  if (digests_.try_emplace(header, digest).second) bytes_ += header.str().size() + digest.size();
}

Result<std::vector<std::uint64_t>> write_features(DatabaseSession& connection, FeatureRefs features,
                                                  const WriteCondition& condition,
                                                  HeaderDigests& known) {
  const Result<Digests> digests = send_headers(connection, features, known);
  if (!digests) return digests.error();
  std::vector<Part> parts = parts_of(features);
  send_collections(connection, features, parts, *digests);
  if (condition.kind != WriteCondition::Kind::none) {
    Status checked = check_condition(connection, features, parts, condition);
    if (!checked) return std::move(checked).error();
    for (Part& part : parts) {
      part.lock = connection.send(kLockCollection, Parameters().text(part.collection));
    }
  }
  for (Part& part : parts) {
    send_features(connection, features, part, *digests, condition);
    send_solids(connection, features, part);
  }
  const Result<std::vector<Rows>> results = connection.results();
  if (!results) return results.error();
  if (Status same = check_collections(connection, features, parts, *results); !same) {
    return std::move(same).error();
  }
  std::vector<std::uint64_t> versions(features.size());
  for (const Part& part : parts) {
    if (!read_versions(features, part, *results, versions)) {
      return not_all_written(connection, features, parts, condition);
    }
  }
  return versions;
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
      "DELETE FROM watertight.feature WHERE id = $2 AND collection ="
      " (SELECT id FROM watertight.collection WHERE name = $1)",
      Parameters().text(collection).text(id));
  if (!gone) return gone.error();
  return Done{};
}

}  // namespace watertight::store
