// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/streaming/ingestion.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "formats/city_json/city_json.h"
#include "packing/text_dictionary.h"
#include "pipeline/instances.h"
#include "pipeline/repaired/repair_document.h"
#include "pipeline/stored/samples.h"
#include "pipeline/streaming/feature_stream.h"
#include "pipeline/streaming/process.h"

namespace watertight::pipeline {
namespace {

/// Texts of some features of a collection.
Result<std::vector<std::string>> stored_texts(SolidStore& store, const std::string& collection) {
  const auto samples = sample_features(store, collection, packing::kEnoughSamples);
  if (!samples) return samples.error();
  std::vector<std::string> texts;
  for (const StoredFeature& feature : *samples) {
    auto text = packing::unpack(feature.skeleton.bytes, feature.skeleton.dictionary.get(),
                                packing::kMostExampleBytes);
    if (!text && text.error().code == ErrorCode::limit_exceeded)
      continue;  // too long for an example
    if (!text) return std::move(text).error();
    texts.push_back(*std::move(text));
  }
  return texts;
}

}  // namespace

/// A feature after validation; `prepared` if it is to be stored.
struct Ingestion::Processed {
  FeatureOutcome outcome;
  formats::FeaturePlace place;
  std::uint32_t srid = 0;
  std::optional<PreparedFeature> prepared;
};

Ingestion::Ingestion(SolidStore& store, delaunay::EngineWorkers* workers, IngestOptions options,
                     OutcomeSink on_feature, IngestProgress progress)
    : store_(store),
      workers_(workers),
      options_(std::move(options)),
      on_feature_(std::move(on_feature)),
      progress_(std::move(progress)),
      spool_(options_.batch_bytes) {}

/// Reads CRS and policy of the collection if there is one.
Status Ingestion::look_up_collection() {
  if (std::exchange(has_looked_up_, true)) return Done{};
  auto dictionary = store_.dictionary(options_.collection);
  if (!dictionary) return std::move(dictionary).error();
  const auto existing = store_.collection(options_.collection);
  packer_.emplace(
      *std::move(dictionary), existing ? existing->features : 0,
      [this] { return stored_texts(store_, options_.collection); }, options_.threads);
  if (existing) {
    srid_ = existing->srid;
    if (!options_.policy) options_.policy = existing->policy;
    return Done{};
  }
  if (existing.error().code != ErrorCode::not_found) return existing.error();
  if (options_.policy.value_or(Policy::refuse) != Policy::refuse) new_policy_ = options_.policy;
  return Done{};
}

Status Ingestion::add(formats::FeatureReader& reader) {
  if (Status found = look_up_collection(); !found) return found;
  auto shared = shared_part(reader.document(), options_.contract);
  if (!shared) return std::move(shared).error();
  TemplateInspector templates(reader.document().templates, workers_, options_.certify,
                              group_options(options_.groups, options_.certify));
  CellInspector cells(reader.document(), workers_, options_.certify, options_.groups,
                      options_.threads, options_.is_cancelled);
  const FeatureWork work = [&](std::uint64_t, const formats::FeatureText& text,
                               Result<Feature> feature) -> Delivery {
    if (!feature) return [error = std::move(feature).error()]() -> Status { return error; };
    const std::uint32_t srid = feature->srid;
    std::vector<SolidRepair> repairs;
    if (options_.repair) {
      auto repaired = repair_in(*feature);
      if (!repaired) return [error = std::move(repaired).error()]() -> Status { return error; };
      repairs = *std::move(repaired);
    }
    auto processed = process(*std::move(feature), *shared, workers_, options_, templates, cells);
    if (!processed) return [error = std::move(processed).error()]() -> Status { return error; };
    const auto taken =
        std::make_shared<Processed>(Processed{std::move(processed->outcome), text.place, srid, {}});
    taken->outcome.repairs = std::move(repairs);
    if (processed->encoded) {
      const StageTimer timer(options_.stages, Stage::packing);
      auto prepared = packer_->prepare(*std::move(processed->encoded));
      if (!prepared) return [error = std::move(prepared).error()]() -> Status { return error; };
      taken->prepared = *std::move(prepared);
    }
    return [this, taken] { return take(std::move(*taken)); };
  };
  FeatureStreamOptions stream{options_.threads, options_.is_cancelled, {}, options_.stages};
  if (progress_) stream.progress = [this](std::uint64_t bytes) { progress_(counts_.total, bytes); };
  const auto count = stream_features(reader, stream, work);
  if (!count) return count.error();
  return Done{};
}

/// Repairs the solids of a feature by the rules by which they are judged.
Result<std::vector<SolidRepair>> Ingestion::repair_in(Feature& feature) const {
  repair::RepairOptions options = *options_.repair;
  options.certify = options_.certify;
  return repair_feature(feature, workers_, options);
}

Status Ingestion::add_container(ByteView bytes, const Limits& limits, WholeModels models) {
  auto parts = ContainerParts::open(bytes, limits, models);
  if (!parts) return std::move(parts).error();
  for (;;) {
    auto documents = parts->next();
    if (!documents) return std::move(documents).error();
    if (!*documents) return Done{};
    for (Document& document : **documents) {
      auto reader = formats::FeatureReader::of(std::move(document));
      if (Status added = add(reader); !added) return added;
    }
  }
}

/// Names a feature that has no id; checks that the store can keep its id and has it once.
Status Ingestion::check_id(FeatureOutcome& outcome) {
  if (outcome.id.empty()) {
    if (options_.unnamed.empty()) return Error{ErrorCode::malformed, "a feature has no id"};
    outcome.has_own_id = false;
    outcome.id = options_.unnamed;
    if (++unnamed_ > 1) outcome.id.append("-").append(std::to_string(unnamed_));
  }
  if (Status checked = store::check_feature_id(outcome.id); !checked) return checked;
  if (!ids_.insert(outcome.id).second) {
    return Error{ErrorCode::malformed, "two features have the id '" + outcome.id + "'"};
  }
  return Done{};
}

/// Checks that document and collection have one CRS.
Status Ingestion::check_srid(const FeatureOutcome& outcome, std::uint32_t srid) {
  if (!srid_) srid_ = srid;
  if (srid == *srid_) return Done{};
  return Error{ErrorCode::conflict, "feature '" + outcome.id + "' is in CRS " +
                                        std::to_string(srid) + ", the collection in " +
                                        std::to_string(*srid_)};
}

Status Ingestion::take(Processed processed) {
  FeatureOutcome& outcome = processed.outcome;
  outcome.line = processed.place.line;
  if (Status checked = check_id(outcome); !checked) {
    return formats::at_place(std::move(checked).error(), processed.place, outcome.id);
  }
  if (Status checked = check_srid(outcome, processed.srid); !checked) return checked;
  counts_.add(outcome.verdict);
  if (is_refused()) {
    spool_.clear();
    packer_->clear();
  } else if (processed.prepared) {
    const bool is_packed = processed.prepared->packed.has_value();
    store::FeatureRecord& record =
        is_packed ? static_cast<store::FeatureRecord&>(*processed.prepared->packed)
                  : processed.prepared->encoded;
    record.id = outcome.id;
    counts_.unproven += record.unproven();
    counts_.unproven_features += record.is_proven() ? 0 : 1;
    const StageTimer timer(options_.stages, Stage::packing);
    if (Status added = packer_->add(*std::move(processed.prepared), spool_); !added) return added;
  }
  return on_feature_(std::move(outcome));
}

Result<IngestCounts> Ingestion::finish() {
  if (is_refused() || !packer_) return counts_;
  {
    const StageTimer timer(options_.stages, Stage::packing);
    if (Status added = packer_->finish(spool_); !added) return std::move(added).error();
  }
  if (spool_.size() == 0) return counts_;
  if (options_.is_cancelled && options_.is_cancelled()) {
    return Error{ErrorCode::cancelled, "stopped before the features were stored"};
  }
  const StageTimer timer(options_.stages, Stage::storing);
  // A store can join small writes of several clients.
  auto versions = spool_.is_one_batch() ? store_.put(spool_.open_batch(), options_.condition)
                                        : store_.put_all(spool_, options_.condition);
  if (!versions) return std::move(versions).error();
  versions_ = *std::move(versions);
  counts_.stored = spool_.size();
  if (new_policy_) {
    if (Status set = store_.set_policy(options_.collection, *new_policy_); !set) return set.error();
  }
  spool_.clear();
  find_twins();
  return counts_;
}

/// Looks for features that were stored and have the box of another one, which is the sign of one
/// thing that came twice. What is stored stays, whatever becomes of the search.
void Ingestion::find_twins() {
  constexpr std::size_t kIdsAtOnce = 1000;
  std::vector<const std::string*> sorted;
  for (const std::string& id : ids_) sorted.push_back(&id);
  std::sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) { return *a < *b; });
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    ids.push_back(*sorted[i]);
    if (ids.size() < kIdsAtOnce && i + 1 < sorted.size()) continue;
    auto found = store_.twins(options_.collection, ids);
    if (!found) return;
    counts_.twins += found->size();
    for (store::Twins& twins : *found) {
      if (twins_.size() < kMostTwins) twins_.push_back(std::move(twins));
    }
    ids.clear();
  }
}

void OutcomeKeeper::add(FeatureOutcome&& outcome) {
  const bool is_valid = outcome.verdict == Verdict::valid;
  const std::uint64_t rank = outcome.is_stored ? stored_++ : stored_;
  std::uint64_t bytes = 0;
  for (const SolidOutcome& solid : outcome.solids) bytes += solid.report_json.size();
  if (has_all_ && is_full_with(bytes)) {
    has_all_ = false;
    std::erase_if(kept_, [](const Kept& kept) { return kept.outcome.verdict == Verdict::valid; });
    bytes_ = 0;
    for (const Kept& kept : kept_) bytes_ += kept.bytes;
  }
  if ((is_valid && !has_all_) || is_full_with(bytes)) return;
  bytes_ += bytes;
  kept_.push_back({std::move(outcome), bytes, rank});
}

IngestOutcome OutcomeKeeper::outcome(const IngestCounts& counts, const Ingestion& ingestion) && {
  const std::vector<std::uint64_t>& versions = ingestion.versions();
  IngestOutcome all{counts, {}, ingestion.twins()};
  for (Kept& kept : kept_) {
    kept.outcome.is_stored = kept.outcome.is_stored && kept.rank < versions.size();
    if (kept.outcome.is_stored) kept.outcome.version = versions[kept.rank];
    all.features.push_back(std::move(kept.outcome));
  }
  return all;
}

Result<IngestOutcome> ingest(formats::FeatureReader& reader, SolidStore& store,
                             delaunay::EngineWorkers* workers, const IngestOptions& options) {
  OutcomeKeeper keeper(std::numeric_limits<std::size_t>::max(),
                       std::numeric_limits<std::uint64_t>::max());
  Ingestion ingestion(store, workers, options, [&](FeatureOutcome&& outcome) -> Status {
    keeper.add(std::move(outcome));
    return Done{};
  });
  if (Status added = ingestion.add(reader); !added) return std::move(added).error();
  const auto counts = ingestion.finish();
  if (!counts) return counts.error();
  return std::move(keeper).outcome(*counts, ingestion);
}

Result<IngestOutcome> ingest(Document document, SolidStore& store, delaunay::EngineWorkers* workers,
                             const IngestOptions& options) {
  auto reader = formats::FeatureReader::of(std::move(document));
  return ingest(reader, store, workers, options);
}

}  // namespace watertight::pipeline
