// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/findings/finding_list.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <tuple>

#include "base/quantity.h"
#include "cli/terminal/printable.h"
#include "report/finding_line.h"

namespace watertight::cli {
namespace {

struct Line {
  Urgency urgency = Urgency::rest;
  std::string text;
};

Urgency urgency_of(const Finding& finding, bool is_known) {
  if (finding.severity == Severity::error) return is_known ? Urgency::known_error : Urgency::error;
  return is_known ? Urgency::known_warning : Urgency::warning;
}

std::string brief(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", number);
  return text.data();
}

constexpr double kNoticeableGap = 0.001;  // of the chord; the JSON report has smaller ones too

/// What was made of a curved solid, on a line.
std::string tessellation_words(const pipeline::InspectedSolid& solid) {
  const formats::Tessellation& made = *solid.tessellation;
  std::string text = report::object_words(solid.source) + ": ";
  text.append(quantity(made.faces, "face")).append(", ").append(quantity(made.edges, "edge"));
  if (const auto& measures = solid.inspection.report.measures) {
    text.append(" became ").append(quantity(measures->facets, "facet"));
    text.append(", volume ").append(brief(measures->volume)).append(" m3");
  }
  if (made.strips > 0) {
    const double ratio = static_cast<double>(made.indices) / static_cast<double>(made.triangles);
    text.append(", ").append(quantity(made.strips, "strip")).append(" (").append(brief(ratio));
    text.append(" indices a triangle)");
  }
  text.append(", chord error ").append(brief(made.chord_error)).append(" m (limit ");
  text.append(brief(made.chord)).append(")");
  if (made.gap > kNoticeableGap * made.chord) {
    text.append(", edges up to ").append(brief(made.gap)).append(" m off faces");
  }
  if (made.halvings > 0) {
    text.append(", chord halved ").append(quantity(made.halvings, "time"));
    text.append(" until no facets crossed");
  }
  if (made.turned > 0) text.append(", ").append(quantity(made.turned, "face")).append(" turned");
  return text;
}

void add_tessellation(std::vector<Line>& lines, const pipeline::InspectedSolid& solid) {
  if (!solid.tessellation) return;
  lines.push_back({Urgency::rest, tessellation_words(solid)});
  for (const auto& face : solid.tessellation->left_out) {
    lines.push_back({Urgency::error, "face " + face.face + " of " +
                                         report::object_words(solid.source) +
                                         " is left out: " + face.reason});
  }
}

/// Adds the lines that a report has beside its findings.
void add_remarks(std::vector<Line>& lines, const std::string& object, const Report& report) {
  if (report.verdict == Verdict::undecided) {
    lines.push_back(
        {Urgency::undecided, "undecided in " + object + ": " + report.undecided_reason});
  }
  if (report.findings_omitted == 0) return;
  std::string text = quantity(report.findings_omitted, "more finding is", "more findings are");
  lines.push_back({Urgency::rest, text.append(" not listed in ").append(object)});
}

void add_remarks(std::vector<Line>& lines, const pipeline::InspectedGroup& group) {
  if (group.report.findings_omitted == 0) return;
  std::string text =
      quantity(group.report.findings_omitted, "more finding is", "more findings are");
  lines.push_back({Urgency::rest, text.append(" not listed in ").append(group.object_id)});
}

FeatureLines arranged(const std::string& name, Verdict verdict, std::vector<Line> lines) {
  FeatureLines feature;
  if (lines.empty()) return feature;
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Line& a, const Line& b) { return a.urgency < b.urgency; });
  feature.worst = lines.front().urgency;
  std::size_t warnings = 0;
  std::size_t known = 0;
  for (Line& line : lines) {
    const bool is_known =
        line.urgency == Urgency::known_error || line.urgency == Urgency::known_warning;
    if (line.urgency == Urgency::error) ++feature.errors;
    if (line.urgency == Urgency::warning) ++warnings;
    if (is_known) ++known;
    feature.lines.push_back(printable(line.text) + (is_known ? " [known]" : ""));
  }
  feature.head = printable(name) + ": " + std::string(validate::to_string(verdict));
  const auto add = [&](std::size_t count, std::string_view noun, std::string_view plural) {
    if (count > 0) feature.head.append(", ").append(quantity(count, noun, plural));
  };
  add(feature.errors, "error", {});
  add(warnings, "warning", {});
  add(known, "known finding", {});
  return feature;
}

std::string name_of(const std::string& file, const std::string& feature) {
  return feature.empty() ? file : file + ": " + feature;
}

}  // namespace

FeatureLines lines_of(const std::string& file, const pipeline::InspectedFeature& feature,
                      const std::vector<bool>& is_known) {
  std::vector<Line> lines;
  std::vector<report::FindingLine> found = report::finding_lines(feature);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool known = i < is_known.size() && is_known[i];
    lines.push_back({urgency_of(*found[i].finding, known), std::move(found[i].text)});
  }
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    add_remarks(lines, report::object_words(solid.source), solid.inspection.report);
    add_tessellation(lines, solid);
  }
  for (const pipeline::InspectedGroup& group : feature.groups) add_remarks(lines, group);
  return arranged(name_of(file, feature.feature.id), feature.verdict(), std::move(lines));
}

FeatureLines lines_of(const std::string& file, const pipeline::FeatureOutcome& feature) {
  std::vector<Line> lines;
  for (report::FindingLine& line : report::finding_lines(feature)) {
    lines.push_back({urgency_of(*line.finding, false), std::move(line.text)});
  }
  for (const pipeline::SolidOutcome& solid : feature.solids) {
    add_remarks(lines, report::object_words(solid.source), solid.report);
  }
  for (const pipeline::InspectedGroup& group : feature.groups) add_remarks(lines, group);
  return arranged(name_of(file, feature.id), feature.verdict, std::move(lines));
}

std::string text_of(const FeatureLines& feature) {
  if (feature.lines.empty()) return "";
  std::string text = feature.head + "\n";
  for (const std::string& line : feature.lines) text.append("  ").append(line).append(1, '\n');
  return text;
}

bool FindingList::IsWorse::operator()(const Entry& a, const Entry& b) const {
  return std::tuple(a.feature.worst, b.feature.errors, a.number) <
         std::tuple(b.feature.worst, a.feature.errors, b.number);
}

void FindingList::add(FeatureLines feature) {
  if (feature.lines.empty()) return;
  if (feature.lines.size() > most_lines_) {
    dropped_ += feature.lines.size() - most_lines_;
    feature.lines.resize(most_lines_);
  }
  lines_ += feature.lines.size();
  entries_.insert({std::move(feature), added_++});
  while (lines_ > most_lines_ && entries_.size() > 1) {
    const auto last = std::prev(entries_.end());
    lines_ -= last->feature.lines.size();
    dropped_ += last->feature.lines.size();
    entries_.erase(last);
  }
}

std::string FindingList::text() const {
  std::string text;
  for (const Entry& entry : entries_) text += text_of(entry.feature);
  if (dropped_ > 0) {
    text += quantity(dropped_, "more line is", "more lines are");
    text += " not shown; --report and --csv have all findings\n";
  }
  return text;
}

}  // namespace watertight::cli
