// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/tally.h"

#include "validate/finding_kinds.h"

namespace watertight::report {
namespace {

constexpr int kUnknownError = 999;

/// The most types that are counted apart. Types come from the document; further types count
/// together.
constexpr std::size_t kMostTypes = 1000;

void count(std::map<std::string, VerdictCount>& types, const std::string& type, Verdict verdict) {
  const bool fits = types.size() < kMostTypes || types.contains(type);
  types[fits ? type : "(other types)"].add(verdict);
}

VerdictCount sum(const std::map<std::string, VerdictCount>& types) {
  VerdictCount all;
  for (const auto& [type, verdicts] : types) {
    all.valid += verdicts.valid;
    all.invalid += verdicts.invalid;
    all.undecided += verdicts.undecided;
  }
  return all;
}

}  // namespace

void VerdictCount::add(Verdict verdict) {
  switch (verdict) {
    case Verdict::valid:
      ++valid;
      break;
    case Verdict::invalid:
      ++invalid;
      break;
    case Verdict::undecided:
      ++undecided;
  }
}

void Tally::add_finding(const Finding& finding) {
  ++findings_[finding.code];
  (finding.severity == Severity::error ? errors_ : warnings_).insert(finding.code);
}

void Tally::add(const pipeline::InspectedFeature& feature) {
  const Verdict verdict = feature.verdict();
  verdict_ = pipeline::worse(verdict_, verdict);
  count(features_, feature.feature.type, verdict);
  surfaces_.add(feature.surfaces);
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    const Report& report = solid.inspection.report;
    if (!solid.surface) count(solids_, solid.source.geometry_type, report.verdict);
    if (solid.repair) ++(is_repaired(*solid.repair) ? repairs_.repaired : repairs_.left);
    omitted_ += report.findings_omitted;
    first_level_.insert(report.first_level.begin(), report.first_level.end());
    for (const Finding& finding : report.findings) add_finding(finding);
  }
  for (const pipeline::InspectedGroup& group : feature.groups) {
    omitted_ += group.report.findings_omitted;
    for (const Finding& finding : group.report.findings) {
      add_finding(finding);
      if (finding.severity == Severity::error) first_level_.insert(finding.code);
    }
  }
}

void Tally::add_error(int code) {
  ++unreadable_;
  ++findings_[code];
  errors_.insert(code);
}

VerdictCount Tally::all_features() const { return sum(features_); }
VerdictCount Tally::all_solids() const { return sum(solids_); }

Verdict Tally::verdict() const {
  return unreadable_ > 0 ? pipeline::worse(verdict_, Verdict::undecided) : verdict_;
}

int code_of(const Error& error) {
  switch (error.code) {
    case ErrorCode::malformed:
    case ErrorCode::limit_exceeded:
    case ErrorCode::not_encodable:
      return validate::kInvalidInputFile;
    case ErrorCode::unsupported:
      return validate::kFormatNotSupported;
    case ErrorCode::invalid_argument:
      return validate::kWrongInputParameters;
    case ErrorCode::cancelled:
    case ErrorCode::not_found:
    case ErrorCode::conflict:
    case ErrorCode::precondition_failed:
    case ErrorCode::unavailable:
      break;
  }
  return kUnknownError;
}

std::string_view name_of(int code) {
  return code == kUnknownError ? "UNKNOWN_ERROR" : validate::finding_name(code);
}

}  // namespace watertight::report
