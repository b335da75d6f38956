// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small documents and a store in memory, for the tests of pipeline, server and cli.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/stored/attributes.h"
#include "store/solid_store.h"
#include "tests/unit/pipeline/filter_oracle.h"

namespace watertight::samples {

inline constexpr std::string_view kHeader =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],)"
    R"("translate":[100.0,200.0,0.0]},"metadata":{"referenceSystem":)"
    R"("https://www.opengis.net/def/crs/EPSG/0/7415"},"CityObjects":{},"vertices":[]})";

/// The facets of a box over vertices 0 to 7, turned outward.
inline constexpr std::string_view kBoxFacets =
    "[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]";
/// The facets of the box without its top.
inline constexpr std::string_view kOpenFacets =
    "[[[0,3,2,1]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]";
inline constexpr std::string_view kBoxVertices =
    "[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,2500],[1000,0,2500],[1000,1000,2500],"
    "[0,1000,2500]]";

/// One line of a sequence: a building with one solid.
inline std::string feature(const std::string& id, std::string_view facets = kBoxFacets,
                           std::string_view vertices = kBoxVertices) {
  return R"({"type":"CityJSONFeature","id":")" + id + R"(","CityObjects":{")" + id +
         R"(":{"type":"Building","attributes":{"height":2.50},"geometry":[{"type":"Solid",)" +
         R"("lod":"2.2","boundaries":[)" + std::string(facets) + R"(]}]}},"vertices":)" +
         std::string(vertices) + "}";
}

inline std::string sequence(const std::vector<std::string>& features) {
  std::string text(kHeader);
  for (const std::string& line : features) text += "\n" + line;
  return text + "\n";
}

/// A store in memory that keeps the promises of a store, and can be made unavailable.
class MemoryStore : public SolidStore {
 public:
  bool is_away = false;
  std::size_t gets = 0;           // how often get() was called
  std::size_t version_reads = 0;  // how often version() was called

  Status ping() override {
    if (is_away) return away();
    return Done{};
  }
  Result<store::CollectionPage> collections(std::uint64_t limit,
                                            const std::string& after) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    store::CollectionPage page;
    for (const auto& [id, features] : features_) {
      if (id <= after) continue;
      if (page.collections.size() == limit) {
        if (limit > 0) page.next = page.collections.back().id;
        break;
      }
      page.collections.push_back(summary(id));
    }
    return page;
  }
  Result<store::StoredCollection> collection(const std::string& id) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (!features_.contains(id)) return Error{ErrorCode::not_found, "no collection " + id};
    return summary(id);
  }
  Result<store::StoredCollection> recount(const std::string& id) override { return collection(id); }
  Status remove_collection(const std::string& id, const CancelPoll& /*is_cancelled*/) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (features_.erase(id) == 0) return Error{ErrorCode::not_found, "no collection " + id};
    return Done{};
  }
  Status rename_collection(const std::string& id, const std::string& new_id) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (!features_.contains(id)) return Error{ErrorCode::not_found, "no collection " + id};
    if (features_.contains(new_id)) return Error{ErrorCode::conflict, "there is a " + new_id};
    if (Status checked = store::check_collection_id(new_id); !checked) return checked;
    auto moved = features_.extract(id);
    moved.key() = new_id;
    for (auto& [key, feature] : moved.mapped()) feature.collection = new_id;
    features_.insert(std::move(moved));
    return Done{};
  }
  Status make_collection(const std::string& id, std::uint32_t srid) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (features_.contains(id)) return Error{ErrorCode::conflict, "there is a " + id};
    features_[id];
    srids_[id] = srid;
    return Done{};
  }
  Status set_rules(const std::string& id, const std::string& rules) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (!features_.contains(id)) return Error{ErrorCode::not_found, "no collection " + id};
    rules_[id] = rules;
    return Done{};
  }
  Status set_policy(const std::string& id, store::Policy policy) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (!features_.contains(id)) return Error{ErrorCode::not_found, "no collection " + id};
    policies_[id] = policy;
    return Done{};
  }
  Result<std::vector<store::ChosenAttribute>> attributes(const std::string& id) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (!features_.contains(id)) return Error{ErrorCode::not_found, "no collection " + id};
    std::vector<store::ChosenAttribute> chosen;
    for (const std::string& name : attributes_[id]) chosen.push_back({name, 1, true, true, true});
    return chosen;
  }
  Status change_attributes(const std::string& id, const store::AttributeChange& change,
                           const CancelPoll& /*is_cancelled*/,
                           const store::ShareDone& /*progress*/) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (!features_.contains(id)) return Error{ErrorCode::not_found, "no collection " + id};
    for (const std::string& name : change.remove) attributes_[id].erase(name);
    for (const std::string& name : change.add) attributes_[id].insert(name);
    return Done{};
  }
  Result<std::vector<std::uint64_t>> put(std::span<const StoredFeature> features,
                                         const store::WriteCondition& condition = {}) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    for (const StoredFeature& feature : features) {
      const std::uint64_t found = version_of(feature.collection, feature.id);
      if (!holds(condition, found)) return precondition_failed(feature.id, found);
    }
    std::vector<std::uint64_t> versions;
    for (const StoredFeature& feature : features) {
      StoredFeature& kept = features_[feature.collection][feature.id];
      kept = feature;
      kept.version = ++version_;
      versions.push_back(version_);
    }
    return versions;
  }
  Result<std::vector<std::uint64_t>> put_all(store::FeatureBatches& batches,
                                             const store::WriteCondition& condition = {}) override {
    std::vector<StoredFeature> all;
    if (Status rewound = batches.rewind(); !rewound) return std::move(rewound).error();
    for (;;) {
      const auto batch = batches.next();
      if (!batch) return batch.error();
      if (batch->empty()) return MemoryStore::put(all, condition);
      all.insert(all.end(), batch->begin(), batch->end());
    }
  }
  Result<packing::DictionaryPointer> dictionary(const std::string& collection) override {
    const std::lock_guard lock(mutex_);
    const auto found = features_.find(collection);
    if (found == features_.end()) return packing::DictionaryPointer();
    for (const auto& [id, feature] : found->second) {
      if (feature.skeleton.dictionary) return feature.skeleton.dictionary;
    }
    return packing::DictionaryPointer();
  }
  Result<std::uint64_t> repack(std::span<const StoredFeature> changed) override {
    const std::lock_guard lock(mutex_);
    for (const StoredFeature& feature : changed) {
      features_[feature.collection][feature.id].skeleton = feature.skeleton;
    }
    return std::uint64_t{changed.size()};
  }
  Result<StoredFeature> get(const std::string& collection, const std::string& id) override {
    const std::lock_guard lock(mutex_);
    ++gets;
    if (is_away) return away();
    const auto features = features_.find(collection);
    if (features == features_.end() || !features->second.contains(id)) {
      return Error{ErrorCode::not_found, "no feature " + id};
    }
    return features->second.at(id);
  }
  Result<store::FeaturePage> list(const store::FeatureQuery& query) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    store::FeaturePage page;
    for (const store::AttributeCondition& condition : query.where) {
      if (attributes_[query.collection].contains(condition.name)) continue;
      return Error{ErrorCode::invalid_argument, "the attribute is not chosen"};
    }
    if (query.filter) {
      for (const std::string& name : store::names_in(*query.filter)) {
        if (attributes_[query.collection].contains(name)) continue;
        return Error{ErrorCode::invalid_argument, "the attribute is not chosen"};
      }
    }
    if (query.sort && !attributes_[query.collection].contains(query.sort->name)) {
      return Error{ErrorCode::invalid_argument, "the attribute is not chosen"};
    }
    for (const auto& [id, feature] : features_[query.collection]) {
      if (query.box && !(feature.box && overlap(*query.box, *feature.box))) continue;
      if (id <= query.after || !fulfils(feature, query.where)) continue;
      if (query.is_proven && feature.is_proven() != *query.is_proven) continue;
      if (query.filter && !passes(feature, *query.filter)) continue;
      if (page.features.size() == query.limit) {
        page.next = page.features.back().id;
        break;
      }
      std::uint64_t bytes = 0;
      for (const StoredSolid& solid : feature.solids) bytes += solid.blob.size();
      page.features.push_back({id, feature.type, feature.version, feature.solids.size(), bytes,
                               feature.box, feature.unproven(), feature.is_proven()});
    }
    return page;
  }
  using SolidStore::walk;
  Result<store::FeatureBatch> walk(const std::string& collection, std::uint64_t limit,
                                   const std::string& after,
                                   const std::optional<store::Filter>& filter) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    store::FeatureBatch batch;
    for (const auto& [id, feature] : features_[collection]) {
      if (id <= after || (filter && !passes(feature, *filter))) continue;
      if (batch.features.size() == limit) {
        batch.next = batch.features.back().id;
        break;
      }
      batch.features.push_back(feature);
    }
    return batch;
  }
  Result<std::vector<store::Twins>> twins(const std::string& collection,
                                          std::span<const std::string> ids) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    std::vector<store::Twins> found;
    for (const std::string& id : std::set<std::string>(ids.begin(), ids.end())) {
      const auto& features = features_[collection];
      const auto own = features.find(id);
      if (own == features.end() || !own->second.box) continue;
      const auto other = std::find_if(features.begin(), features.end(), [&](const auto& entry) {
        const auto& box = entry.second.box;
        return entry.first != id && box && box->min == own->second.box->min &&
               box->max == own->second.box->max;
      });
      if (other != features.end()) found.push_back({id, other->first});
    }
    return found;
  }
  static std::int64_t number_of(const std::string& id) {
    return static_cast<std::int64_t>(std::hash<std::string>()(id) >> 1);
  }
  Result<store::PlacedPage> places(const std::string& collection, std::uint64_t /*limit*/,
                                   const std::string& /*after*/, bool only_unproven) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (!features_.contains(collection)) return Error{ErrorCode::not_found, "no collection"};
    store::PlacedPage page;
    for (const auto& [id, feature] : features_[collection]) {
      if (!feature.box || (only_unproven && feature.is_proven())) continue;
      page.features.push_back({*feature.box, number_of(id), 1});
    }
    return page;
  }
  Result<std::vector<std::string>> ranked(const store::RankQuery& query,
                                          std::uint64_t limit) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    std::map<std::pair<double, std::int64_t>, std::string> found;
    for (const auto& [id, feature] : features_[query.collection]) {
      if (!feature.box || (query.only_unproven && feature.is_proven())) continue;
      const std::pair rank{store::plane_size(*feature.box), number_of(id)};
      bool is_in = rank >= std::pair{query.from.size, query.from.number} &&
                   (!query.below || rank < std::pair{query.below->size, query.below->number});
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double middle = (feature.box->min[axis] + feature.box->max[axis]) / 2;
        is_in = is_in && query.min[axis] <= middle && middle < query.max[axis];
      }
      if (is_in) found.emplace(rank, id);
    }
    std::vector<std::string> ids;
    for (auto at = found.rbegin(); at != found.rend() && ids.size() < limit; ++at) {
      ids.push_back(at->second);
    }
    return ids;
  }
  Result<std::vector<store::StoredHeader>> documents(const std::string& collection,
                                                     std::uint64_t limit) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    if (!features_.contains(collection)) return std::vector<store::StoredHeader>{};
    std::set<std::pair<std::string, std::string>> distinct;
    for (const auto& [id, feature] : features_[collection]) {
      distinct.emplace(feature.format, feature.header);
    }
    std::vector<store::StoredHeader> found;
    for (const auto& [format, header] : distinct) {
      if (found.size() < limit) found.push_back({format, header});
    }
    return found;
  }
  Result<std::uint64_t> version(const std::string& collection, const std::string& id) override {
    const std::lock_guard lock(mutex_);
    ++version_reads;
    if (is_away) return away();
    const std::uint64_t found = version_of(collection, id);
    if (found == 0) return Error{ErrorCode::not_found, "no feature " + id};
    return found;
  }
  Status remove(const std::string& collection, const std::string& id,
                const store::WriteCondition& condition = {}) override {
    const std::lock_guard lock(mutex_);
    if (is_away) return away();
    const std::uint64_t found = version_of(collection, id);
    if (found == 0) return Error{ErrorCode::not_found, "no " + id};
    if (!holds(condition, found)) return precondition_failed(id, found);
    features_[collection].erase(id);
    return Done{};
  }

 private:
  /// The version of a feature; 0 when there is none.
  std::uint64_t version_of(const std::string& collection, const std::string& id) const {
    const auto features = features_.find(collection);
    if (features == features_.end()) return 0;
    const auto feature = features->second.find(id);
    return feature == features->second.end() ? 0 : feature->second.version;
  }
  static bool holds(const store::WriteCondition& condition, std::uint64_t version) {
    using Kind = store::WriteCondition::Kind;
    if (condition.kind == Kind::absent) return version == 0;
    if (condition.kind == Kind::present) return version != 0;
    if (condition.kind == Kind::none) return true;
    return version != 0 && std::find(condition.versions.begin(), condition.versions.end(),
                                     version) != condition.versions.end();
  }
  static Error precondition_failed(const std::string& id, std::uint64_t version) {
    return Error{ErrorCode::precondition_failed,
                 "feature '" + id + "' has version " + std::to_string(version)};
  }
  /// For conditions that compare equal texts.
  static bool fulfils(const StoredFeature& feature,
                      std::span<const store::AttributeCondition> where) {
    return std::all_of(where.begin(), where.end(), [&](const auto& condition) {
      const std::string names[] = {condition.name};
      const auto found = pipeline::read_attributes(feature, names);
      return found && std::any_of(found->begin(), found->end(), [&](const auto& attribute) {
               return std::find(condition.values.begin(), condition.values.end(),
                                attribute.value) != condition.values.end();
             });
    });
  }
  static bool passes(const StoredFeature& feature, const store::Filter& filter) {
    std::vector<std::string> names = store::names_in(filter);
    std::sort(names.begin(), names.end());
    Values values;
    if (const auto found = pipeline::read_attributes(feature, names)) {
      for (const auto& attribute : *found) values[names[attribute.name]].push_back(attribute.value);
    }
    return truth_of(filter, values, feature.box).value_or(false);
  }
  static Error away() { return Error{ErrorCode::unavailable, "the database is away"}; }
  static bool overlap(const store::StoredBox& a, const store::StoredBox& b) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (a.min[axis] > b.max[axis] || a.max[axis] < b.min[axis]) return false;
    }
    return true;
  }
  store::StoredCollection summary(const std::string& id) {
    store::StoredCollection collection;
    collection.id = id;
    std::uint64_t first = UINT64_MAX;
    for (const auto& [name, feature] : features_[id]) {
      collection.srid = feature.srid;
      if (feature.version < first) collection.header = feature.header;
      first = std::min(first, feature.version);
      ++collection.features;
      collection.solids += feature.solids.size();
      collection.unproven += feature.unproven();
      collection.unproven_features += feature.is_proven() ? 0 : 1;
      if (!feature.box) continue;
      if (!collection.box) collection.box = feature.box;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        collection.box->min[axis] = std::min(collection.box->min[axis], feature.box->min[axis]);
        collection.box->max[axis] = std::max(collection.box->max[axis], feature.box->max[axis]);
      }
    }
    if (policies_.contains(id)) collection.policy = policies_.at(id);
    if (rules_.contains(id)) collection.rules = rules_.at(id);
    if (collection.features == 0 && srids_.contains(id)) collection.srid = srids_.at(id);
    collection.state = std::to_string(version_) + "-" + std::to_string(collection.features);
    return collection;
  }

  std::mutex mutex_;
  std::map<std::string, std::map<std::string, StoredFeature>> features_;
  std::map<std::string, std::set<std::string>> attributes_;
  std::map<std::string, store::Policy> policies_;
  std::map<std::string, std::string> rules_;
  std::map<std::string, std::uint32_t> srids_;  // of collections that were made without features
  std::uint64_t version_ = 0;
};

}  // namespace watertight::samples
