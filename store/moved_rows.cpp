// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/moved_rows.h"

#include <chrono>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "packing/text_dictionary.h"
#include "packing/zstandard_frame.h"
#include "store/rows/feature_rows.h"

namespace watertight::store {
namespace {

constexpr std::int64_t kMovedBatch = 200;
constexpr std::int64_t kSamples = 1000;
constexpr std::chrono::seconds kBetweenSentences{5};

/// A feature of the old tables: all but its packed text.
struct OldFeature {
  StoredFeature feature;
  std::string text;
};

/// The columns of an old feature; those of its solids are arrays in the order of position.
constexpr const char* kOldFeatures = R"(
  SELECT f.id, f.version, f.type, f.format, f.srid, h.content, f.skeleton,
    f.min_x, f.min_y, f.min_z, f.max_x, f.max_y, f.max_z, f.findings::text, f.is_proven::int::int8
  FROM watertight.old_feature f JOIN watertight.old_header h ON h.digest = f.header
  WHERE f.collection = $1 ORDER BY f.id LIMIT $2)";

constexpr const char* kOldSolids = R"(
  SELECT feature, object_id, geometry, ordinal, lod, blob, measures::text, report::text
  FROM watertight.old_solid WHERE collection = $1 AND feature = ANY($2) ORDER BY feature, position)";

/// A line of the text of a feature as pipeline/stored/stored_reports.cpp reads it, with all of the
/// JSON.
std::string whole_line(const char* start, std::size_t solid, std::string_view json) {
  std::string line(start);
  line += ' ';
  line += std::to_string(solid);
  line += " 0 0 ";
  line += json;
  return line += '\n';
}

OldFeature feature_of(const Rows& rows, int row, const std::string& name) {
  OldFeature old;
  StoredFeature& feature = old.feature;
  feature.collection = name;
  feature.id = rows.text(row, 0);
  feature.version = static_cast<std::uint64_t>(rows.int8(row, 1));
  feature.type = rows.text(row, 2);
  feature.format = rows.text(row, 3);
  feature.srid = static_cast<std::uint32_t>(rows.int8(row, 4));
  feature.header = std::string(rows.text(row, 5));
  feature.box = box_of(rows, row, 7);
  feature.has_findings = !rows.is_null(row, 13);
  if (feature.has_findings) {
    old.text.append("findings ").append(rows.text(row, 13)).append("\n");
  }
  return old;
}

void add_solid(const Rows& rows, int row, OldFeature& old, std::string& reports) {
  const std::size_t number = old.feature.solids.size();
  StoredSolid& solid = old.feature.solids.emplace_back();
  solid.object_id = rows.text(row, 1);
  solid.geometry = static_cast<std::uint32_t>(rows.int8(row, 2));
  solid.ordinal = static_cast<std::uint32_t>(rows.int8(row, 3));
  solid.lod = rows.text(row, 4);
  solid.is_proven = !rows.is_null(row, 5);
  const ByteView blob = as_bytes(rows.text(row, 5));
  solid.blob.assign(blob.begin(), blob.end());
  reports += whole_line("measures", number, rows.text(row, 6));
  reports += whole_line("report", number, rows.text(row, 7));
}

/// The text of an old skeleton.
Result<std::string> skeleton_of(ByteView frame, const std::string& id) {
  auto text = packing::unpack_frame(frame, std::numeric_limits<std::uint64_t>::max());
  if (text) return text;
  return Error{ErrorCode::malformed,
               "the skeleton of feature '" + id + "' in the old tables cannot be read"};
}

/// The next features of an old collection, with their texts.
Result<std::vector<OldFeature>> read_old(DatabaseSession& connection, const std::string& key,
                                         const std::string& name, std::int64_t limit) {
  const Result<Rows> rows = connection.ask(kOldFeatures, Parameters().text(key).int8(limit));
  if (!rows) return rows.error();
  std::vector<OldFeature> features;
  std::vector<std::string_view> ids;
  for (int row = 0; row < rows->size(); ++row) {
    ids.push_back(rows->text(row, 0));
    features.push_back(feature_of(*rows, row, name));
  }
  const Result<Rows> solids = connection.ask(kOldSolids, Parameters().text(key).text_array(ids));
  if (!solids) return solids.error();
  int next = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    OldFeature& old = features[i];
    std::string reports;
    for (; next < solids->size() && solids->text(next, 0) == old.feature.id; ++next) {
      add_solid(*solids, next, old, reports);
    }
    auto skeleton = skeleton_of(as_bytes(rows->text(static_cast<int>(i), 6)), old.feature.id);
    if (!skeleton) return std::move(skeleton).error();
    old.text = reports + old.text + *skeleton;
  }
  return features;
}

/// The dictionary of a collection that is being moved: the one it has, or a new one.
Result<packing::DictionaryPointer> dictionary_for(DatabaseSession& connection,
                                                  const std::string& key, const std::string& name,
                                                  std::uint64_t expected, SharedRows& shared) {
  auto known = read_dictionary(connection, name, shared);
  if (!known || *known) return known;
  auto samples = read_old(connection, key, name, kSamples);
  if (!samples) return std::move(samples).error();
  std::vector<std::string> texts;
  for (OldFeature& sample : *samples) texts.push_back(std::move(sample.text));
  return packing::best_dictionary(texts, expected);
}

/// Moves some features. Returns how many.
Result<std::uint64_t> move_batch(DatabaseSession& connection, const std::string& key,
                                 const std::string& name,
                                 const packing::DictionaryPointer& dictionary, SharedRows& shared) {
  connection.send("BEGIN");
  auto batch = read_old(connection, key, name, kMovedBatch);
  if (!batch) return std::move(batch).error();
  std::vector<const StoredFeature*> features;
  std::vector<std::string_view> ids;
  for (OldFeature& old : *batch) {
    auto packed = packing::pack(old.text, dictionary.get());
    if (!packed) return std::move(packed).error();
    old.feature.skeleton = {*std::move(packed), dictionary};
    features.push_back(&old.feature);
    ids.push_back(old.feature.id);
  }
  if (!features.empty()) {
    const auto written = write_features(connection, features, {}, shared, {}, Versions::kept);
    if (!written) return written.error();
    connection.send("DELETE FROM watertight.old_feature WHERE collection = $1 AND id = ANY($2)",
                    Parameters().text(key).text_array(ids));
  }
  if (const Result<Rows> ended = connection.run("COMMIT"); !ended) return ended.error();
  return static_cast<std::uint64_t>(features.size());
}

}  // namespace

Status move_rows(DatabaseSession& connection, const Tell& tell,
                 const std::function<Status(DatabaseSession&)>& finish) {
  using Clock = std::chrono::steady_clock;
  SharedRows shared;
  const Result<Rows> collections = connection.run(
      "SELECT c.id, c.name, (SELECT count(*) FROM watertight.old_feature f"
      " WHERE f.collection = c.id) FROM watertight.old_collection c WHERE c.name IS NOT NULL"
      " ORDER BY c.name");
  if (!collections) return collections.error();
  std::uint64_t all = 0;
  for (int row = 0; row < collections->size(); ++row) {
    all += static_cast<std::uint64_t>(collections->int8(row, 2));
  }
  std::uint64_t moved = 0;
  Clock::time_point spoken = Clock::now();
  for (int row = 0; row < collections->size(); ++row) {
    const std::string key(collections->text(row, 0));
    const std::string name(collections->text(row, 1));
    const auto features = static_cast<std::uint64_t>(collections->int8(row, 2));
    if (features == 0) continue;
    const auto dictionary = dictionary_for(connection, key, name, features, shared);
    if (!dictionary) return dictionary.error();
    for (std::uint64_t count = 1; count > 0;) {
      const auto batch = move_batch(connection, key, name, *dictionary, shared);
      if (!batch) return batch.error();
      count = *batch;
      moved += count;
      if (!tell || (Clock::now() < spoken + kBetweenSentences && moved < all)) continue;
      spoken = Clock::now();
      if (count > 0) {
        tell("moved " + std::to_string(moved) + " of " + std::to_string(all) +
             " features into the tables of this version");
      }
    }
  }
  for (const char* statement :
       {"BEGIN", "DROP TABLE watertight.old_solid", "DROP TABLE watertight.old_feature",
        "DROP TABLE watertight.old_collection", "DROP TABLE watertight.old_header"}) {
    if (const Result<Rows> done = connection.run(statement); !done) return done.error();
  }
  if (Status done = finish(connection); !done) return done;
  if (const Result<Rows> ended = connection.run("COMMIT"); !ended) return ended.error();
  return Done{};
}

}  // namespace watertight::store
