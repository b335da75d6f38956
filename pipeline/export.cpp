// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/export.h"

#include <utility>

#include "pipeline/container.h"

namespace watertight {
namespace {

constexpr std::uint64_t kBatch = 500;

using TakeFeature = std::function<Status(const StoredFeature&)>;

/// Hands on every feature. Errors: those of the store and of `take`; not_found.
Result<Exported> for_each_feature(SolidStore& store, const std::string& collection,
                                  const TakeFeature& take) {
  if (const auto found = store.collection(collection); !found) return found.error();
  Exported exported;
  FeatureQuery query{collection, kBatch, {}, {}};
  do {
    auto batch = store.list(query);
    if (!batch) return std::move(batch).error();
    for (const StoredFeature& feature : batch->features) {
      if (Status status = take(feature); !status) return status.error();
      ++exported.features;
      exported.solids += feature.solids.size();
    }
    query.after = std::move(batch->next);
  } while (!query.after.empty());
  if (exported.features > 0) return exported;
  return Error{ErrorCode::not_found, "collection '" + collection + "' has no features"};
}

Error about(const StoredFeature& feature, Error error) {
  error.message.insert(0, "feature '" + feature.id + "': ");
  return error;
}

bool is_city_model(const StoredFeature& feature) {
  return feature.format == to_string(Format::city_json) ||
         feature.format == to_string(Format::city_json_seq);
}

}  // namespace

Result<Exported> export_container(SolidStore& store, const std::string& collection,
                                  const ByteSink& sink, const EncodeOptions& pages) {
  ContainerWriter writer(pages);
  const auto take = [&](const StoredFeature& feature) -> Status {
    if (Status status = writer.add(feature); !status) return status;
    return sink(writer.take());
  };
  const auto exported = for_each_feature(store, collection, take);
  if (!exported) return exported;
  const auto rest = std::move(writer).finish();
  if (!rest) return rest.error();
  if (Status status = sink(*rest); !status) return status.error();
  return exported;
}

Result<Exported> export_sequence(SolidStore& store, const std::string& collection,
                                 const ByteSink& sink) {
  std::string header;
  bool is_first = true;
  return for_each_feature(store, collection, [&](const StoredFeature& feature) -> Status {
    if (!is_city_model(feature)) {
      return about(feature, {ErrorCode::unsupported,
                             "of format " + feature.format + ", not of a city model"});
    }
    if (is_first) {
      header = feature.header;
      if (Status status = sink(as_bytes(header + '\n')); !status) return status;
      is_first = false;
    }
    if (feature.header != header) {
      return about(feature, {ErrorCode::unsupported,
                             "of another document than those before, which a sequence cannot "
                             "hold; a Watertight file (.wt) can"});
    }
    const auto document = from_stored(feature);
    if (!document) return about(feature, document.error());
    auto line = write_feature(*document, document->features.front());
    if (!line) return about(feature, line.error());
    return sink(as_bytes(*line + '\n'));
  });
}

}  // namespace watertight
