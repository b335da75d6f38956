// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/surface/inspect_surface.h"

#include <chrono>
#include <set>
#include <utility>

#include "base/quantity.h"
#include "validate/finding_kinds.h"
#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

/// The findings of rings and facets. Returns the reason why a facet could not be measured, or "".
std::string apply_rules(ExaminedSolid& examined, const CertifyOptions& options) {
  if (examined.solid().facet_count() == 0) {
    examined.findings.add({.code = kEmptyPrimitive, .detail = "the surface has no facets"});
  }
  check_rings(examined);
  check_closed_rings(examined, options.unclosed_rings);
  return check_facets(examined);
}

void judge_as_solid(const Solid& surface, CertifyOptions options, SurfaceFacts& facts) {
  options.proof = Proof::boundary;
  options.also_tolerant = false;
  const Report report = certify(surface, nullptr, options).report;
  facts.as_solid = report.verdict;
  const std::set<int> codes = error_codes(report.findings);
  facts.solid_codes.assign(codes.begin(), codes.end());
}

}  // namespace

SurfaceInspection inspect_surface(const Solid& surface, const CertifyOptions& options) {
  const Severity severity = options.severity_of_surfaces;
  const auto start = std::chrono::steady_clock::now();
  SurfaceInspection inspection;
  Report& report = inspection.report;
  std::string unmeasured;
  FindingCollector unread(options.limits.findings);
  if (!options.unreadable.empty()) {
    unread.add({.code = kInvalidInputFile, .detail = options.unreadable});
    std::move(unread).move_to(report);
  } else {
    ExaminedSolid examined(surface, options.tolerances, options.limits, options.ladder.cancel);
    unmeasured = apply_rules(examined, options);
    if (!examined.unit_note().empty()) report.notes.push_back(examined.unit_note());
    if (examined.was_cancelled() && unmeasured.empty()) unmeasured = "the validation was cancelled";
    std::move(examined.findings).move_to(report);
    inspection.facts.closure = geometry::closure_of(surface);
  }
  for (Finding& finding : report.findings) {
    finding.severity = severity;
    name_elements(surface, options.elements, finding);
  }
  report.acceptance = {options.tolerances, options.proof, geometry::kRuleSet};
  report.first_level = first_level_codes(report.findings);
  const bool counts = severity == Severity::error;
  if (counts && !report.findings.empty()) {
    report.verdict = Verdict::invalid;
  } else if (counts && !unmeasured.empty()) {
    report.undecided_reason = std::move(unmeasured);
  } else {
    report.verdict = Verdict::valid;
    if (!unmeasured.empty()) report.notes.push_back(std::move(unmeasured));
  }
  if (inspection.facts.closure.is_one_shell()) {
    judge_as_solid(surface, options, inspection.facts);
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return inspection;
}

std::string surface_words(const SurfaceFacts& facts) {
  if (!facts.closure.is_closed) {
    return "open: " + quantity(facts.closure.open_edges, "edge that", "edges that") +
           " not exactly two facets share";
  }
  if (!facts.as_solid) {
    return "closed in " + std::to_string(facts.closure.parts) +
           " shells, which are offered as no solid";
  }
  if (*facts.as_solid == Verdict::valid) return "closed: would be a valid solid";
  if (*facts.as_solid == Verdict::undecided) return "closed: undecided whether a valid solid";
  std::string text = "closed, but would be an invalid solid:";
  for (const int code : facts.solid_codes) text.append(1, ' ').append(std::to_string(code));
  return text;
}

}  // namespace watertight::validate
