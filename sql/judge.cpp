// SPDX-License-Identifier: GPL-3.0-or-later
#include "sql/judge.h"

#include <string>
#include <utility>

#include "formats/ewkb.h"
#include "sql/make_value.h"
#include "validate/report_json.h"

namespace watertight::sql {
namespace {

// The most findings that a detail names; wt_validate gives the whole report.
constexpr std::size_t kFindingsShown = 20;

/// The errors of a report, one a line, the first ones only.
std::string errors_of(const Report& report) {
  std::string lines;
  std::size_t count = 0;
  for (const Finding& finding : report.findings) {
    if (finding.severity != Severity::error || ++count > kFindingsShown) continue;
    if (!lines.empty()) lines += '\n';
    lines += validate::finding_text(finding);
  }
  const std::uint64_t omitted =
      report.findings_omitted + (count > kFindingsShown ? count - kFindingsShown : 0);
  if (omitted > 0) lines += "\nand " + std::to_string(omitted) + " more";
  return lines;
}

/// Whether this program can judge by the rules that a blob states.
Status check_acceptance(const Acceptance& acceptance) {
  const Tolerances& tolerances = acceptance.tolerances;
  const auto is_within = [](double value, double least, double most) {
    return value >= least && value <= most;
  };
  if (acceptance.rule_set != geometry::kRuleSet) {
    return Error{ErrorCode::unsupported,
                 "the blob states rule set " + std::to_string(acceptance.rule_set)};
  }
  if (!is_within(tolerances.planarity_metres, WATERTIGHT_LEAST_PLANARITY,
                 WATERTIGHT_MOST_PLANARITY) ||
      !is_within(tolerances.planarity_degrees, WATERTIGHT_LEAST_ANGLE, WATERTIGHT_MOST_ANGLE) ||
      tolerances.snap_metres != 0) {
    return Error{ErrorCode::invalid_argument, "the blob states tolerances outside their ranges"};
  }
  return Done{};
}

}  // namespace

wt_rule_choice rules_of(const wt_job& job) {
  return job.rules == nullptr ? wt_default_rules() : *job.rules;
}

CertifyOptions options_of(const wt_job& job, const CallLimits& call) {
  CertifyOptions options;
  options.limits = call.of_input();
  const wt_rule_choice rules = rules_of(job);
  options.tolerances.planarity_metres = rules.planarity;
  options.tolerances.planarity_degrees = rules.planarity_angle;
  options.proof = rules.is_boundary_enough ? Proof::boundary : Proof::tetrahedralization;
  options.ladder.strict = rules.is_strict;
  options.ladder.cancel = call.poll();
  options.ladder.memory_in_engine = call.memory_bytes();
  return options;
}

std::optional<Examined> certify_read(const wt_job& job, const CallLimits& call,
                                     Result<SubmittedSolid> submitted, wt_reply* reply) {
  if (!submitted) {
    fail(reply, call.of_reading(std::move(submitted).error()));
    return std::nullopt;
  }
  CertifyOptions options = options_of(job, call);
  options.rounded = submitted->rounded;
  Inspection inspection = certify(submitted->solid, workers_of(job), options);
  if (const Status in_time = call.check(); !in_time) {
    fail(reply, in_time.error());
    return std::nullopt;
  }
  if (inspection.report.verdict == Verdict::undecided) {
    fail(reply, WATERTIGHT_UNDECIDED,
         "the solid is undecided: " + inspection.report.undecided_reason);
    return std::nullopt;
  }
  return Examined{std::move(*submitted), std::move(inspection)};
}

std::optional<Examined> examine(const wt_job& job, const CallLimits& call, wt_reply* reply) {
  return certify_read(job, call, formats::read_ewkb(bytes_of(job), call.of_input()), reply);
}

void fail_invalid(const Report& report, wt_reply* reply) {
  fail(reply, "22023", "the solid is invalid", errors_of(report));
  reply->failure.is_invalid = true;
}

std::optional<ValidSolid> judged(const wt_job& job, const CallLimits& call, const Decoded& decoded,
                                 wt_reply* reply) {
  const auto refused = [&](const Error& error) {
    fail(reply, error);
    return std::nullopt;
  };
  const Acceptance& acceptance = decoded.info.acceptance;
  if (const Status checked = check_acceptance(acceptance); !checked) {
    return refused(checked.error());
  }
  CertifyOptions options = options_of(job, call);
  options.tolerances = acceptance.tolerances;
  options.proof = Proof::boundary;
  options.ladder.strict = false;
  const Inspection inspection = certify(decoded.solid, nullptr, options);
  if (const Status in_time = call.check(); !in_time) return refused(in_time.error());
  if (!inspection.certified) {
    fail_invalid(inspection.report, reply);
    return std::nullopt;
  }
  const ValidSolid& solid = inspection.certified->solid;
  const auto order = compare(solid.solid(), decoded.solid);
  if (!order) return refused(order.error());
  if (*order == 0) return solid;
  return refused(
      {ErrorCode::not_encodable, "the blob has another solid than a valid one: it is inside out"});
}

}  // namespace watertight::sql
