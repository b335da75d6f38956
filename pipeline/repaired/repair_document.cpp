// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/repaired/repair_document.h"

#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "formats/city_json/city_json.h"
#include "formats/gml/edits/edit_gml.h"
#include "geometry/parallel.h"
#include "pipeline/pipeline.h"
#include "repair/summary_json.h"

namespace watertight::pipeline {
namespace {

using repair::Repaired;

/// Repairs a solid; nothing if it is valid as it was read.
std::optional<Repaired> repaired(const Feature& feature, const SubmittedSolid& submitted,
                                 delaunay::EngineWorkers* workers,
                                 const repair::RepairOptions& options) {
  repair::RepairOptions own = options;
  // The transform of a city model has no finer steps.
  own.smooth.keeps_lattice = feature.skeleton.starts_with('{');
  own.certify.unclosed_rings = submitted.unclosed_rings;
  own.certify.unreadable = submitted.unreadable;
  Repaired result = repair::repair(submitted.solid, workers, own);
  if (result.outcome == Repaired::Outcome::valid_as_read) return std::nullopt;
  return result;
}

/// Repairs the solids of a document; an entry for each solid of its features, in order.
std::vector<std::optional<Repaired>> repaired_solids(const Document& document,
                                                     delaunay::EngineWorkers* workers,
                                                     const repair::RepairOptions& options,
                                                     unsigned threads) {
  std::vector<std::pair<const Feature*, const SubmittedSolid*>> solids;
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& submitted : feature.solids)
      solids.emplace_back(&feature, &submitted);
  }
  std::vector<std::optional<Repaired>> results(solids.size());
  geometry::for_each_piece(solids.size(), threads, [&](std::size_t i, bool) {
    results[i] = repaired(*solids[i].first, *solids[i].second, workers, options);
  });
  return results;
}

/// Appends what became of each solid of a feature that is not valid, and the edits of the repaired
/// ones, in the same order. `results` has an entry for each solid; edits count from `first` on.
Status add_results(const Feature& feature, std::span<const std::optional<Repaired>> results,
                   std::size_t first, std::vector<SolidRepair>& repairs,
                   std::vector<formats::SolidEdit>& edits) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results[i]) continue;
    const SubmittedSolid& submitted = feature.solids[i];
    repairs.push_back(
        {submitted.source, feature.id, repair::summary_of(submitted.solid, *results[i])});
    if (!results[i]->edits) continue;
    auto solid = repair::on_submitted_vertices(submitted.solid, *results[i]->edits);
    if (!solid) return std::move(solid).error();
    edits.push_back({first + i, std::move(solid->solid), std::move(solid->facet_source)});
  }
  return Done{};
}

/// Puts repaired solids into their feature, and appends what became of each that is not valid.
Status apply(Feature& feature, std::span<const std::optional<Repaired>> results,
             std::vector<SolidRepair>& repairs) {
  std::vector<formats::SolidEdit> edits;
  const std::size_t first = repairs.size();
  if (Status added = add_results(feature, results, 0, repairs, edits); !added) return added;
  if (edits.empty()) return Done{};
  std::vector<std::size_t> numbers;
  for (const formats::SolidEdit& edit : edits) numbers.push_back(edit.number);
  if (Status replaced = formats::replace_solids(feature, std::move(edits)); !replaced) {
    return replaced;
  }
  auto number = numbers.begin();
  for (const SolidRepair& repair : std::span(repairs).subspan(first)) {
    if (!repair.is_repaired()) continue;
    feature.solids[*number++].repair = repair::summary_json(repair.summary);
  }
  return Done{};
}

}  // namespace

Result<std::vector<SolidRepair>> repair_feature(Feature& feature, delaunay::EngineWorkers* workers,
                                                const repair::RepairOptions& options) {
  std::vector<std::optional<Repaired>> results;
  for (const SubmittedSolid& submitted : feature.solids) {
    results.push_back(repaired(feature, submitted, workers, options));
  }
  std::vector<SolidRepair> repairs;
  if (const Status applied = apply(feature, results, repairs); !applied) return applied.error();
  return repairs;
}

Result<DocumentRepair> repair_document(Document& document, delaunay::EngineWorkers* workers,
                                       const repair::RepairOptions& options, unsigned threads) {
  const auto results = repaired_solids(document, workers, options, threads);
  DocumentRepair outcome;
  outcome.features = document.features.size();
  outcome.solids = results.size();
  std::size_t begin = 0;
  for (Feature& feature : document.features) {
    const auto own = std::span(results).subspan(begin, feature.solids.size());
    begin += own.size();
    const Status applied = apply(feature, own, outcome.repairs);
    if (!applied) return applied.error();
  }
  outcome.valid_as_read = outcome.solids - outcome.repairs.size();
  return outcome;
}

namespace {

std::string refusal_note(const SolidRepair& repair, const Error& error) {
  return "the repaired solid of '" + repair.source.object_id + "' cannot be written as GML, " +
         error.message + "; it stays as it was (a city model can have it)";
}

/// Repairs the solids of a GML document, and puts them into its text.
Result<RepairedText> repair_gml(ByteView text, const formats::ReadOptions& reading,
                                delaunay::EngineWorkers* workers,
                                const repair::RepairOptions& options, unsigned threads) {
  auto document = formats::read_document(text, Format::gml, reading);
  if (!document) return std::move(document).error();
  const auto results = repaired_solids(*document, workers, options, threads);
  RepairedText repaired;
  repaired.outcome.features = document->features.size();
  repaired.outcome.solids = results.size();
  std::vector<formats::SolidEdit> edits;
  std::size_t first = 0;
  for (const Feature& feature : document->features) {
    const auto own = std::span(results).subspan(first, feature.solids.size());
    const Status added = add_results(feature, own, first, repaired.outcome.repairs, edits);
    if (!added) return added.error();
    first += own.size();
  }
  repaired.outcome.valid_as_read = results.size() - repaired.outcome.repairs.size();
  auto edited = formats::edit_gml(text, reading, edits);
  if (!edited) return std::move(edited).error();
  formats::ReadOptions keeping = reading;
  keeping.split_features = false;
  keeping.keep_text = true;
  auto written = formats::read_document(edited->text, Format::gml, keeping);
  if (!written) return std::move(written).error();
  repaired.document = *std::move(written);
  std::map<std::size_t, SolidRepair*> repair_of;  // by the number of the solid
  auto edit = edits.begin();
  for (SolidRepair& repair : repaired.outcome.repairs) {
    if (repair.is_repaired()) repair_of.emplace((edit++)->number, &repair);
  }
  for (const auto& [number, error] : edited->refused) {
    SolidRepair& repair = *repair_of.at(number);
    repaired.document.notes.push_back(refusal_note(repair, error));
    const std::set<int> codes = repair.summary.codes_before;
    repair.summary = {};
    repair.summary.codes_before = codes;
  }
  return repaired;
}

}  // namespace

Result<RepairedText> repair_text(ByteView text, Format from, Format to,
                                 formats::ReadOptions reading, delaunay::EngineWorkers* workers,
                                 const repair::RepairOptions& options, unsigned threads) {
  reading.split_features = false;
  if (from == Format::gml && to == Format::gml) {
    return repair_gml(text, reading, workers, options, threads);
  }
  const auto is_city = [](Format format) {
    return format == Format::city_json || format == Format::city_json_seq;
  };
  reading.keep_text = is_city(from) || (from == Format::gml && is_city(to));
  auto document = read_to_convert(text, from, to, reading);
  if (!document) return std::move(document).error();
  RepairedText repaired{*std::move(document), {}};
  auto outcome = repair_document(repaired.document, workers, options, threads);
  if (!outcome) return std::move(outcome).error();
  repaired.outcome = *std::move(outcome);
  return repaired;
}

}  // namespace watertight::pipeline
