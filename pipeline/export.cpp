// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/export.h"

#include <utility>

namespace watertight::pipeline {
namespace {

constexpr std::uint64_t kBatch = 100;
constexpr std::uint64_t kFirstBatch = 1;  // so that the first bytes are there soon
constexpr std::size_t kWorthSending = 64U << 10U;

Error about(const std::string& id, Error error) {
  error.message.insert(0, "feature '" + id + "': ");
  return error;
}

bool is_city_model(const std::string& format) {
  return format == formats::to_string(Format::city_json) ||
         format == formats::to_string(Format::city_json_seq);
}

constexpr const char* kOtherDocument =
    "of another document than those before, which a sequence cannot hold; a Watertight file (.wt) "
    "can";

/// The header of a sequence of all features. Errors: those of CollectionExport::start().
Result<std::string> sequence_header(SolidStore& store, const std::string& collection) {
  const auto documents = store.documents(collection, 2);
  if (!documents) return documents.error();
  const std::string name = "collection '" + collection + "' ";
  if (documents->empty()) return Error{ErrorCode::not_found, name + "has no features"};
  for (const store::StoredHeader& document : *documents) {
    if (is_city_model(document.format)) continue;
    return Error{ErrorCode::unsupported,
                 name + "has features of format " + document.format + ", not of a city model"};
  }
  if (documents->front().header != documents->back().header) {
    return Error{ErrorCode::unsupported,
                 name +
                     "has features with different headers, which a sequence cannot hold; a "
                     "Watertight file (.wt) can"};
  }
  return documents->front().header;
}

void append(Bytes& bytes, ByteView more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

}  // namespace

Result<CollectionExport> CollectionExport::start(SolidStore& store, const std::string& collection,
                                                 ExportFormat format, const EncodeOptions& pages,
                                                 SolidLayout layout, ExportScope scope) {
  if (const auto found = store.collection(collection); !found) return found.error();
  CollectionExport started(store, collection);
  started.scope_ = scope;
  if (format == ExportFormat::container) {
    // A file of proven features can be of version 1, which older programs read.
    started.container_.emplace(pages, layout, scope == ExportScope::all ? kContainerVersion : 1);
    return started;
  }
  auto header = sequence_header(store, collection);
  if (!header) return std::move(header).error();
  started.header_ = *std::move(header);
  // The header was checked when it was stored.
  auto city_header = formats::read_city_json_header(started.header_, kOwnText);
  if (!city_header) return std::move(city_header).error();
  started.city_header_ = *std::move(city_header);
  return started;
}

Result<Bytes> CollectionExport::next(const CancelPoll& is_cancelled) {
  Bytes bytes;
  const std::size_t enough = is_first_ ? 1 : kWorthSending;
  while (bytes.size() < enough && !is_last_) {
    auto batch = store_->walk(collection_, is_first_ ? kFirstBatch : kBatch, after_);
    if (!batch) return std::move(batch).error();
    if (is_first_ && batch->features.empty()) {
      return Error{ErrorCode::not_found, "collection '" + collection_ + "' has no features"};
    }
    if (is_first_) key_ = batch->key;
    if (batch->key != key_) {
      return Error{ErrorCode::unavailable,
                   "another collection has the id '" + collection_ + "' by now"};
    }
    if (is_first_ && !container_) append(bytes, as_bytes(header_ + '\n'));
    is_first_ = false;
    for (StoredFeature& feature : batch->features) {
      if (is_cancelled && is_cancelled()) {
        return Error{ErrorCode::cancelled, "the export was not finished"};
      }
      if (scope_ == ExportScope::proven && !feature.is_proven()) continue;
      ++exported_.features;
      exported_.solids += feature.solids.size();
      if (Status status = add(std::move(feature), bytes); !status) return status.error();
    }
    after_ = std::move(batch->next);
    is_last_ = after_.empty();
    if (is_last_ && exported_.features == 0) {
      return Error{ErrorCode::not_found, "collection '" + collection_ + "' has no proven features"};
    }
    if (!is_last_ || !container_) continue;
    const auto rest = (*std::exchange(container_, std::nullopt)).finish();
    if (!rest) return rest.error();
    append(bytes, *rest);
  }
  return bytes;
}

Status CollectionExport::add(StoredFeature feature, Bytes& bytes) {
  if (!container_) return add_line(std::move(feature), bytes);
  const std::string id = feature.id;
  auto encoded = unpack(std::move(feature));
  if (!encoded) return about(id, encoded.error());
  if (Status status = container_->add(*std::move(encoded)); !status) return status;
  append(bytes, container_->take());
  return Done{};
}

Status CollectionExport::add_line(StoredFeature feature, Bytes& bytes) {
  const std::string id = feature.id;
  // Only features that were stored after start() can have another format or header.
  if (!is_city_model(feature.format) || feature.header != header_) {
    return about(id, {ErrorCode::unsupported, kOtherDocument});
  }
  const auto document = from_stored(std::move(feature));
  if (!document) return about(id, document.error());
  auto line = formats::write_city_json_feature(*city_header_, document->features.front());
  if (!line) return about(id, line.error());
  append(bytes, as_bytes(*line + '\n'));
  return Done{};
}

}  // namespace watertight::pipeline
