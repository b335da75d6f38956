// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/documents/report_answer.h"

#include <array>

#include "pipeline/repaired/validate_repaired.h"
#include "pipeline/validate_stream.h"
#include "server/metrics/metrics.h"

namespace watertight::server {
namespace {

struct KindName {
  std::string_view parameter;  // value of f=
  std::string_view type;
};

constexpr std::array<KindName, 5> kKinds{{{"json", kJson},
                                          {"geojson", kGeoJson},
                                          {"html", kHtml},
                                          {"csv", "text/csv"},
                                          {"sarif", "application/sarif+json"}}};

/// Counts the judged solids of a feature and the findings between them.
void count(Metrics* metrics, const pipeline::InspectedFeature& feature) {
  if (metrics == nullptr) return;
  for (std::size_t i = 0; i < feature.own; ++i) metrics->count(feature.solids[i].inspection.report);
  for (const pipeline::InspectedGroup& group : feature.groups) {
    metrics->count(group.report.findings);
  }
}

std::string type_of(ReportForm kind) {
  std::string type(kKinds[static_cast<std::size_t>(kind)].type);
  return type.starts_with("text/") ? type.append("; charset=utf-8") : type;
}

}  // namespace

std::optional<ReportForm> report_kind(const std::string* accept) {
  std::vector<std::string_view> offers;
  for (const KindName& kind : kKinds) offers.push_back(kind.type);
  const auto chosen = negotiate(accept, offers);
  return chosen ? std::optional(static_cast<ReportForm>(*chosen)) : std::nullopt;
}

std::optional<ReportForm> report_kind_named(std::string_view name) {
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    if (kKinds[i].parameter == name) return static_cast<ReportForm>(i);
  }
  return std::nullopt;
}

std::string_view name_of(ReportForm kind) {
  return kKinds[static_cast<std::size_t>(kind)].parameter;
}

Response refuse_report_kinds() {
  return refuse(406, "not-acceptable",
                "the report is available as application/json, application/geo+json, text/html, "
                "text/csv and application/sarif+json");
}

ReportAnswer::ReportAnswer(const Service& service, ReportForm kind,
                           const pipeline::IngestOptions& options, const std::string& surfaces)
    : service_(service), options_(options), response_{200, type_of(kind), {}, {}} {
  report::ReportHead head;
  head.program_version = WATERTIGHT_VERSION;
  head.acceptance = {options.certify.tolerances, options.certify.proof, geometry::kRuleSet};
  head.overlap_metres = options.groups.overlap_metres;
  head.is_strict = options.certify.ladder.strict;
  head.surfaces = surfaces;
  head.repair = options.repair;
  report_ = report::make_report(
      kind,
      [this, longest = service.options.longest_report](std::string_view text) -> Status {
        if (response_.body.size() + text.size() > longest) {
          return Error{ErrorCode::limit_exceeded,
                       "the report is longer than " + std::to_string(longest) +
                           " bytes; validate the document in parts, or with the command line"};
        }
        response_.body += text;
        return Done{};
      },
      std::move(head));
}

pipeline::StreamOptions ReportAnswer::validation() const {
  pipeline::StreamOptions stream;
  stream.certify = options_.certify;
  stream.groups = options_.groups;
  stream.groups.limits = options_.certify.limits;
  stream.groups.cancel = options_.certify.ladder.cancel;
  stream.threads = options_.threads;
  stream.is_cancelled = options_.is_cancelled;
  return stream;
}

Status ReportAnswer::add(const pipeline::ValidatedFeature& feature) {
  count(service_.metrics, feature.inspected);
  return report_->add(feature);
}

Status ReportAnswer::judge(formats::FeatureReader& reader, const std::string& file) {
  Status status = report_->begin_document({file, reader.document().format});
  if (!status) return status;
  const auto outcome = pipeline::validate_stream(
      reader, service_.workers, validation(),
      [&](pipeline::ValidatedFeature&& feature) { return add(feature); },
      [](const Error& error) -> Status { return error; });
  if (!outcome) return outcome.error();
  return report_->end_document({reader.document().notes, 0});
}

Status ReportAnswer::judge_repaired(const Document& document, Format format,
                                    const pipeline::DocumentRepair& outcome) {
  Status status = report_->begin_document({"request body", format});
  if (!status) return status;
  status = pipeline::validate_repaired(
      document, format, {options_.certify.limits}, outcome, service_.workers, validation(),
      [&](pipeline::ValidatedFeature&& feature) { return add(feature); });
  return status ? report_->end_document({document.notes, 0}) : std::move(status);
}

Response ReportAnswer::finish() && {
  const Status status = report_->finish();
  return status ? std::move(response_) : to_response(to_problem(status.error()));
}

}  // namespace watertight::server
