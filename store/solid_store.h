// SPDX-License-Identifier: GPL-3.0-or-later
//
// The store of valid solids (docs/architecture.md, "What is stored"): collections of features, each
// a document skeleton with the blobs of its solids. Knows blobs as bytes only. Implementations are
// thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/packed_text.h"
#include "base/result.h"
#include "base/shared_text.h"

namespace watertight::store {

struct StoredBox {
  std::array<double, 3> min{};
  std::array<double, 3> max{};
};

struct StoredCollection {
  std::string id;  // [A-Za-z0-9_.-]{1,64}
  std::uint32_t srid = 0;
  std::string header;  // shared document header (formats/document.h) of its first document
  std::uint64_t features = 0;
  std::uint64_t solids = 0;
  std::uint64_t blob_bytes = 0;
  /// Contains all features. After features were removed or replaced it may be larger than needed,
  /// until recount().
  std::optional<StoredBox> box;
};

struct StoredSolid {
  std::string object_id;
  std::uint32_t geometry = 0;
  std::uint32_t ordinal = 0;
  std::string lod;
  Bytes blob;
  std::string measures;  // JSON
  std::string report;    // JSON
};

/// A feature but for its skeleton.
struct FeatureRecord {
  std::string collection;
  std::string id;
  std::string type;
  std::uint32_t srid = 0;  // EPSG code, 0 when not stated; one for all features of a collection
  std::string format;      // to_string(Format) of the document it came in
  SharedText header;       // document header it needs (may differ from the collection's)
  std::optional<StoredBox> box;  // world coordinates, over its solids
  std::vector<StoredSolid> solids;
  std::uint64_t version = 0;  // set by the store, never used twice; the ETag
};

struct StoredFeature : FeatureRecord {
  PackedText skeleton;
};

struct FeatureQuery {
  std::string collection;
  std::uint64_t limit = 10;
  std::string after;  // id after which the page starts; "" = from the start
  /// Asks for the features whose closed boxes have a point in common with this one.
  std::optional<StoredBox> box;
};

/// The facts about a feature that lists show.
struct FeatureSummary {
  std::string id;
  std::string type;
  std::uint64_t version = 0;
  std::uint64_t solids = 0;
  std::uint64_t blob_bytes = 0;
  std::optional<StoredBox> box;
};

struct FeaturePage {
  std::vector<FeatureSummary> features;  // ordered by id, bytewise
  std::string next;                      // `after` of the next page; "" = this is the last
};

/// The format and header that the features of one document share.
struct StoredHeader {
  std::string format;
  std::string header;
};

struct FeatureBatch {
  std::vector<StoredFeature> features;
  std::string next;  // `after` of the next batch; "" = this is the last
};

class SolidStore {
 public:
  virtual ~SolidStore() = default;
  /// Ok when the database answers and its schema is current.
  virtual Status ping() = 0;
  /// The cost of this and the next does not depend on the number of features.
  virtual Result<std::vector<StoredCollection>> collections() = 0;
  virtual Result<StoredCollection> collection(const std::string& id) = 0;
  /// Counts a collection again and makes its box as small as it can be. Reads all its features.
  /// Errors: not_found.
  virtual Result<StoredCollection> recount(const std::string& id) = 0;
  /// Stores all features or none, durably, creating the collection when it does not exist; an id
  /// that exists is replaced and its version raised. All in one round trip per table. Returns the
  /// new versions in order. Errors: invalid_argument for what the database cannot keep as it is
  /// (ids with NUL, not UTF-8 or above 1024 bytes, boxes that are not finite, a solid twice);
  /// conflict when a feature is there twice or its CRS is not its collection's; unavailable.
  virtual Result<std::vector<std::uint64_t>> put(std::span<const StoredFeature> features) = 0;
  virtual Result<StoredFeature> get(const std::string& collection, const std::string& id) = 0;
  /// At most 10,000 features a page. Errors: not_found when there is no such collection.
  virtual Result<FeaturePage> list(const FeatureQuery& query) = 0;
  /// All features of a collection, a batch at a time, in order of their place numbers
  /// (store/place.h: along a Hilbert curve through the centres of their boxes), those without a box
  /// last, ties by id, bytewise. At most `limit` (10,000) features, fewer when they are large (16
  /// MiB). `after` is FeatureBatch::next, "" at the start. Errors: not_found when there is no such
  /// collection; invalid_argument for an `after` that no batch returned.
  virtual Result<FeatureBatch> walk(const std::string& collection, std::uint64_t limit,
                                    const std::string& after) = 0;
  /// The documents that the features of a collection came in, at most `limit` of them; none of a
  /// collection that does not exist.
  virtual Result<std::vector<StoredHeader>> documents(const std::string& collection,
                                                      std::uint64_t limit) = 0;
  /// Errors: not_found.
  virtual Status remove(const std::string& collection, const std::string& id) = 0;
};

/// A store in any PostgreSQL database (libpq connection string or URL). Applies missing migrations.
/// Reconnects after a lost connection; an operation that was in flight is retried only when it is
/// known not to have been committed or is idempotent. Errors: unavailable with the server's words.
Result<std::unique_ptr<SolidStore>> open_postgres_store(const std::string& connection,
                                                        std::size_t connections = 4);

}  // namespace watertight::store

namespace watertight {

using store::SolidStore;
using store::StoredFeature;
using store::StoredSolid;

}  // namespace watertight
