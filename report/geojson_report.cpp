// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.h"
#include "report/feature_report.h"
#include "report/place.h"
#include "report/tally.h"
#include "validate/finding_kinds.h"

namespace watertight::report {
namespace {

class GeoJsonReport final : public FeatureReport {
 public:
  GeoJsonReport(TextSink sink, ReportHead head) : sink_(std::move(sink)), head_(std::move(head)) {}

  Status begin_document(const DocumentHead& document) override {
    file_ = document.file;
    return Done{};
  }

  Status add(const pipeline::ValidatedFeature& feature) override {
    const Feature& source = feature.inspected.feature;
    const std::uint32_t srid =
        source.srid != 0 || source.solids.empty() ? source.srid : source.solids[0].solid.srid();
    std::string text;
    for (const PlacedFinding& placed : findings_of(feature.inspected)) {
      if (!is_open_) text += opening(srid);
      if (has_features_) text += ",\n";
      has_features_ = true;
      text += finding_feature(feature.inspected, placed, srid);
    }
    return text.empty() ? Status(Done{}) : sink_(text);
  }

  Status add_error(const Error& error) override {
    std::string text;
    if (!is_open_) text += opening(0);
    if (has_features_) text += ",\n";
    has_features_ = true;
    const int code = code_of(error);
    JsonText json;
    json.open('{').key("type").value("Feature").key("geometry").raw("null");
    json.key("properties").open('{').key("file").value(file_).key("code").value(code);
    json.key("name").value(name_of(code)).key("severity").value("error");
    json.key("detail").value(error.message).key("pointer").value(error.pointer);
    json.close('}').close('}');
    text += json.take();
    return sink_(text);
  }

  Status end_document(const DocumentEnd& /*end*/) override { return Done{}; }

  Status finish() override { return sink_((is_open_ ? "" : opening(0)) + "\n]}\n"); }

 private:
  /// The text before the first finding. The reference system of the layer is that of this finding.
  std::string opening(std::uint32_t srid) {
    is_open_ = true;
    srid_ = srid;
    JsonText json;
    json.open('{').key("type").value("FeatureCollection").key("name").value("findings");
    if (srid != 0) {
      json.key("crs").open('{').key("type").value("name").key("properties").open('{');
      json.key("name").value(crs_name(srid)).close('}').close('}');
    }
    json.key("program").value("watertight " + head_.program_version);
    json.key("features").open('[');
    return json.take() + "\n";
  }

  std::string finding_feature(const pipeline::InspectedFeature& feature,
                              const PlacedFinding& placed, std::uint32_t srid) const {
    const auto point = point_of(feature, placed);
    JsonText json;
    json.open('{').key("type").value("Feature").key("geometry");
    // A layer has one reference system: points of another one would be drawn elsewhere.
    if (point && srid == srid_) {
      json.open('{').key("type").value("Point").key("coordinates").value(*point).close('}');
    } else {
      json.raw("null");
    }
    json.key("properties").open('{');
    write_properties(json, feature, placed);
    if (srid != srid_) json.key("crs").value(crs_name(srid));
    if (srid != srid_ && point) json.key("coordinates").value(*point);
    return json.close('}').close('}').take();
  }

  void write_properties(JsonText& json, const pipeline::InspectedFeature& feature,
                        const PlacedFinding& placed) const {
    const Finding& finding = *placed.finding;
    const validate::FindingKind* kind = validate::find_kind(finding.code);
    json.key("file").value(file_).key("feature").value(feature.feature.id);
    json.key("code").value(finding.code).key("name").value(validate::finding_name(finding.code));
    json.key("severity").value(validate::to_string(finding.severity));
    write_solid(json, feature, placed);
    json.key("detail").value(finding.detail);
    write_number(json, "measured", finding.measured);
    write_number(json, "limit", finding.limit);
    json.key("unit").value(finding.unit);
    json.key("hint").value(kind == nullptr ? std::string_view{} : kind->hint);
    json.key("is_repairable").value(kind != nullptr && kind->is_repairable);
    json.key("uncertain").value(finding.uncertain);
    json.key("pointer").value(pointer_of(feature, placed.solid, finding.place));
    if (!finding.source.polygon.empty()) json.key("polygon").value(finding.source.polygon);
    if (!finding.source.ring.empty()) json.key("ring").value(finding.source.ring);
    if (finding.source.line != 0) json.key("line").value(finding.source.line);
    const bool has_other = finding.other.has_value();
    json.key("other_pointer");
    json.value(has_other ? pointer_of(feature, placed.other_solid, *finding.other) : "");
  }

  static void write_solid(JsonText& json, const pipeline::InspectedFeature& feature,
                          const PlacedFinding& placed) {
    const bool has_solid = placed.solid < feature.solids.size();
    const SolidSource none;
    const SolidSource& source = has_solid ? feature.solids[placed.solid].source : none;
    json.key("object").value(source.object_id).key("lod").value(source.lod);
    json.key("geometry").value(source.geometry).key("solid").value(source.ordinal);
  }

  static void write_number(JsonText& json, std::string_view name,
                           const std::optional<double>& number) {
    json.key(name);
    if (number) {
      json.value(*number);
    } else {
      json.raw("null");
    }
  }

  TextSink sink_;
  ReportHead head_;
  std::string file_;
  std::uint32_t srid_ = 0;
  bool is_open_ = false;
  bool has_features_ = false;
};

}  // namespace

std::unique_ptr<FeatureReport> geojson_report(TextSink sink, ReportHead head) {
  return std::make_unique<GeoJsonReport>(std::move(sink), std::move(head));
}

}  // namespace watertight::report
