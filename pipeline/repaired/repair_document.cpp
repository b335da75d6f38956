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
std::optional<Repaired> repaired(const SubmittedSolid& submitted, delaunay::EngineWorkers* workers,
                                 const repair::RepairOptions& options) {
  repair::RepairOptions own = options;
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
  std::vector<const SubmittedSolid*> solids;
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& submitted : feature.solids) solids.push_back(&submitted);
  }
  std::vector<std::optional<Repaired>> results(solids.size());
  geometry::for_each_piece(solids.size(), threads, [&](std::size_t i, bool) {
    results[i] = repaired(*solids[i], workers, options);
  });
  return results;
}

/// Puts repaired solids into their feature, and appends what became of each that is not valid.
/// `results` has an entry for each solid of the feature.
Status apply(Feature& feature, std::span<const std::optional<Repaired>> results,
             std::vector<SolidRepair>& repairs) {
  std::vector<formats::SolidEdit> edits;
  std::vector<std::pair<std::size_t, std::string>> texts;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results[i]) continue;
    const SubmittedSolid& submitted = feature.solids[i];
    repairs.push_back(
        {submitted.source, feature.id, repair::summary_of(submitted.solid, *results[i])});
    if (!results[i]->edits) continue;
    auto solid = repair::on_submitted_vertices(submitted.solid, *results[i]->edits);
    if (!solid) return std::move(solid).error();
    edits.push_back({i, std::move(solid->solid), std::move(solid->facet_source)});
    texts.emplace_back(i, repair::summary_json(repairs.back().summary));
  }
  if (edits.empty()) return Done{};
  if (const Status replaced = formats::replace_solids(feature, std::move(edits)); !replaced) {
    return replaced;
  }
  for (const auto& [solid, text] : texts) feature.solids[solid].repair = text;
  return Done{};
}

}  // namespace

Result<std::vector<SolidRepair>> repair_feature(Feature& feature, delaunay::EngineWorkers* workers,
                                                const repair::RepairOptions& options) {
  std::vector<std::optional<Repaired>> results;
  for (const SubmittedSolid& submitted : feature.solids) {
    results.push_back(repaired(submitted, workers, options));
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

/// A solid of a document that is repaired as a text.
struct NumberedSolid {
  std::size_t number = 0;  // among the solids of all features
  Feature* feature = nullptr;
  SubmittedSolid* submitted = nullptr;
};

std::vector<NumberedSolid> numbered_solids(Document& document) {
  std::vector<NumberedSolid> solids;
  for (Feature& feature : document.features) {
    for (SubmittedSolid& submitted : feature.solids) {
      solids.push_back({solids.size(), &feature, &submitted});
    }
  }
  return solids;
}

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
  std::map<std::size_t, std::size_t> repair_of;  // number of a solid -> its entry in the outcome
  for (const auto& [number, feature, submitted] : numbered_solids(*document)) {
    const std::optional<Repaired>& result = results[number];
    if (!result) continue;
    repair_of.emplace(number, repaired.outcome.repairs.size());
    repaired.outcome.repairs.push_back(
        {submitted->source, feature->id, repair::summary_of(submitted->solid, *result)});
    if (!result->edits) continue;
    auto solid = repair::on_submitted_vertices(submitted->solid, *result->edits);
    if (!solid) return std::move(solid).error();
    edits.push_back({number, std::move(solid->solid), std::move(solid->facet_source)});
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
  for (const auto& [number, error] : edited->refused) {
    SolidRepair& repair = repaired.outcome.repairs[repair_of.at(number)];
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
