// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reports as answers. Internal to server/.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "formats/feature_reader.h"
#include "pipeline/repaired/repair_document.h"
#include "report/feature_report.h"
#include "server/handlers.h"

namespace watertight::server {

using report::ReportForm;

/// The kind that a client wants by the Accept header, or by the value of `f`; nothing if there is
/// none such.
std::optional<ReportForm> report_kind(const std::string* accept);
std::optional<ReportForm> report_kind_named(std::string_view name);
/// The value of `f` for a kind.
std::string_view name_of(ReportForm kind);

Response refuse_report_kinds();

/// A report that becomes an answer. Equal documents get equal answers, so it has no times.
class ReportAnswer {
 public:
  /// `surfaces` is the name of the rule for surfaces, "" for the default.
  ReportAnswer(const Service& service, ReportForm kind, const pipeline::IngestOptions& options,
               const std::string& surfaces);
  ReportAnswer(ReportAnswer&&) = delete;

  /// Judges all features of a document, whose name is `file`. Errors: those of the reader and of
  /// validate_stream(); limit_exceeded if the report becomes too long. After an error no further
  /// call is allowed.
  Status judge(formats::FeatureReader& reader, const std::string& file);

  /// Judges a repaired document as it is written in a format. Errors: those of validate_repaired();
  /// limit_exceeded as above.
  Status judge_repaired(const Document& document, Format format,
                        const pipeline::DocumentRepair& outcome);

  /// The answer, or the problem with it.
  Response finish() &&;

 private:
  pipeline::StreamOptions validation() const;
  Status add(const pipeline::ValidatedFeature& feature);

  const Service& service_;
  const pipeline::IngestOptions& options_;
  Response response_;
  std::unique_ptr<report::FeatureReport> report_;
};

}  // namespace watertight::server
