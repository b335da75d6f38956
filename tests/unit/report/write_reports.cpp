// SPDX-License-Identifier: GPL-3.0-or-later
//
// write_reports json|geojson|html|repaired|repaired-html FILE...: prints the report of some
// documents, without engines and times; `repaired` the JSON report on the documents after a repair
// with all remedies, `repaired-html` the page.
// For tests of the form of reports.
#include <cstdio>

#include "pipeline/repaired/validate_repaired.h"
#include "report/feature_report.h"
#include "tests/files.h"

using namespace watertight;

namespace {

Status add_document(report::FeatureReport& report, const std::string& path) {
  const Bytes bytes = test::read_bytes(path);
  const std::string name = path.substr(path.rfind('/') + 1);
  const auto format = formats::detect_format(name, bytes);
  Status status = report.begin_document(
      {name, format ? std::optional<Format>(*format) : std::optional<Format>()});
  formats::ReadOptions reading;
  reading.surfaces = formats::Surfaces::read;
  auto document =
      format ? formats::read_document(bytes, *format, reading) : Result<Document>(format.error());
  report::DocumentEnd end;
  if (!document) {
    if (status) status = report.add_error(document.error());
    return status ? report.end_document(end) : status;
  }
  std::uint64_t number = 0;
  for (Feature& feature : document->features) {
    pipeline::ValidatedFeature validated;
    validated.number = number++;
    validated.inspected = pipeline::inspect(std::move(feature), nullptr, {});
    if (status) status = report.add(validated);
  }
  end.notes = document->notes;
  return status ? report.end_document(end) : status;
}

repair::RepairOptions all_remedies(bool has_smooth) {
  repair::RepairOptions options;
  options.remedies.assign(repair::kAllRemedies.begin(), repair::kAllRemedies.end());
  if (!has_smooth) std::erase(options.remedies, repair::Remedy::smooth);
  options.smooth.chord_metres = 0.1;
  options.weld_metres = 0.01;
  return options;
}

Status add_repaired(report::FeatureReport& report, const std::string& path,
                    const repair::RepairOptions& options) {
  const Bytes bytes = test::read_bytes(path);
  const auto format = formats::detect_format(path, bytes);
  if (!format) return format.error();
  const auto repaired = pipeline::repair_text(bytes, *format, *format, {}, nullptr, options, 1);
  if (!repaired) return repaired.error();
  Status status = report.begin_document({path.substr(path.rfind('/') + 1), *format});
  if (!status) return status;
  status = pipeline::validate_repaired(
      repaired->document, *format, {}, repaired->outcome, nullptr, {},
      [&](pipeline::ValidatedFeature&& feature) { return report.add(feature); });
  return status ? report.end_document({}) : std::move(status);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) return 2;
  const std::string kind = arguments[1];
  const report::TextSink sink = [](std::string_view text) -> Status {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return Done{};
  };
  report::ReportHead head;
  head.program_version = "0.1.0";
  const bool is_smoothed = kind.starts_with("smoothed");
  const bool is_repaired = kind.starts_with("repaired") || is_smoothed;
  if (is_repaired) head.repair = all_remedies(is_smoothed);
  const auto report = kind.ends_with("html") ? report::html_report(sink, head)
                      : kind == "geojson"    ? report::geojson_report(sink, head)
                                             : report::json_report(sink, head);
  for (int i = 2; i < count; ++i) {
    const Status added = is_repaired ? add_repaired(*report, arguments[i], *head.repair)
                                     : add_document(*report, arguments[i]);
    if (!added) return 1;
  }
  return report->finish() ? 0 : 1;
}
