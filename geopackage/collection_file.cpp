// SPDX-License-Identifier: GPL-3.0-or-later
#include "geopackage/collection_file.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "geopackage/package.h"
#include "pipeline/shown/shown_feature.h"
#include "report/stored_findings.h"

namespace watertight::geopackage {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kBatch = 100;

/// The features of a collection on their way into a file.
class CollectionRun {
 public:
  CollectionRun(SolidStore& store, std::string collection, const CollectionChoice& choice,
                const CancelPoll& is_cancelled, const HasRoom& has_room)
      : store_(store),
        collection_(std::move(collection)),
        choice_(choice),
        is_cancelled_(is_cancelled),
        has_room_(has_room),
        reader_(choice.lod, {}) {}

  Result<CollectionFile> run() {
    const auto collection = store_.collection(collection_);
    if (!collection) return collection.error();
    std::optional<Package> package;
    auto file = TemporaryFile::make([&](const std::string& path) -> Status {
      auto created = Package::create(path, collection->srid);
      if (!created) return std::move(created).error();
      package.emplace(*std::move(created));
      return Done{};
    });
    if (!file) return std::move(file).error();
    if (Status written = write(*package, *file); !written) return std::move(written).error();
    package.reset();
    if (Status measured = measure(*file); !measured) return std::move(measured).error();
    return CollectionFile{*std::move(file), features_->rows(), findings_->rows()};
  }

 private:
  /// Learns the size of the file, and whether it may go on growing.
  Status measure(TemporaryFile& file) const {
    if (Status measured = file.measure(); !measured) return measured;
    if (!has_room_ || has_room_(file.size())) return Done{};
    return Error{ErrorCode::limit_exceeded, "there is no room for the file of the collection"};
  }

  Status write(Package& package, TemporaryFile& file) {
    srid_ = package.srid();
    auto features = package.begin_layer();
    if (!features) return std::move(features).error();
    features_.emplace(*std::move(features));
    auto findings = package.begin_layer();
    if (!findings) return std::move(findings).error();
    findings_.emplace(*std::move(findings));
    if (Status read = read_features(file); !read) return read;
    if (features_->rows() == 0) {
      return Error{ErrorCode::not_found, "collection '" + collection_ + "' has no such features"};
    }
    const std::string name = layer_name(collection_);
    const Status finished = package.finish(*features_, name, "features", is_cancelled_);
    if (!finished) return finished;
    if (findings_->rows() > 0) {
      const Status also =
          package.finish(*findings_, name + "_findings",
                         "the defects of the features that are not proven", is_cancelled_);
      if (!also) return also;
    }
    return package.close();
  }

  Status read_features(TemporaryFile& file) {
    std::string after;
    do {
      auto batch = store_.walk(collection_, kBatch, after, choice_.filter);
      if (!batch) return std::move(batch).error();
      for (StoredFeature& feature : batch->features) {
        if (is_cancelled_ && is_cancelled_()) {
          return Error{ErrorCode::cancelled, "the GeoPackage was not finished"};
        }
        const bool is_wanted =
            choice_.scope == pipeline::ExportScope::all ||
            feature.is_proven() == (choice_.scope == pipeline::ExportScope::proven);
        if (!is_wanted) continue;
        if (Status added = add(std::move(feature)); !added) return added;
      }
      if (Status measured = measure(file); !measured) return measured;
      after = std::move(batch->next);
    } while (!after.empty());
    return Done{};
  }

  Status add(StoredFeature feature) {
    if (!feature.is_proven()) {
      if (Status added = add_findings(feature); !added) return added;
    }
    auto shown = reader_.read(std::move(feature));
    if (!shown) return std::move(shown).error();
    Properties properties{{"id", Json(shown->id).dump()}};
    for (auto& attribute : shown->city.attributes) properties.push_back(std::move(attribute));
    for (auto& property : shown->properties) properties.push_back(std::move(property));
    if (shown->city.is_too_large) {
      properties.emplace_back("wt_no_geometry",
                              R"("the geometry has more vertices than are shown")");
    }
    return features_->add(shape_bytes(shown->city.shapes, srid_), properties);
  }

  /// Adds the defects of a feature that is not proven, from the reports of its solids and groups.
  Status add_findings(const StoredFeature& feature) {
    const auto unpacked = pipeline::unpack(feature, {}, pipeline::Reports::of_unproven);
    if (!unpacked) return unpacked.error();
    for (const report::StoredFinding& finding : report::findings_of(*unpacked)) {
      const Status added = add_finding(feature.id, finding);
      if (!added) return added;
    }
    return Done{};
  }

  Status add_finding(const std::string& feature, const report::StoredFinding& finding) {
    std::optional<ShapeBytes> shape;
    if (finding.witness) shape = point_bytes(*finding.witness, srid_);
    Properties properties{{"feature", Json(feature).dump()}};
    for (auto& property : report::properties_of(finding)) properties.push_back(std::move(property));
    return findings_->add(shape, properties);
  }

  SolidStore& store_;
  std::string collection_;
  const CollectionChoice& choice_;
  const CancelPoll& is_cancelled_;
  const HasRoom& has_room_;
  pipeline::ShownFeatureReader reader_;
  std::uint32_t srid_ = 0;
  std::optional<Layer> features_;
  std::optional<Layer> findings_;
};

}  // namespace

Result<CollectionFile> collection_file(SolidStore& store, const std::string& collection,
                                       const CollectionChoice& choice,
                                       const CancelPoll& is_cancelled, const HasRoom& has_room) {
  return CollectionRun(store, collection, choice, is_cancelled, has_room).run();
}

}  // namespace watertight::geopackage
