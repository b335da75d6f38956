// SPDX-License-Identifier: GPL-3.0-or-later
//
// write_reports json|geojson|html FILE...: prints the report of some documents, without engines and
// times. For tests of the form of reports.
#include <cstdio>

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
  const auto report = kind == "json"      ? report::json_report(sink, head)
                      : kind == "geojson" ? report::geojson_report(sink, head)
                                          : report::html_report(sink, head);
  for (int i = 2; i < count; ++i) {
    if (!add_document(*report, arguments[i])) return 1;
  }
  return report->finish() ? 0 : 1;
}
