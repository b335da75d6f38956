// SPDX-License-Identifier: GPL-3.0-or-later
//
// Encodes features for the store, and decodes them. The skeleton of an EncodedFeature is that of
// the feature and, if the feature has a layout, a line feed and the layout. Before them stand a
// line "unproven <solid> <line of write_unproven>" for each solid that is not proven, and a line
// "merged <solid> <line of describe_merge>" for each proven solid with equal vertices.
#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "formats/city_json/city_json.h"
#include "formats/geo_json/other_vertices.h"
#include "packing/feature_text.h"
#include "packing/text_dictionary.h"
#include "pipeline/outcome_json.h"
#include "pipeline/pipeline.h"
#include "pipeline/stored/feature_facts.h"
#include "pipeline/stored/merged_vertices.h"
#include "pipeline/stored/solid_lines.h"
#include "pipeline/stored/solid_page.h"
#include "pipeline/stored/stored_reports.h"
#include "pipeline/stored/unproven_solid.h"
#include "validate/report_json.h"

namespace watertight::pipeline {
namespace {

void include(std::optional<store::StoredBox>& box, const std::array<double, 3>& low,
             const std::array<double, 3>& high) {
  if (!box) box = store::StoredBox{low, high};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box->min[axis] = std::min(box->min[axis], low[axis]);
    box->max[axis] = std::max(box->max[axis], high[axis]);
  }
}

void include(std::optional<store::StoredBox>& box, const Solid& solid) {
  const Box lattice_box = solid.box();
  if (lattice_box.is_empty()) return;
  include(box, solid.lattice().world(lattice_box.min), solid.lattice().world(lattice_box.max));
}

bool is_proven(const InspectedSolid& solid) {
  return solid.inspection.report.verdict == Verdict::valid && solid.inspection.certified;
}

/// A solid without its blob.
StoredSolid described(const InspectedSolid& solid, const Solid& submitted) {
  StoredSolid stored;
  stored.object_id = solid.source.object_id;
  stored.geometry = solid.source.geometry;
  stored.ordinal = solid.source.ordinal;
  stored.lod = solid.source.lod;
  stored.is_proven = is_proven(solid);
  const Report& report = solid.inspection.report;
  if (report.measures) stored.measures = measures_json(*report.measures);
  validate::ReportJsonOptions json;
  json.pointer_prefix = solid.source.pointer;
  json.has_shells = !formats::is_surface(solid.source);
  json.include_times = false;
  stored.report = validate::report_json(report, submitted, json);
  return stored;
}

Result<Bytes> blob_of(const validate::Certified& certified, EncodeOptions options,
                      SteinerVertices steiner) {
  if (steiner == SteinerVertices::keep && certified.certificate) {
    options.certificate = &*certified.certificate;
  }
  return encode(certified.solid, options);
}

std::string line_of(std::string_view start, std::size_t solid, const std::string& text) {
  std::string line(start);
  line.append(std::to_string(solid)).append(" ").append(text) += '\n';
  return line;
}

Result<Solid> source_of(Solid merged, std::string_view line, const Limits& limits) {
  if (line.empty()) return merged;
  return unmerge(merged, line, limits);
}

/// Says that defects were found which the decoded solids alone do not show, so that nobody takes
/// the feature for proven who does not read its text.
formats::UnreadablePart mark_of(const EncodedFeature& encoded) {
  formats::UnreadablePart mark;
  mark.source.object_id = encoded.id;
  mark.error = {ErrorCode::malformed,
                "marked as not proven when it was encoded: defects between its solids, or parts "
                "that cannot be read; decode and validate the document to see them"};
  return mark;
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
  encoded.findings = feature_findings_json(feature);
  encoded.has_findings = !encoded.findings.empty();
  EncodeOptions encode_options = options.encode;
  if (!is_exact) encode_options.keep_order = false;
  for (std::size_t i = 0; i < feature.own; ++i) {
    const InspectedSolid& inspected = feature.solids[i];
    const Solid& submitted = feature.feature.solids[i].solid;
    StoredSolid& stored = encoded.solids.emplace_back(described(inspected, submitted));
    const std::string& repair = feature.feature.solids[i].repair;
    if (!repair.empty()) encoded.skeleton += line_of(packing::kRepairedLine, i, repair);
    if (!stored.is_proven) {
      include(encoded.box, submitted);
      encoded.skeleton += line_of(packing::kUnprovenLine, i, write_unproven(submitted));
      continue;
    }
    auto blob = blob_of(*inspected.inspection.certified, encode_options, options.steiner);
    if (!blob) {
      Error error = std::move(blob).error();
      if (error.pointer.empty()) error.pointer = inspected.source.pointer;
      return error;
    }
    stored.blob = *std::move(blob);
    const Solid& certified = inspected.inspection.certified->solid.solid();
    include(encoded.box, certified);
    auto merge = describe_merge(submitted, certified);
    if (!merge) return std::move(merge).error();
    if (is_exact && !merge->empty()) encoded.skeleton += line_of(packing::kMergedLine, i, *merge);
  }
  if (!is_exact) {
    if (feature.feature.skeleton.empty()) return encoded;
    Feature own = feature.feature;  // without the solids that inspect() has added
    own.solids.erase(own.solids.begin() + static_cast<std::ptrdiff_t>(feature.own),
                     own.solids.end());
    auto skeleton = formats::canonical_skeleton(own, options.contract);
    if (!skeleton) return std::move(skeleton).error();
    encoded.skeleton += *skeleton;
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
  auto decoded = decode_solids(feature, limits);
  if (!decoded) return std::move(decoded).error();
  std::vector<Solid> solids;
  for (Decoded& one : *decoded) solids.push_back(std::move(one.solid));
  return decode_feature(feature, std::move(solids), limits);
}

Result<Document> decode_feature(const EncodedFeature& encoded, std::vector<Solid> solids,
                                const Limits& limits) {
  const auto proven = std::count_if(encoded.solids.begin(), encoded.solids.end(),
                                    [](const StoredSolid& solid) { return solid.is_proven; });
  if (solids.size() != static_cast<std::size_t>(proven)) {
    return Error{ErrorCode::malformed, "a stored feature of another number of solids"};
  }
  auto format = formats::format_named(encoded.format);
  if (!format) return std::move(format).error();
  std::string_view skeleton = encoded.skeleton;
  const auto lines = take_solid_lines(skeleton, encoded.solids.size());
  if (!lines) return lines.error();
  Feature feature;
  feature.id = encoded.id;
  feature.type = encoded.type;
  feature.srid = encoded.srid;
  if (!encoded.findings.empty()) feature.unreadable.push_back(mark_of(encoded));
  const std::size_t end = std::min(skeleton.find('\n'), skeleton.size());
  feature.skeleton = std::string(skeleton.substr(0, end));
  const ByteView layout = as_bytes(skeleton.substr(std::min(end + 1, skeleton.size())));
  feature.layout.assign(layout.begin(), layout.end());
  auto next_proven = solids.begin();
  for (std::size_t i = 0; i < encoded.solids.size(); ++i) {
    const StoredSolid& solid = encoded.solids[i];
    SolidSource source;
    source.object_id = solid.object_id;
    source.lod = solid.lod;
    source.geometry = solid.geometry;
    source.ordinal = solid.ordinal;
    auto whole = solid.is_proven ? source_of(std::move(*next_proven++), (*lines)[i].merged, limits)
                                 : read_unproven((*lines)[i].unproven, limits);
    if (!whole) return std::move(whole).error();
    feature.solids.push_back(SubmittedSolid{*std::move(whole), std::move(source), {}});
    feature.solids.back().repair = (*lines)[i].repaired;
  }
  Document document;
  document.format = *format;
  document.header = encoded.header;
  document.features.push_back(std::move(feature));
  return document;
}

std::string_view model_text(const EncodedFeature& feature) {
  return packing::model_line(feature.skeleton);
}

std::map<std::string, std::uint64_t> other_geometries(const EncodedFeature& feature) {
  return formats::other_geometries(model_text(feature));
}

std::vector<std::string> ids_of(const EncodedFeature& feature) {
  std::vector<std::string> ids{feature.id};
  for (std::string& id : formats::object_ids(model_text(feature))) ids.push_back(std::move(id));
  for (const StoredSolid& solid : feature.solids) ids.push_back(solid.object_id);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::erase(ids, std::string());
  return ids;
}

Result<std::optional<store::StoredBox>> box_of(const EncodedFeature& feature,
                                               std::span<const Decoded> solids,
                                               const Limits& limits) {
  std::optional<store::StoredBox> box;
  for (const Decoded& decoded : solids) include(box, decoded.solid);
  std::string_view skeleton = feature.skeleton;
  const auto lines = take_solid_lines(skeleton, feature.solids.size());
  if (!lines) return lines.error();
  for (std::size_t i = 0; i < feature.solids.size(); ++i) {
    if (feature.solids[i].is_proven) continue;
    const auto solid = read_unproven((*lines)[i].unproven, limits);
    if (!solid) return solid.error();
    include(box, *solid);
  }
  return box;
}

std::string stored_text(const EncodedFeature& feature) {
  return packing::with_marks(report_lines(feature) + feature.skeleton, feature.id);
}

Result<StoredFeature> pack(EncodedFeature feature, const packing::DictionaryPointer& dictionary) {
  const std::string text = stored_text(feature);
  return pack(text, std::move(feature), dictionary);
}

namespace {

/// The transform in a header. Features of one document follow one another, so that the last one is
/// kept.
const std::optional<geometry::Transform>& transform_of(const SharedText& header) {
  thread_local SharedText known;
  thread_local std::optional<geometry::Transform> transform;
  if (header != known) {
    known = header;
    transform.reset();
    const auto read = formats::read_city_json_header(header);
    if (read) transform = read->transform;
  }
  return transform;
}

/// Extends the box by what the feature has besides solids, so that searches find all of it.
void include_others(EncodedFeature& feature) {
  const std::string_view model = model_text(feature);
  if (model.empty()) return;
  const auto others = formats::ranges_of_other_vertices(model, transform_of(feature.header));
  if (others) include(feature.box, others->min, others->max);
}

}  // namespace

Result<StoredFeature> pack(const std::string& text, EncodedFeature feature,
                           const packing::DictionaryPointer& dictionary) {
  include_others(feature);
  auto packed = packing::pack(text, dictionary.get());
  if (!packed) return std::move(packed).error();
  if (Status put = put_in_page(feature); !put) return std::move(put).error();
  feature.has_findings = !feature.findings.empty();
  feature.findings.clear();
  for (StoredSolid& solid : feature.solids) {
    solid.measures.clear();
    solid.report.clear();
  }
  store::FeatureRecord& record = feature;
  return StoredFeature{std::move(record), {*std::move(packed), dictionary}};
}

Result<EncodedFeature> unpack(StoredFeature stored, const Limits& limits, Reports reports) {
  auto text =
      packing::unpack(stored.skeleton.bytes, stored.skeleton.dictionary.get(), limits.bytes);
  if (!text) return std::move(text).error();
  auto whole = packing::without_marks(*text, stored.id, limits.bytes);
  if (!whole) return std::move(whole).error();
  store::FeatureRecord& record = stored;
  EncodedFeature feature{std::move(record), *std::move(whole)};
  if (Status taken = take_report_lines(feature, reports, limits); !taken) {
    return std::move(taken).error();
  }
  return feature;
}

Result<Document> from_stored(StoredFeature stored, const Limits& limits) {
  const auto feature = unpack(std::move(stored), limits, Reports::none);
  if (!feature) return feature.error();
  return decode_feature(*feature, limits);
}

}  // namespace watertight::pipeline
