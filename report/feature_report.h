// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reports of whole runs, written while features arrive: the JSON report (a superset of val3dity's),
// the GeoJSON layer of findings, the CSV table, the SARIF log and the HTML page. For command line
// and service. All are described in docs/report.md.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/validate_stream.h"

namespace watertight::report {

/// Takes the next piece of text. An error ends the report and is returned to the report's caller.
using TextSink = std::function<Status(std::string_view)>;

/// The facts that hold for all documents of a run.
struct ReportHead {
  std::string program_version;  // "0.1.0"
  std::string time;             // when the run began, RFC 3339; "" leaves all times out
  Acceptance acceptance;
  bool is_strict = false;               // LadderOptions::strict
  double overlap_metres = 0;            // GroupOptions::overlap_metres
  bool also_tolerant = false;           // CertifyOptions::also_tolerant
  double tolerant_snap_metres = 0.001;  // CertifyOptions::tolerant_snap_metres
  std::string surfaces;                 // the rule for surfaces, "" for `check`
  /// How the document was repaired before; absent if it was not.
  std::optional<repair::RepairOptions> repair = {};
};

/// The facts about a document that are known before its features.
struct DocumentHead {
  std::string file;              // as the user named it; any bytes
  std::optional<Format> format;  // nullopt when it could not be detected
};

/// The facts about a document that are known after its features.
struct DocumentEnd {
  std::vector<std::string> notes;  // Document::notes
  double seconds = 0;              // wall time
};

/// Writes one report. Call begin_document(), then add() and add_error() in document order, then
/// end_document(); again for each further document; finish() last. One thread at a time. After an
/// error no further call is allowed. Text of documents (ids, messages) may be any bytes.
/// Cost: linear in what is added; memory is bounded, whatever the number of features.
/// Errors of all: those of the sink.
class FeatureReport {
 public:
  virtual ~FeatureReport() = default;
  virtual Status begin_document(const DocumentHead& head) = 0;
  virtual Status add(const pipeline::ValidatedFeature& feature) = 0;
  /// Adds the error of a feature, or of the rest of the document, that could not be read.
  virtual Status add_error(const Error& error) = 0;
  virtual Status end_document(const DocumentEnd& end) = 0;
  virtual Status finish() = 0;
};

/// Writes one line of JSON for each document: docs/schema/report-2.schema.json. Deterministic when
/// `head.time` is empty.
std::unique_ptr<FeatureReport> json_report(TextSink sink, ReportHead head);

/// Writes one GeoJSON FeatureCollection for all documents: a point for each finding, in the
/// coordinates of the document, whose reference system is named by the member "crs".
std::unique_ptr<FeatureReport> geojson_report(TextSink sink, ReportHead head);

/// Writes one table for all documents as CSV (RFC 4180, UTF-8): a header, then a row for each
/// finding. A text that a spreadsheet would take for a formula gets an apostrophe in front.
std::unique_ptr<FeatureReport> csv_report(TextSink sink);

/// Writes one SARIF 2.1.0 log with one run for all documents: all findings as rules, and a result
/// for each finding and for each part of a document that could not be read.
std::unique_ptr<FeatureReport> sarif_report(TextSink sink, ReportHead head);

struct HtmlOptions {
  std::size_t most_rows = 5000;     // findings in the table; the page says how many there are
  std::size_t most_pictures = 500;  // findings with a picture
  std::size_t most_pictures_per_code = 300;
  std::size_t most_facets = 160;  // the most facets in one picture, the nearest ones
};

/// Writes one page of HTML for all documents, which loads nothing else. finish() writes the page;
/// the options bound the memory until then.
std::unique_ptr<FeatureReport> html_report(TextSink sink, ReportHead head,
                                           const HtmlOptions& options = {});

/// The forms of a report.
enum class ReportForm : std::uint8_t { json, geojson, html, csv, sarif };

/// Writes a report in a form, with the usual options.
std::unique_ptr<FeatureReport> make_report(ReportForm form, TextSink sink, ReportHead head);

}  // namespace watertight::report
