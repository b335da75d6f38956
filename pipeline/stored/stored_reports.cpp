// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/stored/stored_reports.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/blob.h"
#include "geometry/measures.h"
#include "packing/feature_text.h"
#include "pipeline/outcome_json.h"
#include "pipeline/stored/solid_lines.h"
#include "pipeline/stored/unproven_solid.h"
#include "tessellate/facets.h"
#include "validate/report_json.h"

namespace watertight::pipeline {
namespace {

using packing::kFindingsLine;
using packing::kMeasuresLine;
using packing::kReportLine;
constexpr std::size_t kFirstMember = 16;  // longer than the first member's name

/// Measures and report of a solid, as JSON.
struct ReportTexts {
  std::string measures;
  std::string report;
};

/// The texts of a solid of which there is nothing to say.
ReportTexts expected_texts(const Solid& solid, const Acceptance& acceptance, bool is_proven) {
  Report report;
  report.verdict = is_proven ? Verdict::valid : Verdict::invalid;
  report.acceptance = acceptance;
  report.measures = measures_of(solid);
  if (is_proven) {
    report.rung = delaunay::Rung::delaunay;
    report.attempts.push_back({delaunay::Rung::delaunay, "accepted", 0});
  }
  validate::ReportJsonOptions json;
  json.include_times = false;
  ReportTexts texts;
  if (report.measures) texts.measures = measures_json(*report.measures);
  texts.report = validate::report_json(report, solid, json);
  return texts;
}

/// The expected texts of the chosen solids; empty ones for the others, and for solids that cannot
/// be decoded (of proven ones: all, when one cannot).
std::vector<ReportTexts> expected_texts(const EncodedFeature& feature, Reports reports,
                                        const Limits& limits) {
  std::vector<ReportTexts> expected(feature.solids.size());
  std::string_view skeleton = feature.skeleton;
  const auto lines = take_solid_lines(skeleton, feature.solids.size());
  std::vector<Decoded> proven;
  if (reports == Reports::all) {
    if (auto decoded = decode_solids(feature, limits)) proven = *std::move(decoded);
  }
  auto next = proven.begin();
  for (std::size_t i = 0; i < feature.solids.size() && reports != Reports::none; ++i) {
    const StoredSolid& solid = feature.solids[i];
    if (solid.is_proven && next != proven.end()) {
      expected[i] = expected_texts(next->solid, next->info.acceptance, true);
      ++next;
    }
    if (!solid.is_proven && lines) {
      const auto read = read_unproven((*lines)[i].unproven, limits);
      if (read) expected[i] = expected_texts(*read, {}, false);
    }
  }
  return expected;
}

/// The line of a text that is not as expected; "" for one that is.
std::string line_of(std::string_view start, std::size_t solid, std::string_view expected,
                    std::string_view text) {
  if (text == expected) return {};
  // PostgreSQL's jsonb, in which older programs kept reports, orders and spaces its members.
  if (text.find("\": ") < kFirstMember && validate::is_same_json(text, expected)) return {};
  const auto front = static_cast<std::size_t>(
      std::mismatch(text.begin(), text.end(), expected.begin(), expected.end()).first -
      text.begin());
  const std::string_view rest = text.substr(front);
  const std::string_view expected_rest = expected.substr(front);
  const auto back = static_cast<std::size_t>(
      std::mismatch(rest.rbegin(), rest.rend(), expected_rest.rbegin(), expected_rest.rend())
          .first -
      rest.rbegin());
  std::string line(start);
  for (const std::size_t number : {solid, front, back}) {
    line += std::to_string(number);
    line += ' ';
  }
  line += rest.substr(0, rest.size() - back);
  return line += '\n';
}

Error malformed() { return {ErrorCode::malformed, "a stored report does not fit its solid"}; }

/// Cuts a number and the space after it off the front of a line. Nothing: there is none.
std::optional<std::size_t> take_number(std::string_view& line) {
  std::size_t number = 0;
  const char* const end = line.data() + line.size();
  const auto [rest, error] = std::from_chars(line.data(), end, number);
  if (error != std::errc{} || rest == end || *rest != ' ') return std::nullopt;
  line.remove_prefix(static_cast<std::size_t>(rest - line.data()) + 1);
  return number;
}

/// The text of a line of line_of() without its start and solid.
Result<std::string> text_of(std::string_view line, std::string_view expected) {
  const auto front = take_number(line);
  const auto back = take_number(line);
  if (!front || !back || *front > expected.size() || *back > expected.size() - *front) {
    return malformed();
  }
  std::string text(expected.substr(0, *front));
  text += line;
  return text += expected.substr(expected.size() - *back);
}

/// The lines that differ, by solid.
struct Lines {
  std::optional<std::string_view> measures;
  std::optional<std::string_view> report;
};

}  // namespace

std::optional<geometry::Measures> measures_of(const Solid& submitted) {
  const Solid merged = geometry::merge_equal_vertices(submitted).solid;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(merged);
  const bool is_whole = std::all_of(facets.state.begin(), facets.state.end(), [](auto state) {
    return state == tessellate::FacetState::triangulated;
  });
  if (!is_whole || merged.shell_count() == 0) return std::nullopt;
  return geometry::measure(facets.divided_solid(merged), facets.triangles);
}

std::string report_lines(const EncodedFeature& feature) {
  const auto expected = expected_texts(feature, Reports::all, {});
  std::string lines;
  for (std::size_t i = 0; i < feature.solids.size(); ++i) {
    const StoredSolid& solid = feature.solids[i];
    lines += line_of(kMeasuresLine, i, expected[i].measures, solid.measures);
    lines += line_of(kReportLine, i, expected[i].report, solid.report);
  }
  if (feature.findings.empty()) return lines;
  lines += kFindingsLine;
  lines += feature.findings;
  return lines += '\n';
}

Status take_report_lines(EncodedFeature& feature, Reports reports, const Limits& limits) {
  const std::string text = std::exchange(feature.skeleton, {});
  std::string_view rest = text;
  std::vector<Lines> lines(feature.solids.size());
  for (;;) {
    const bool is_report = rest.starts_with(kReportLine);
    if (!is_report && !rest.starts_with(kMeasuresLine)) break;
    const auto line = take_line(rest, is_report ? kReportLine : kMeasuresLine, lines.size());
    if (!line) return line.error();
    (is_report ? lines[line->first].report : lines[line->first].measures) = line->second;
  }
  if (rest.starts_with(kFindingsLine)) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) return malformed();
    feature.findings = rest.substr(kFindingsLine.size(), end - kFindingsLine.size());
    feature.has_findings = true;
    rest.remove_prefix(end + 1);
  }
  feature.skeleton = rest;
  const auto expected = expected_texts(feature, reports, limits);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    StoredSolid& solid = feature.solids[i];
    const bool is_chosen =
        reports == Reports::all || (reports == Reports::of_unproven && !solid.is_proven);
    if (!is_chosen) continue;
    solid.measures = expected[i].measures;
    solid.report = expected[i].report;
    for (auto [line, kept] : {std::pair(lines[i].measures, &solid.measures),
                              std::pair(lines[i].report, &solid.report)}) {
      if (!line) continue;
      auto whole = text_of(*line, *kept);
      if (!whole) return std::move(whole).error();
      *kept = *std::move(whole);
    }
  }
  return Done{};
}

}  // namespace watertight::pipeline
