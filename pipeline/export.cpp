// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/export.h"

#include <utility>

#include "base/quantity.h"

namespace watertight::pipeline {
namespace {

constexpr std::uint64_t kExportBatch = 100;
constexpr std::uint64_t kFirstBatch = 1;  // so that the first bytes are there soon
constexpr std::size_t kWorthSending = 64U << 10U;

Error about(const std::string& id, Error error) {
  error.message.insert(0, "feature '" + id + "': ");
  return error;
}

void append(Bytes& bytes, ByteView more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

}  // namespace

Result<CollectionExport> CollectionExport::start(SolidStore& store, const std::string& collection,
                                                 ExportFormat format,
                                                 const ContainerOptions& options, ExportScope scope,
                                                 std::optional<store::Filter> filter) {
  if (const auto found = store.collection(collection); !found) return found.error();
  CollectionExport started(store, collection);
  started.scope_ = scope;
  if (format == ExportFormat::container) {
    started.filter_ = std::move(filter);
    started.container_.emplace(options);
    return started;
  }
  auto plan = SequencePlan::make(store, collection);
  if (!plan) return std::move(plan).error();
  const std::span<const PlannedSequence> sequences = plan->sequences();
  if (sequences.size() > 1) {
    return Error{ErrorCode::unsupported,
                 "collection '" + collection + "' needs " + std::to_string(sequences.size()) +
                     " sequences, as its documents have different headers (" + sequences[1].reason +
                     "); a Watertight file (.wt) holds all"};
  }
  return start_sequence(store, collection, std::make_shared<SequencePlan>(*std::move(plan)), 0,
                        scope, std::move(filter));
}

Result<CollectionExport> CollectionExport::start_sequence(SolidStore& store,
                                                          const std::string& collection,
                                                          std::shared_ptr<const SequencePlan> plan,
                                                          std::size_t sequence, ExportScope scope,
                                                          std::optional<store::Filter> filter) {
  if (sequence >= plan->sequences().size()) {
    return Error{ErrorCode::invalid_argument, "collection '" + collection + "' has " +
                                                  quantity(plan->sequences().size(), "sequence")};
  }
  if (const auto found = store.collection(collection); !found) return found.error();
  CollectionExport started(store, collection);
  started.scope_ = scope;
  started.filter_ = std::move(filter);
  started.plan_ = std::move(plan);
  started.sequence_ = sequence;
  return started;
}

Result<Bytes> CollectionExport::next(const CancelPoll& is_cancelled) {
  Bytes bytes;
  const std::size_t enough = is_first_ ? 1 : kWorthSending;
  while (bytes.size() < enough && !is_last_) {
    auto batch = store_->walk(collection_, is_first_ ? kFirstBatch : kExportBatch, after_, filter_);
    if (!batch) return std::move(batch).error();
    if (is_first_ && batch->features.empty() && filter_) {
      return Error{ErrorCode::not_found,
                   "no feature of collection '" + collection_ + "' is selected"};
    }
    if (is_first_ && batch->features.empty()) {
      return Error{ErrorCode::not_found, "collection '" + collection_ + "' has no features"};
    }
    if (is_first_) key_ = batch->key;
    if (batch->key != key_) {
      return Error{ErrorCode::unavailable,
                   "another collection has the id '" + collection_ + "' by now"};
    }
    if (is_first_ && plan_) append(bytes, as_bytes(plan_->sequences()[sequence_].header + '\n'));
    is_first_ = false;
    for (StoredFeature& feature : batch->features) {
      if (is_cancelled && is_cancelled()) {
        return Error{ErrorCode::cancelled, "the export was not finished"};
      }
      if (scope_ != ExportScope::all && feature.is_proven() != (scope_ == ExportScope::proven)) {
        continue;
      }
      if (Status status = add(std::move(feature), bytes); !status) return status.error();
    }
    after_ = std::move(batch->next);
    is_last_ = after_.empty();
    const bool is_part = plan_ && plan_->sequences().size() > 1;
    if (is_last_ && exported_.features == 0 && !is_part && scope_ != ExportScope::unproven) {
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
  if (plan_) return add_line(std::move(feature), bytes);
  const std::string id = feature.id;
  ++exported_.features;
  exported_.solids += feature.solids.size();
  auto encoded = unpack(std::move(feature), {}, Reports::of_unproven);
  if (!encoded) return about(id, encoded.error());
  if (Status status = container_->add(*std::move(encoded)); !status) return status;
  append(bytes, container_->take());
  return Done{};
}

Status CollectionExport::add_line(StoredFeature feature, Bytes& bytes) {
  if (plan_->is_elsewhere(feature, sequence_)) return Done{};
  const std::uint64_t solids = feature.solids.size();
  const auto line = plan_->line(std::move(feature));
  if (!line) return line.error();
  if (line->sequence != sequence_) return Done{};
  ++exported_.features;
  exported_.solids += solids;
  exported_.generic += line->is_generic ? 1 : 0;
  append(bytes, as_bytes(line->text + '\n'));
  return Done{};
}

}  // namespace watertight::pipeline
