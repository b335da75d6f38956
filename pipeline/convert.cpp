// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "formats/gml/city/city.h"
#include "pipeline/pipeline.h"
#include "tessellate/without_holes.h"

namespace watertight::pipeline {
namespace {

bool has_holes(const Solid& solid) {
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    if (solid.rings_of(facet).size() > 1) return true;
  }
  return false;
}

/// A city model with its closed surfaces as solids, and the notes that it had.
Result<Document> with_surfaces_as_solids(const Document& city, formats::ReadOptions options) {
  const auto text = formats::write_document(city, Format::city_json);
  if (!text) return text.error();
  options.limits.bytes = ~0ULL;  // the GML document was within the limit
  auto again = formats::read_document(*text, Format::city_json, options);
  if (again) again->notes.insert(again->notes.begin(), city.notes.begin(), city.notes.end());
  return again;
}

}  // namespace

Result<Document> read_to_convert(ByteView bytes, Format from, Format to,
                                 formats::ReadOptions options) {
  options.split_features = false;
  const bool is_city = to == Format::city_json || to == Format::city_json_seq || to == Format::gml;
  if (from != Format::gml || !is_city) return formats::read_document(bytes, from, options);
  auto city = formats::city_model_of_gml(bytes, options.limits);
  if (!city) return std::move(city).error();
  if (options.surfaces != formats::Surfaces::as_solids) return std::move(city->model);
  return with_surfaces_as_solids(city->model, options);
}

Result<Bytes> convert_document(const Document& document, Format format) {
  const bool keeps_holes = format != Format::obj && format != Format::off;
  if (keeps_holes || document.format == format) return formats::write_document(document, format);
  Document converted = document;
  for (Feature& feature : converted.features) {
    for (SubmittedSolid& submitted : feature.solids) {
      if (!has_holes(submitted.solid)) continue;
      auto solid = tessellate::without_holes(submitted.solid);
      if (!solid) {
        Error error = std::move(solid).error();
        error.pointer = submitted.source.pointer;
        return error;
      }
      submitted.solid = *std::move(solid);
    }
  }
  return formats::write_document(converted, format);
}

}  // namespace watertight::pipeline
