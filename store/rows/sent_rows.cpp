// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/rows/sent_rows.h"

#include <set>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace watertight::store {
namespace {

// The conditions keep keys from being drawn for rows that are there already.
constexpr const char* kAddDocument = R"(
  INSERT INTO watertight.document (digest, content) SELECT $1, $2
  WHERE NOT EXISTS (SELECT FROM watertight.document WHERE digest = $1)
  ON CONFLICT DO NOTHING)";

constexpr const char* kAddCollection = R"(
  INSERT INTO watertight.collection (name, srid, document)
  SELECT $1, $2, (SELECT key FROM watertight.document WHERE digest = $3)
  WHERE NOT EXISTS (SELECT FROM watertight.collection WHERE name = $1)
  ON CONFLICT DO NOTHING)";

constexpr const char* kAddKinds = R"(
  INSERT INTO watertight.kind (collection, document, format, type)
  SELECT c.key, d.key, m, t
  FROM unnest($1::text[], $2::bytea[], $3::text[], $4::text[]) AS u (n, h, m, t)
  JOIN watertight.collection c ON c.name = n JOIN watertight.document d ON d.digest = h
  WHERE NOT EXISTS (SELECT FROM watertight.kind k WHERE k.collection = c.key
    AND k.document = d.key AND k.format = m AND k.type = t)
  ON CONFLICT DO NOTHING)";

// Another transaction may add the same dictionary: this one waits for it and takes its row.
constexpr const char* kAddDictionary = R"(
  WITH c AS (SELECT key FROM watertight.collection WHERE name = $1),
    found AS (SELECT d.key FROM watertight.dictionary d JOIN c ON c.key = d.collection
              WHERE d.digest = sha256($2)),
    made AS (INSERT INTO watertight.dictionary AS d (collection, digest, content)
             SELECT key, sha256($2), $2 FROM c WHERE NOT EXISTS (SELECT FROM found)
             ON CONFLICT (collection, digest) DO UPDATE SET digest = d.digest RETURNING key)
  SELECT key::int8 FROM found UNION ALL SELECT key::int8 FROM made)";

}  // namespace

Result<Digests> send_documents(DatabaseSession& connection, FeatureRefs features,
                               SharedRows& shared) {
  Digests digests;
  for (const StoredFeature* feature : features) digests.try_emplace(feature->header);
  std::vector<ByteView> unknown;
  for (auto& [header, digest] : digests) {
    digest = shared.digest(header);
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
      shared.add_digest(header, digest);
    }
  }
  for (const auto& [header, digest] : digests) {
    connection.send(kAddDocument, Parameters().bytea(digest).bytea(as_bytes(header.str())));
  }
  return digests;
}

void send_collection(DatabaseSession& connection, const StoredFeature& feature,
                     const Digests& digests) {
  connection.send(
      kAddCollection,
      Parameters().text(feature.collection).int8(feature.srid).bytea(digests.at(feature.header)));
}

void send_kinds(DatabaseSession& connection, FeatureRefs features, const Digests& digests) {
  using Key = std::tuple<std::string_view, SharedText, std::string_view, std::string_view>;
  std::set<Key> kinds;
  for (const StoredFeature* feature : features) {
    kinds.emplace(feature->collection, feature->header, feature->format, feature->type);
  }
  std::vector<std::string_view> collection, format, type;
  std::vector<ByteView> header;
  for (const auto& [name, text, of_document, of_feature] : kinds) {
    collection.push_back(name);
    header.push_back(digests.at(text));
    format.push_back(of_document);
    type.push_back(of_feature);
  }
  connection.send(
      kAddKinds,
      Parameters().text_array(collection).bytea_array(header).text_array(format).text_array(type));
}

Result<DictionaryKeys> DictionaryKeys::add(DatabaseSession& connection, FeatureRefs features,
                                           SharedRows& shared) {
  DictionaryKeys added;
  for (const StoredFeature* feature : features) {
    const packing::DictionaryPointer& dictionary = feature->skeleton.dictionary;
    if (!dictionary) continue;
    std::int64_t& key = added.keys_[{feature->collection, dictionary.get()}];
    if (key == 0) key = shared.key_of(feature->collection, dictionary);
    if (key != 0) continue;
    const Result<Rows> rows = connection.ask(
        kAddDictionary, Parameters().text(feature->collection).bytea(dictionary->content()));
    if (!rows) return rows.error();
    if (rows->size() == 0) return connection.collide("a collection was removed or renamed");
    key = rows->int8(0, 0);
    shared.add_key(feature->collection, dictionary, key);
  }
  return added;
}

std::int64_t DictionaryKeys::of(const StoredFeature& feature) const {
  const packing::TextDictionary* const dictionary = feature.skeleton.dictionary.get();
  return dictionary == nullptr ? 0 : keys_.at({feature.collection, dictionary});
}

}  // namespace watertight::store
