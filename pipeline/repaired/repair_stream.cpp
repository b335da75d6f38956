// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/repaired/repair_stream.h"

#include <memory>
#include <string>
#include <utility>

#include "formats/city_json/city_json.h"
#include "pipeline/streaming/feature_stream.h"

namespace watertight::pipeline {
namespace {

/// A feature after its repair.
struct RepairedLine {
  std::string text;
  std::uint64_t solids = 0;
  std::vector<SolidRepair> repairs;
};

Result<RepairedLine> repaired_line(const formats::CityHeader& header, std::string_view line,
                                   Feature feature, delaunay::EngineWorkers* workers,
                                   const repair::RepairOptions& options) {
  auto repairs = repair_feature(feature, workers, options);
  if (!repairs) return std::move(repairs).error();
  RepairedLine result{std::string(line), feature.solids.size(), *std::move(repairs)};
  if (std::ranges::any_of(result.repairs, &SolidRepair::is_repaired)) {
    auto text = formats::write_city_json_feature(header, feature);
    if (!text) return std::move(text).error();
    result.text = *std::move(text);
  }
  result.text += '\n';
  return result;
}

}  // namespace

Result<DocumentRepair> repair_stream(formats::FeatureReader& reader,
                                     delaunay::EngineWorkers* workers,
                                     const repair::RepairOptions& options, std::size_t threads,
                                     const TextSink& sink) {
  const std::string& header_line = reader.document().header;
  const auto header = formats::read_city_json_header(header_line);
  if (!header) return header.error();
  if (const Status begun = sink(header_line + "\n"); !begun) return begun.error();
  DocumentRepair outcome;
  const FeatureWork work = [&](std::uint64_t, const formats::FeatureText& text,
                               Result<Feature> feature) -> Delivery {
    if (!feature) return [error = std::move(feature).error()]() -> Status { return error; };
    auto line = repaired_line(*header, text.line, *std::move(feature), workers, options);
    if (!line) return [error = std::move(line).error()]() -> Status { return error; };
    const auto taken = std::make_shared<RepairedLine>(*std::move(line));
    return [&outcome, &sink, taken]() -> Status {
      ++outcome.features;
      outcome.solids += taken->solids;
      outcome.valid_as_read += taken->solids - taken->repairs.size();
      for (SolidRepair& repair : taken->repairs) outcome.repairs.push_back(std::move(repair));
      return sink(taken->text);
    };
  };
  const FeatureStreamOptions stream{threads, options.certify.ladder.cancel, {}, nullptr};
  const auto count = stream_features(reader, stream, work);
  if (!count) return count.error();
  return outcome;
}

}  // namespace watertight::pipeline
