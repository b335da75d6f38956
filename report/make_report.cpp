// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "report/feature_report.h"

namespace watertight::report {

std::unique_ptr<FeatureReport> make_report(ReportForm form, TextSink sink, ReportHead head) {
  switch (form) {
    case ReportForm::geojson:
      return geojson_report(std::move(sink), std::move(head));
    case ReportForm::html:
      return html_report(std::move(sink), std::move(head));
    case ReportForm::csv:
      return csv_report(std::move(sink));
    case ReportForm::sarif:
      return sarif_report(std::move(sink), std::move(head));
    case ReportForm::json:
      break;
  }
  return json_report(std::move(sink), std::move(head));
}

}  // namespace watertight::report
