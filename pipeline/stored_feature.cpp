// SPDX-License-Identifier: GPL-3.0-or-later
//
// Encodes features for the store, and decodes them. The skeleton of an EncodedFeature is that of
// the feature and, if the feature has a layout, a line feed and the layout. Before them stands one
// line "merged <solid> <line of describe_merge>" for each solid with equal vertices.
#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "formats/city_json/city_json.h"
#include "formats/text/packed_text.h"
#include "pipeline/merged_vertices.h"
#include "pipeline/outcome_json.h"
#include "pipeline/pipeline.h"
#include "validate/report_json.h"

namespace watertight::pipeline {
namespace {

constexpr std::string_view kMergedLine = "merged ";

void include(std::optional<store::StoredBox>& box, const Solid& solid) {
  const Box lattice_box = solid.box();
  if (lattice_box.is_empty()) return;
  const std::array<double, 3> low = solid.lattice().world(lattice_box.min);
  const std::array<double, 3> high = solid.lattice().world(lattice_box.max);
  if (!box) box = store::StoredBox{low, high};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box->min[axis] = std::min(box->min[axis], low[axis]);
    box->max[axis] = std::max(box->max[axis], high[axis]);
  }
}

Result<StoredSolid> store_solid(const InspectedSolid& solid, const Solid& submitted,
                                EncodeOptions options, SteinerVertices steiner) {
  const Inspection& inspection = solid.inspection;
  if (inspection.report.verdict != Verdict::valid || !inspection.certified) {
    return Error{ErrorCode::invalid_argument, "only valid solids are stored"};
  }
  if (steiner == SteinerVertices::keep && inspection.certified->certificate) {
    options.certificate = &*inspection.certified->certificate;
  }
  auto blob = encode(inspection.certified->solid, options);
  if (!blob) return std::move(blob).error();
  StoredSolid stored;
  stored.object_id = solid.source.object_id;
  stored.geometry = solid.source.geometry;
  stored.ordinal = solid.source.ordinal;
  stored.lod = solid.source.lod;
  stored.blob = *std::move(blob);
  if (inspection.report.measures) stored.measures = measures_json(*inspection.report.measures);
  validate::ReportJsonOptions json;
  json.pointer_prefix = solid.source.pointer;
  json.include_times = false;
  stored.report = validate::report_json(inspection.report, submitted, json);
  return stored;
}

/// Takes the merge lines off the front of a stored skeleton; a solid without such a line gets "".
Result<std::vector<std::string_view>> take_merge_lines(std::string_view& skeleton,
                                                       std::size_t solids) {
  std::vector<std::string_view> lines(solids);
  while (skeleton.starts_with(kMergedLine)) {
    const std::size_t end = skeleton.find('\n');
    std::string_view line = skeleton.substr(kMergedLine.size(), end - kMergedLine.size());
    std::size_t solid = 0;
    const auto [rest, error] = std::from_chars(line.data(), line.data() + line.size(), solid);
    if (end == std::string_view::npos || error != std::errc{} || solid >= solids ||
        rest == line.data() + line.size()) {
      return Error{ErrorCode::malformed, "stored vertex merge: the line has no number of a solid"};
    }
    lines[solid] = line.substr(static_cast<std::size_t>(rest - line.data()) + 1);
    skeleton.remove_prefix(end + 1);
  }
  return lines;
}

}  // namespace

Result<EncodedFeature> encode_feature(const InspectedFeature& feature, const Document& document,
                                      const FeatureEncoding& options) {
  const bool is_exact = options.contract == formats::Contract::exact;
  EncodedFeature encoded;
  encoded.collection = options.collection;
  encoded.id = feature.feature.id;
  encoded.type = feature.feature.type;
  encoded.srid = feature.feature.srid;
  encoded.format = std::string(formats::to_string(document.format));
  encoded.header = document.header;
  EncodeOptions encode_options = options.encode;
  if (!is_exact) encode_options.keep_order = false;
  for (std::size_t i = 0; i < feature.solids.size(); ++i) {
    const InspectedSolid& inspected = feature.solids[i];
    auto solid =
        store_solid(inspected, feature.feature.solids[i].solid, encode_options, options.steiner);
    if (!solid) {
      Error error = std::move(solid).error();
      if (error.pointer.empty()) error.pointer = inspected.source.pointer;
      return error;
    }
    encoded.solids.push_back(*std::move(solid));
    const Solid& certified = inspected.inspection.certified->solid.solid();
    include(encoded.box, certified);
    auto merge = describe_merge(feature.feature.solids[i].solid, certified);
    if (!merge) return std::move(merge).error();
    if (!is_exact || merge->empty()) continue;
    encoded.skeleton += std::string(kMergedLine) + std::to_string(i) + ' ' + *merge + '\n';
  }
  if (!is_exact) {
    if (feature.feature.skeleton.empty()) return encoded;
    auto skeleton = formats::canonical_skeleton(feature.feature, options.contract);
    if (!skeleton) return std::move(skeleton).error();
    encoded.skeleton = *std::move(skeleton);
    return encoded;
  }
  encoded.skeleton += feature.feature.skeleton;
  if (!feature.feature.layout.empty()) {
    encoded.skeleton += '\n';
    encoded.skeleton += as_text(feature.feature.layout);
  }
  return encoded;
}

Result<Document> decode_feature(const EncodedFeature& feature, const Limits& limits) {
  std::vector<Solid> solids;
  for (const StoredSolid& solid : feature.solids) {
    auto decoded = decode(solid.blob, limits);
    if (!decoded) return std::move(decoded).error();
    solids.push_back(std::move(decoded->solid));
  }
  return decode_feature(feature, std::move(solids), limits);
}

Result<Document> decode_feature(const EncodedFeature& encoded, std::vector<Solid> solids,
                                const Limits& limits) {
  if (solids.size() != encoded.solids.size()) {
    return Error{ErrorCode::malformed, "a stored feature of another number of solids"};
  }
  auto format = formats::format_named(encoded.format);
  if (!format) return std::move(format).error();
  std::string_view skeleton = encoded.skeleton;
  auto merges = take_merge_lines(skeleton, encoded.solids.size());
  if (!merges) return std::move(merges).error();
  Feature feature;
  feature.id = encoded.id;
  feature.type = encoded.type;
  feature.srid = encoded.srid;
  const std::size_t end = std::min(skeleton.find('\n'), skeleton.size());
  feature.skeleton = std::string(skeleton.substr(0, end));
  const ByteView layout = as_bytes(skeleton.substr(std::min(end + 1, skeleton.size())));
  feature.layout.assign(layout.begin(), layout.end());
  for (std::size_t i = 0; i < encoded.solids.size(); ++i) {
    const StoredSolid& solid = encoded.solids[i];
    SolidSource source;
    source.object_id = solid.object_id;
    source.lod = solid.lod;
    source.geometry = solid.geometry;
    source.ordinal = solid.ordinal;
    const std::string_view merge = (*merges)[i];
    auto whole =
        merge.empty() ? Result<Solid>(std::move(solids[i])) : unmerge(solids[i], merge, limits);
    if (!whole) return std::move(whole).error();
    feature.solids.push_back(SubmittedSolid{*std::move(whole), std::move(source), {}});
  }
  Document document;
  document.format = *format;
  document.header = encoded.header;
  document.features.push_back(std::move(feature));
  return document;
}

Result<StoredFeature> pack(EncodedFeature feature) {
  auto skeleton = formats::pack_text(feature.skeleton);
  if (!skeleton) return std::move(skeleton).error();
  store::FeatureRecord& record = feature;
  return StoredFeature{std::move(record), *std::move(skeleton)};
}

Result<EncodedFeature> unpack(StoredFeature stored, const Limits& limits) {
  auto skeleton = formats::unpack_text(stored.skeleton.bytes, limits.bytes);
  if (!skeleton) return std::move(skeleton).error();
  store::FeatureRecord& record = stored;
  return EncodedFeature{std::move(record), *std::move(skeleton)};
}

Result<Document> from_stored(StoredFeature stored, const Limits& limits) {
  const auto feature = unpack(std::move(stored), limits);
  if (!feature) return feature.error();
  return decode_feature(*feature, limits);
}

}  // namespace watertight::pipeline
