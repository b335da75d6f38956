// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/repaired/validate_repaired.h"

#include <utility>

#include "pipeline/repaired/repair_notes.h"

namespace watertight::pipeline {

Status validate_repaired(const Document& document, Format format,
                         const formats::ReadOptions& reading, const DocumentRepair& outcome,
                         delaunay::EngineWorkers* workers, const StreamOptions& validation,
                         const FeatureSink& on_feature) {
  const auto text = convert_document(document, format);
  if (!text) return text.error();
  auto written = formats::read_document(*text, format, reading);
  if (!written) return std::move(written).error();
  auto reader = formats::FeatureReader::of(*std::move(written));
  const RepairNotes notes(outcome.repairs);
  const auto validated = validate_stream(
      reader, workers, validation,
      [&](ValidatedFeature&& feature) {
        notes.add_to(feature.inspected);
        return on_feature(std::move(feature));
      },
      [](const Error& error) -> Status { return error; });
  if (!validated) return validated.error();
  return Done{};
}

}  // namespace watertight::pipeline
