// SPDX-License-Identifier: GPL-3.0-or-later
//
// The store of valid solids (docs/architecture.md, "What is stored"): collections of features, each
// a document skeleton with the blobs of its solids. The store knows blobs and pages as bytes only.
// Implementations are thread-safe.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/cancel.h"
#include "base/packed_text.h"
#include "base/result.h"
#include "base/shared_text.h"
#include "packing/text_dictionary.h"
#include "store/attributes.h"
#include "store/filter.h"

namespace watertight::store {

/// Ok for an id that a collection can have: 1 to 64 of A-Z a-z 0-9 _ . -, and neither "." nor "..",
/// which no URL can name. Errors: invalid_argument.
Status check_collection_id(const std::string& id);

/// Ok for an id that a feature can have: 1 to 1024 bytes of UTF-8 without NUL, neither "." nor
/// "..", which no URL can name. Errors: invalid_argument.
Status check_feature_id(const std::string& id);

/// The treatment of a document with features that are not valid, where the write says none: nothing
/// of it is stored; the valid rest is; or all is, with what is not proven as it came.
enum class Policy : std::uint8_t { refuse, skip, keep };

struct StoredCollection {
  std::string id;  // [A-Za-z0-9_.-]{1,64}
  std::uint32_t srid = 0;
  std::string header;  // header (formats/document.h) of the collection's first document
  std::uint64_t features = 0;
  std::uint64_t solids = 0;
  std::uint64_t blob_bytes = 0;         // of blobs and pages
  std::uint64_t unproven = 0;           // the solids that are not proven
  std::uint64_t unproven_features = 0;  // the features that are not proven (is_proven())
  Policy policy = Policy::refuse;
  std::string rules;  // by which solids are judged in writes; the store does not understand it
  /// Changes with every change of the features. Collections that have this name in turn never share
  /// one.
  std::string state;
  /// Contains all features. After features were removed or replaced it may be larger than needed,
  /// until recount().
  std::optional<StoredBox> box;
};

struct StoredSolid {
  std::string object_id;
  std::uint32_t geometry = 0;
  std::uint32_t ordinal = 0;
  std::string lod;
  Bytes blob;             // empty unless the solid is proven, and for one in FeatureRecord::page
  bool is_proven = true;  // false: the skeleton of the feature has the solid as it came
  std::string measures;   // JSON; "" in a StoredFeature, whose text has it
  std::string report;     // JSON; the same
};

/// A stored feature without its skeleton.
struct FeatureRecord {
  std::string collection;
  std::string id;
  std::string type;
  std::uint32_t srid = 0;  // EPSG code, 0 when not stated; one for all features of a collection
  std::string format;      // to_string(Format) of the feature's document
  SharedText header;       // header of the feature's document (may differ from the collection's)
  std::optional<StoredBox> box;  // world coordinates of the box around its solids
  std::vector<StoredSolid> solids;
  /// The proven solids without a blob, in their order, as a page (codec/page.h). "": there are
  /// none.
  Bytes page;
  /// JSON array of the groups of solids in which a defect was found; "" when there is none, and in
  /// a StoredFeature, whose text has it.
  std::string findings;
  bool has_findings = false;  // whether a defect was found in a group of solids
  std::uint64_t version = 0;  // set by the store, never used twice; serves as ETag

  /// The number of solids that are not proven.
  std::uint64_t unproven() const {
    std::uint64_t count = 0;
    for (const StoredSolid& solid : solids) count += solid.is_proven ? 0 : 1;
    return count;
  }
  /// Whether all solids are proven, and no defect was found in a group of them.
  bool is_proven() const { return !has_findings && findings.empty() && unproven() == 0; }
};

/// A feature as the store keeps it: measures, reports and findings are part of the packed text.
struct StoredFeature : FeatureRecord {
  PackedText skeleton;
};

struct CollectionPage {
  std::vector<StoredCollection> collections;  // ordered by id, bytewise
  std::string next;  // `after` of the next page; "" = this page is the last
};

/// The fact that must hold for each feature of a write before the feature is changed.
struct WriteCondition {
  enum class Kind : std::uint8_t {
    none,     // nothing
    absent,   // the feature does not exist
    present,  // the feature exists
    versions  // the feature exists, and its version is one of `versions`
  };
  Kind kind = Kind::none;
  std::vector<std::uint64_t> versions;
};

/// An order by the values of an attribute that is complete: numbers, then texts, then truths, each
/// kind ascending or descending, then the features without a value. A feature with several values
/// is where the first of them puts it, once.
struct SortKey {
  std::string name;
  bool is_descending = false;
};

struct FeatureQuery {
  std::string collection;
  std::uint64_t limit = 10;
  std::string after;  // id, of any feature, after which the page starts; "" = from the start
  /// Selects the features whose closed boxes have a point in common with this box.
  std::optional<StoredBox> box;
  /// How much of the collection's extent in x and y the box covers, 0 to 1, so that the search can
  /// go by place (little) or by id (much). Any value is right; the cost differs.
  double share = 0;
  /// Selects the features that are proven, or those that are not.
  std::optional<bool> is_proven = std::nullopt;
  /// Conditions that must all hold, at most kMostConditions, on attributes that are complete.
  std::vector<AttributeCondition> where = {};
  /// A condition that must hold besides, on attributes that are complete.
  std::optional<Filter> filter = std::nullopt;
  /// The order, instead of that of ids; `after` is then a cursor.
  std::optional<SortKey> sort = std::nullopt;
};

/// The facts about a feature that lists show.
struct FeatureSummary {
  std::string id;
  std::string type;
  std::uint64_t version = 0;
  std::uint64_t solids = 0;
  std::uint64_t blob_bytes = 0;  // of blobs and page
  std::optional<StoredBox> box;
  std::uint64_t unproven = 0;  // the solids that are not proven
  bool is_proven = true;
  std::string cursor = {};  // FeatureQuery::after for the features that follow
};

struct FeaturePage {
  std::vector<FeatureSummary> features;  // in an order of their ids that never changes
  std::string next;                      // `after` of the next page; "" = this page is the last
};

/// Coordinates beyond this count as this where features are ranked by size.
inline constexpr double kFarthest = 1e18;

/// The longer side of a box in x and y.
inline double plane_size(const StoredBox& box) {
  const auto side = [&](std::size_t axis) {
    return std::clamp(box.max[axis], -kFarthest, kFarthest) -
           std::clamp(box.min[axis], -kFarthest, kFarthest);
  };
  return std::max(side(0), side(1));
}

/// A feature by its place and size.
struct PlacedFeature {
  StoredBox box;
  std::int64_t number = 0;  // unlike that of any other feature of the collection; stays
  std::uint64_t bytes = 0;  // of its packed text and solids
};

struct PlacedPage {
  std::vector<PlacedFeature> features;
  std::string next;  // `after` of the next page; "" = this page is the last
};

/// A rank of features: by plane_size(), then by PlacedFeature::number.
struct SizeRank {
  double size = 0;
  std::int64_t number = 0;
};

/// Some features of a part of the plane, by their ranks.
struct RankQuery {
  std::string collection;
  /// The middles of boxes are in this part: from `min` on, below `max`.
  std::array<double, 2> min{};
  std::array<double, 2> max{};
  SizeRank from;                  // the lowest rank
  std::optional<SizeRank> below;  // ranks are below it
  bool only_unproven = false;     // of the features that are not proven (is_proven())
};

/// Two features of a collection in the same place: their boxes are equal, which tells of one thing
/// under two ids.
struct Twins {
  std::string id;
  std::string other;
};

/// The format and header that the features of one document share.
struct StoredHeader {
  std::string format;
  std::string header;
};

struct FeatureBatch {
  std::vector<StoredFeature> features;
  std::string next;  // `after` of the next batch; "" = this batch is the last
  /// The collection's key, which no other collection of its name has at another time.
  std::string key;
};

/// Features in batches, for SolidStore::put_all(), which may read them more than once.
class FeatureBatches {
 public:
  virtual ~FeatureBatches() = default;
  /// Goes back to the first batch.
  virtual Status rewind() = 0;
  /// The next batch, empty after the last. Valid until the next call.
  virtual Result<std::span<const StoredFeature>> next() = 0;
};

/// Called with the share of the work that is done.
using ShareDone = std::function<void(double)>;

class SolidStore {
 public:
  virtual ~SolidStore() = default;
  /// Ok when the database answers and its schema is current.
  /// While it says that the database is away, other calls fail at once.
  virtual Status ping() = 0;
  /// Makes running and later calls fail within moments. For a process that is about to end.
  virtual void interrupt() {}
  /// The collections after the id `after` ("" = from the start), at most `limit` (10,000). The cost
  /// of this and the next does not depend on the number of features. Errors: invalid_argument for
  /// an `after` that no collection can have.
  virtual Result<CollectionPage> collections(std::uint64_t limit, const std::string& after) = 0;
  virtual Result<StoredCollection> collection(const std::string& id) = 0;
  /// Counts a collection again and makes its box as small as it can be. Reads all its features.
  /// Errors: not_found.
  virtual Result<StoredCollection> recount(const std::string& id) = 0;
  /// Removes a collection with all its features, its CRS and its header. It is gone for all readers
  /// at one moment; a writer of that moment gets the old collection or a new one, as a whole. Waits
  /// for the writers that have begun. Its rows are deleted after that, some at a time (about a
  /// minute for 1,000,000 features); when `is_cancelled` ends this, later writes delete the rest.
  /// Errors: not_found; cancelled when nothing was removed; unavailable.
  virtual Status remove_collection(const std::string& id, const CancelPoll& is_cancelled) = 0;
  /// Gives a collection another id, at one moment. Waits for the writers that have begun. The cost
  /// does not depend on the number of features. Errors: not_found; conflict when `new_id` exists;
  /// invalid_argument when it is not an id of a collection.
  virtual Status rename_collection(const std::string& id, const std::string& new_id) = 0;
  /// Makes a collection without features, in EPSG system `srid` (0: none). Errors: conflict when
  /// there is one with this id; invalid_argument for an id that no collection can have.
  virtual Status make_collection(const std::string& id, std::uint32_t srid) = 0;
  /// Sets the policy of a collection for later writes. Errors: not_found.
  virtual Status set_policy(const std::string& id, Policy policy) = 0;
  /// Sets the rules of a collection for later writes. Errors: not_found.
  virtual Status set_rules(const std::string& id, const std::string& rules) = 0;
  /// The chosen attributes of a collection, by name. Errors: not_found.
  virtual Result<std::vector<ChosenAttribute>> attributes(const std::string& collection) = 0;
  /// Chooses attributes, or no longer, then fills in the values of all stored features for those
  /// that are not complete, and deletes the values of those that were removed, some at a time:
  /// others may read and write meanwhile. A call that was broken off is continued by the next one.
  /// Errors: not_found (the collection, an attribute to be removed); invalid_argument (a name, more
  /// than kMostAttributes); cancelled when not everything was done; those of the reader.
  virtual Status change_attributes(const std::string& collection, const AttributeChange& change,
                                   const CancelPoll& is_cancelled = {},
                                   const ShareDone& progress = {}) = 0;
  /// Stores all features or none, durably. Creates the collection when it does not exist; replaces
  /// a feature whose id exists, under a higher version. A dictionary that the collection does not
  /// have becomes its newest. Sends the rows of a table together. Returns
  /// the new version of each feature. Errors: invalid_argument for a feature that the database
  /// cannot keep as it is (ids with NUL, not UTF-8 or above 1024 bytes, boxes that are not finite,
  /// a solid twice); conflict when a feature is there twice or its CRS is not that of its
  /// collection, or two ids have one hash of 64 bits; precondition_failed, which names a feature
  /// for which `condition` does not hold, and its version; unavailable.
  virtual Result<std::vector<std::uint64_t>> put(std::span<const StoredFeature> features,
                                                 const WriteCondition& condition = {}) = 0;
  /// Like put(), for more features than memory holds: all batches in one transaction. The limit of
  /// time holds for each batch. Errors: those of put() and of the batches.
  virtual Result<std::vector<std::uint64_t>> put_all(FeatureBatches& batches,
                                                     const WriteCondition& condition = {}) = 0;
  /// The current version of a feature, by one short question to the database. Errors: not_found.
  virtual Result<std::uint64_t> version(const std::string& collection, const std::string& id) = 0;
  virtual Result<StoredFeature> get(const std::string& collection, const std::string& id) = 0;
  /// The dictionary with which texts of the collection are packed now; null: none. May be some
  /// seconds old.
  virtual Result<packing::DictionaryPointer> dictionary(const std::string& collection) = 0;
  /// Gives features other packed texts that mean the same, all or none of a batch but for those
  /// that changed since they were read: these stay as they are. Versions stay. Returns the number
  /// of features whose text was replaced. Errors: those of put().
  virtual Result<std::uint64_t> repack(std::span<const StoredFeature> features) = 0;
  /// A page has at most 10,000 features. Errors: not_found when there is no such collection;
  /// invalid_argument for a condition on an attribute that is not chosen or not complete.
  virtual Result<FeaturePage> list(const FeatureQuery& query) = 0;
  /// The next batch of the features of a collection, in order of their place numbers
  /// (store/rows/place.h: along a Hilbert curve through the centres of their boxes), features
  /// without a box last, ties by id, bytewise; with `filter` only those for which it is true. A
  /// batch has at most `limit` (10,000) features, fewer when they are large (16 MiB). `after` is
  /// FeatureBatch::next, "" at the start. Errors: not_found when there is no such collection;
  /// invalid_argument for an `after` that no batch returned, and as for list().
  virtual Result<FeatureBatch> walk(const std::string& collection, std::uint64_t limit,
                                    const std::string& after,
                                    const std::optional<Filter>& filter) = 0;
  Result<FeatureBatch> walk(const std::string& collection, std::uint64_t limit,
                            const std::string& after) {
    return walk(collection, limit, after, std::nullopt);
  }
  /// The places of the next features that have a box, in the order of walk(), or only those that
  /// are not proven; at most `limit` (10,000). Errors: as for walk().
  virtual Result<PlacedPage> places(const std::string& collection, std::uint64_t limit,
                                    const std::string& after, bool only_unproven) = 0;
  /// The ids of features by their ranks, the highest first; at most `limit` (10,000). Errors:
  /// not_found when there is no such collection. Cost: that of reading the boxes in the part of the
  /// plane.
  virtual Result<std::vector<std::string>> ranked(const RankQuery& query, std::uint64_t limit) = 0;
  /// Of the features with these ids those that have the box of another one, each once with one such
  /// other, in order of their ids. Errors: not_found when there is no such collection. Cost: two
  /// looks into indexes for each id.
  virtual Result<std::vector<Twins>> twins(const std::string& collection,
                                           std::span<const std::string> ids) = 0;
  /// The formats and headers of the documents that the features of a collection came in, at most
  /// `limit`; empty for a collection that does not exist.
  virtual Result<std::vector<StoredHeader>> documents(const std::string& collection,
                                                      std::uint64_t limit) = 0;
  /// Errors: not_found; precondition_failed with the version when `condition` does not hold.
  virtual Status remove(const std::string& collection, const std::string& id,
                        const WriteCondition& condition = {}) = 0;
};

/// Takes a sentence about the progress of a migration.
using Tell = std::function<void(const std::string&)>;

/// A store in any PostgreSQL database (libpq connection string or URL). Applies missing migrations.
/// Reconnects after a lost connection; an interrupted operation is tried again only when it is
/// idempotent or known not to have been committed. `is_cancelled` ends the opening; a thread asks
/// it. `tell` takes sentences about the progress of a migration. `reader` reads the values of
/// chosen attributes; without one, collections with chosen attributes cannot be written. Errors:
/// unavailable with the server's message.
Result<std::unique_ptr<SolidStore>> open_postgres_store(const std::string& connection,
                                                        std::size_t connections = 4,
                                                        const CancelPoll& is_cancelled = {},
                                                        const Tell& tell = {},
                                                        AttributeReader reader = {});

}  // namespace watertight::store

namespace watertight {

using store::SolidStore;
using store::StoredFeature;
using store::StoredSolid;

}  // namespace watertight
