// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/report_json.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "validate/finding_kinds.h"

namespace watertight::validate {
namespace {

using Json = nlohmann::ordered_json;

/// A number with 6 significant digits, for a person.
std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string place_text(const Place& place) {
  std::string text;
  const auto add = [&](const char* name, Index index) {
    if (index == kNone) return;
    if (!text.empty()) text += ' ';
    text += name;
    text += ' ';
    text += std::to_string(index);
  };
  add("solid", place.solid);
  add("shell", place.shell);
  add("facet", place.facet);
  add("ring", place.ring);
  add("vertex", place.vertex);
  return text;
}

/// " (polygon 'a', ring 'b', line 12)"; "" for an unknown element.
std::string element_text(const SourceElement& element) {
  std::string text;
  const auto add = [&](std::string_view words) {
    text += text.empty() ? " (" : ", ";
    text += words;
  };
  if (!element.polygon.empty()) add("polygon '" + element.polygon + "'");
  if (!element.ring.empty()) add("ring '" + element.ring + "'");
  if (element.line != 0) add("line " + std::to_string(element.line));
  return text.empty() ? text : text + ")";
}

void add_element(Json& json, const char* name, const SourceElement& element) {
  if (element == SourceElement{}) return;
  Json entry = Json::object();
  if (!element.polygon.empty()) entry["polygon"] = element.polygon;
  if (!element.ring.empty()) entry["ring"] = element.ring;
  if (element.line != 0) entry["line"] = element.line;
  json[name] = std::move(entry);
}

Json place_json(const Place& place, const ReportJsonOptions& options) {
  Json json = Json::object();
  const auto add = [&](const char* name, Index index) {
    if (index != kNone) json[name] = index;
  };
  add("solid", options.solid_number);
  add("shell", place.shell);
  add("facet", place.facet);
  add("ring", place.ring);
  add("vertex", place.vertex);
  return json;
}

/// The path of a place as val3dity writes it; the number of a facet counts from the start of its
/// shell.
std::string path_text(const Place& place, const PlacedSolid& solid) {
  const Solid& submitted = *solid.submitted;
  std::string text = solid.options->id_prefix;
  text += "shell=";
  if (place.shell != kNone) text += std::to_string(place.shell);
  text += "|face=";
  const bool has_facet = place.facet != kNone && place.shell != kNone &&
                         place.shell < submitted.shell_count() &&
                         place.facet < submitted.facet_count();
  if (has_facet) text += std::to_string(place.facet - submitted.facets_of(place.shell).begin);
  return text;
}

Json make_finding(const Finding& finding, const PlacedSolid& here, const PlacedSolid& there) {
  Json json;
  const FindingKind* kind = find_kind(finding.code);
  json["code"] = finding.code;
  json["name"] = finding_name(finding.code);
  json["description"] = finding_name(finding.code);  // val3dity has the name in this member
  json["severity"] = to_string(finding.severity);
  json["summary"] = kind == nullptr ? std::string_view{} : kind->summary;
  json["hint"] = kind == nullptr ? std::string_view{} : kind->hint;
  json["is_repairable"] = kind != nullptr && kind->is_repairable;
  std::string id = path_text(finding.place, here);
  if (finding.other) id += "&&" + path_text(*finding.other, there);
  json["id"] = id;
  json["info"] = finding.detail;
  json["place"] = place_json(finding.place, *here.options);
  add_element(json, "source", finding.source);
  const bool has_pointers = !here.options->pointer_prefix.empty();
  if (has_pointers) {
    json["pointer"] = place_pointer(finding.place, *here.submitted, *here.options);
  }
  if (finding.other) {
    json["other"] = place_json(*finding.other, *there.options);
    add_element(json, "other_source", finding.other_source);
    if (has_pointers) {
      json["other_pointer"] = place_pointer(*finding.other, *there.submitted, *there.options);
    }
  }
  if (finding.witness) json["witness"] = *finding.witness;
  if (finding.measured) json["measured"] = *finding.measured;
  if (finding.limit) json["limit"] = *finding.limit;
  if (!finding.unit.empty()) json["unit"] = finding.unit;
  json["uncertain"] = finding.uncertain;
  json["text"] = finding_text(finding);
  return json;
}

std::string dump(const Json& json, JsonStyle style = JsonStyle::compact) {
  return json.dump(style == JsonStyle::indented ? 2 : -1, ' ', false,
                   Json::error_handler_t::replace);
}

Json measures_json(const geometry::Measures& measures) {
  Json json;
  json["volume"] = measures.volume;
  json["area"] = measures.area;
  json["bbox"] = {measures.box_min[0], measures.box_min[1], measures.box_min[2],
                  measures.box_max[0], measures.box_max[1], measures.box_max[2]};
  json["genus"] = measures.genus;
  json["vertices"] = measures.vertices;
  json["facets"] = measures.facets;
  json["rings"] = measures.rings;
  json["shells"] = measures.shells;
  return json;
}

Json parameters_json(const Acceptance& acceptance) {
  Json json;
  json["snap_tol"] = acceptance.tolerances.snap_metres;
  json["planarity_d2p_tol"] = acceptance.tolerances.planarity_metres;
  json["planarity_n_tol"] = acceptance.tolerances.planarity_degrees;
  json["proof"] = acceptance.proof == Proof::tetrahedralization ? "tetrahedralization" : "boundary";
  json["rule_set"] = acceptance.rule_set;
  return json;
}

}  // namespace

std::string finding_json(const Finding& finding, const PlacedSolid& here,
                         const PlacedSolid& there) {
  return dump(make_finding(finding, here, there));
}

std::string report_measures_json(const geometry::Measures& measures) {
  return dump(measures_json(measures));
}

bool is_same_json(std::string_view a, std::string_view b) {
  const auto left = nlohmann::json::parse(a, nullptr, false);
  const auto right = nlohmann::json::parse(b, nullptr, false);
  return !left.is_discarded() && !right.is_discarded() && left == right;
}

std::string place_pointer(const Place& place, const Solid& submitted,
                          const ReportJsonOptions& options) {
  std::string pointer = options.pointer_prefix;
  if (pointer.empty() || place.shell == kNone || place.shell >= submitted.shell_count()) {
    return pointer;
  }
  const auto step = [&](Index index) { pointer += '/' + std::to_string(index); };
  if (options.has_shells) step(place.shell);
  if (place.facet == kNone || place.facet >= submitted.facet_count()) return pointer;
  step(place.facet - submitted.facets_of(place.shell).begin);
  const IndexRange rings = submitted.rings_of(place.facet);
  if (place.ring == kNone || place.ring >= rings.size()) return pointer;
  step(place.ring);
  if (place.vertex == kNone) return pointer;
  const std::span<const Index> ring = submitted.ring(rings.begin + place.ring);
  const auto corner = std::find(ring.begin(), ring.end(), place.vertex);
  if (corner != ring.end()) step(static_cast<Index>(corner - ring.begin()));
  return pointer;
}

std::string finding_text(const Finding& finding) {
  std::string text{to_string(finding.severity)};
  text += ' ' + std::to_string(finding.code) + ' ';
  text += finding_name(finding.code);
  const std::string place = place_text(finding.place);
  if (!place.empty()) text += " at " + place;
  text += element_text(finding.source);
  if (finding.other) {
    const std::string other = place_text(*finding.other);
    if (!other.empty()) text += " and " + other;
    text += element_text(finding.other_source);
  }
  text += ": " + finding.detail;
  if (finding.measured) {
    text += " (" + short_number(*finding.measured) + " " + finding.unit;
    if (finding.limit) text += ", limit " + short_number(*finding.limit);
    text += ")";
  }
  if (finding.uncertain) text += " [uncertain: an earlier finding concerns the same place]";
  return text;
}

std::vector<std::string> report_text(const Report& report) {
  std::vector<std::string> lines;
  std::string first{to_string(report.verdict)};
  if (!report.undecided_reason.empty()) first += ": " + report.undecided_reason;
  lines.push_back(std::move(first));
  for (const Finding& finding : report.findings) lines.push_back(finding_text(finding));
  if (report.findings_omitted > 0) {
    lines.push_back(quantity(report.findings_omitted, "more finding is", "more findings are") +
                    " not listed");
  }
  return lines;
}

std::string report_json(const Report& report, const Solid& submitted,
                        const ReportJsonOptions& options) {
  const PlacedSolid solid{&submitted, &options};
  Json json;
  json["type"] = "watertight_report";
  json["schema"] = kReportSchema;
  json["verdict"] = to_string(report.verdict);
  json["validity"] = report.verdict == Verdict::valid;
  if (!report.undecided_reason.empty()) json["undecided_reason"] = report.undecided_reason;
  json["parameters"] = parameters_json(report.acceptance);
  if (options.is_strict) json["parameters"]["strict"] = true;
  json["all_errors"] = error_codes(report.findings);
  json["first_level"] = report.first_level;
  if (report.tolerant) {
    json["tolerant"] = {{"verdict", to_string(report.tolerant->verdict)},
                        {"first_level", report.tolerant->first_level}};
  }
  json["errors"] = Json::array();
  json["warnings"] = Json::array();
  for (const Finding& finding : report.findings) {
    const char* list = finding.severity == Severity::error ? "errors" : "warnings";
    json[list].push_back(make_finding(finding, solid, solid));
  }
  json["findings_omitted"] = report.findings_omitted;
  json["not_run"] = Json::array();
  for (const SkippedRule& rule : report.not_run) {
    json["not_run"].push_back({{"codes", rule.codes}, {"reason", rule.reason}});
  }
  json["notes"] = report.notes;
  json["rung"] = delaunay::to_string(report.rung);
  if (!report.refilled_facets.empty()) json["refilled_facets"] = report.refilled_facets;
  json["attempts"] = Json::array();
  for (const delaunay::RungAttempt& attempt : report.attempts) {
    Json entry{{"rung", delaunay::to_string(attempt.rung)}, {"outcome", attempt.outcome}};
    if (options.include_times) entry["seconds"] = attempt.seconds;
    json["attempts"].push_back(std::move(entry));
  }
  if (report.measures) json["measures"] = measures_json(*report.measures);
  if (options.include_times) json["seconds"] = report.seconds;
  return dump(json, options.style);
}

}  // namespace watertight::validate
