// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/repaired/repair_stream.h"

#include <memory>
#include <string>
#include <utility>

#include "formats/city_json/city_json.h"
#include "pipeline/repaired/repair_notes.h"
#include "pipeline/streaming/feature_stream.h"

namespace watertight::pipeline {
namespace {

/// A feature after its repair.
struct RepairedLine {
  std::string text;
  std::uint64_t solids = 0;
  std::vector<SolidRepair> repairs;
};

/// Repairs the features of one sequence, and writes them.
class LineRepair {
 public:
  LineRepair(delaunay::EngineWorkers* workers, const repair::RepairOptions& options,
             const TextSink& sink)
      : workers_(workers), options_(options), sink_(sink) {}

  /// Writes the header. Errors: those of read_city_json_header() and of the sink.
  Status begin(const std::string& header_line) {
    auto header = formats::read_city_json_header(header_line);
    if (!header) return std::move(header).error();
    header_ = *std::move(header);
    return sink_(header_line + "\n");
  }

  /// Repairs a feature; the delivery writes it. Thread-safe.
  Delivery repair(std::string_view line, Feature& feature) {
    auto repaired = repaired_line(line, feature);
    if (!repaired) return [error = std::move(repaired).error()]() -> Status { return error; };
    const auto taken = std::make_shared<RepairedLine>(*std::move(repaired));
    return [this, taken] { return write(std::move(*taken)); };
  }

  DocumentRepair& outcome() { return outcome_; }
  /// The repairs of the feature that was written last.
  std::span<const SolidRepair> last_repairs() const {
    return std::span(outcome_.repairs).last(last_count_);
  }

 private:
  Result<RepairedLine> repaired_line(std::string_view line, Feature& feature) const {
    auto repairs = repair_feature(feature, workers_, options_);
    if (!repairs) return std::move(repairs).error();
    RepairedLine result{std::string(line), feature.solids.size(), *std::move(repairs)};
    if (std::ranges::any_of(result.repairs, &SolidRepair::is_repaired)) {
      auto text = formats::write_city_json_feature(header_, feature);
      if (!text) return std::move(text).error();
      result.text = *std::move(text);
    }
    result.text += '\n';
    return result;
  }

  Status write(RepairedLine line) {
    ++outcome_.features;
    outcome_.solids += line.solids;
    outcome_.valid_as_read += line.solids - line.repairs.size();
    last_count_ = line.repairs.size();
    for (SolidRepair& repair : line.repairs) outcome_.repairs.push_back(std::move(repair));
    return sink_(line.text);
  }

  delaunay::EngineWorkers* workers_;
  const repair::RepairOptions& options_;
  const TextSink& sink_;
  formats::CityHeader header_;
  DocumentRepair outcome_;  // only deliveries change it
  std::size_t last_count_ = 0;
};

}  // namespace

Result<DocumentRepair> repair_stream(formats::FeatureReader& reader,
                                     delaunay::EngineWorkers* workers,
                                     const repair::RepairOptions& options, std::size_t threads,
                                     const TextSink& sink) {
  LineRepair lines(workers, options, sink);
  if (Status begun = lines.begin(reader.document().header); !begun) return begun.error();
  const FeatureWork work = [&](std::uint64_t, const formats::FeatureText& text,
                               Result<Feature> feature) -> Delivery {
    if (!feature) return [error = std::move(feature).error()]() -> Status { return error; };
    return lines.repair(text.line, *feature);
  };
  const FeatureStreamOptions stream{threads, options.certify.ladder.cancel, {}, nullptr};
  const auto count = stream_features(reader, stream, work);
  if (!count) return count.error();
  return std::move(lines.outcome());
}

Result<DocumentRepair> repair_and_validate(formats::FeatureReader& reader,
                                           delaunay::EngineWorkers* workers,
                                           const repair::RepairOptions& options,
                                           const StreamOptions& validation, const TextSink& sink,
                                           const FeatureSink& on_feature) {
  LineRepair lines(workers, options, sink);
  if (Status begun = lines.begin(reader.document().header); !begun) return begun.error();
  StreamOptions stream = validation;
  stream.prepare = [&](const formats::FeatureText& text, Feature& feature) {
    return lines.repair(text.line, feature);
  };
  const auto validated = validate_stream(
      reader, workers, stream,
      [&](ValidatedFeature&& feature) {
        RepairNotes(lines.last_repairs()).add_to(feature.inspected);
        return on_feature(std::move(feature));
      },
      [](const Error& error) -> Status { return error; });
  if (!validated) return validated.error();
  return std::move(lines.outcome());
}

}  // namespace watertight::pipeline
