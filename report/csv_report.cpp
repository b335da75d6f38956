// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.h"
#include "report/feature_report.h"
#include "report/number_text.h"
#include "report/place.h"
#include "report/tally.h"

namespace watertight::report {
namespace {

constexpr std::string_view kHeader =
    "file,feature,object,lod,geometry,solid,code,name,severity,x,y,z,measured,limit,unit,detail"
    "\r\n";

/// Text of a document as a field. A spreadsheet would take a text that begins with one of = + - @
/// for a formula, and run it: an apostrophe in front keeps it a text.
std::string text_field(std::string_view text) {
  std::string clean = utf8_text(text);
  if (!clean.empty() && std::string_view("=+-@\t").find(clean.front()) != std::string_view::npos) {
    clean.insert(0, 1, '\'');
  }
  if (clean.find_first_of(",\"\r\n") == std::string::npos) return clean;
  std::string field(1, '"');
  for (const char c : clean) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

class CsvReport final : public FeatureReport {
 public:
  explicit CsvReport(TextSink sink) : sink_(std::move(sink)) {}

  Status begin_document(const DocumentHead& document) override {
    file_ = text_field(document.file);
    return write({});
  }

  Status add(const pipeline::ValidatedFeature& feature) override {
    for (const PlacedFinding& placed : findings_of(feature.inspected)) {
      Status status = write(row(feature.inspected, placed));
      if (!status) return status;
    }
    return Done{};
  }

  Status add_error(const Error& error) override {
    const int code = code_of(error);
    std::string row = file_ + ",,,,,,";
    row += std::to_string(code);
    row.append(1, ',').append(name_of(code)).append(",error,,,,,,,");
    row += text_field(to_string(error));
    return write(row + "\r\n");
  }

  Status end_document(const DocumentEnd& /*end*/) override { return Done{}; }
  Status finish() override { return write({}); }

 private:
  /// Writes rows, after the header if it is not there yet.
  Status write(const std::string& rows) {
    std::string text = has_header_ ? std::string() : std::string(kHeader);
    has_header_ = true;
    text += rows;
    return text.empty() ? Status(Done{}) : sink_(text);
  }

  std::string row(const pipeline::InspectedFeature& feature, const PlacedFinding& placed) const {
    const Finding& finding = *placed.finding;
    std::string row = file_;
    const auto add = [&](std::string_view field) { row.append(1, ',').append(field); };
    add(text_field(feature.feature.id));
    if (placed.solid < feature.solids.size()) {
      const SolidSource& source = feature.solids[placed.solid].source;
      add(text_field(source.object_id));
      add(text_field(source.lod));
      add(std::to_string(source.geometry));
      add(std::to_string(source.ordinal));
    } else {
      row += ",,,,";
    }
    add(std::to_string(finding.code));
    add(validate::finding_name(finding.code));
    add(validate::to_string(finding.severity));
    const auto point = point_of(feature, placed);
    for (const std::string& field : point ? point_columns(*point) : std::array<std::string, 3>{}) {
      add(field);
    }
    const MeasureText measure = measure_columns(finding);
    add(measure.measured);
    add(measure.limit);
    add(text_field(measure.unit));
    add(text_field(finding.detail));
    return row + "\r\n";
  }

  TextSink sink_;
  std::string file_;
  bool has_header_ = false;
};

}  // namespace

std::unique_ptr<FeatureReport> csv_report(TextSink sink) {
  return std::make_unique<CsvReport>(std::move(sink));
}

}  // namespace watertight::report
