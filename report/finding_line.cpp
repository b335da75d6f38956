// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/finding_line.h"

#include "report/number_text.h"
#include "report/place.h"

namespace watertight::report {
namespace {

/// A place of a finding, with the solid that it is in; null for unknown ones.
struct Side {
  const SolidSource* source = nullptr;
  const Solid* submitted = nullptr;
  Place place = {};
  bool is_surface = false;  // a surface that is no solid
};

struct LineParts {
  const Finding* finding = nullptr;
  Side side;
  std::optional<Side> other = {};
  std::optional<std::array<double, 3>> point = {};
};

std::string side_words(const Side& side) {
  const std::string_view noun = side.is_surface ? "surface" : "solid";
  std::string words = side.source == nullptr ? "" : object_words(*side.source, noun);
  const std::string place = place_words(side.place, side.submitted);
  if (side.is_surface) words.append(", ").append(shortened(side.source->geometry_type));
  if (!words.empty() && !place.empty()) words += ", ";
  return words + place;
}

/// " (polygon 'a', ring 'b', line 12)"; "" for an unknown element.
std::string element_words(const validate::SourceElement& element) {
  std::string words;
  const auto add = [&](const std::string& word) {
    words.append(words.empty() ? " (" : ", ").append(word);
  };
  if (!element.polygon.empty()) add("polygon '" + shortened(element.polygon) + "'");
  if (!element.ring.empty()) add("ring '" + shortened(element.ring) + "'");
  if (element.line != 0) add("line " + std::to_string(element.line));
  return words.empty() ? words : words + ")";
}

std::string line_of(const LineParts& parts) {
  const Finding& finding = *parts.finding;
  std::string line{validate::to_string(finding.severity)};
  line.append(1, ' ').append(std::to_string(finding.code)).append(1, ' ');
  line += validate::finding_name(finding.code);
  const std::string where = side_words(parts.side);
  if (!where.empty()) line.append(" in ").append(where);
  line += element_words(finding.source);
  if (parts.other) {
    const bool is_same = parts.other->source == parts.side.source;
    const std::string other = is_same ? place_words(parts.other->place, parts.other->submitted)
                                      : side_words(*parts.other);
    if (!other.empty()) line.append(" and ").append(other);
    line += element_words(finding.other_source);
  }
  if (parts.point) line.append(", at ").append(point_text(*parts.point));
  if (!finding.detail.empty()) line.append(": ").append(shortened(finding.detail));
  const std::string measured = measure_words(finding);
  if (!measured.empty()) line.append(" (").append(measured).append(1, ')');
  if (finding.uncertain) line += " [uncertain: an earlier finding concerns the same place]";
  return line;
}

}  // namespace

std::string object_words(const SolidSource& source, std::string_view noun) {
  std::string details;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!details.empty()) details += ", ";
    details.append(name).append(1, ' ').append(value);
  };
  if (!source.lod.empty()) add("LoD", shortened(source.lod));
  if (source.geometry > 0) add("geometry", std::to_string(source.geometry));
  if (source.ordinal > 0 && !source.object_id.empty()) add("solid", std::to_string(source.ordinal));
  std::string words = shortened(source.object_id);
  if (words.empty()) words.append(noun).append(1, ' ').append(std::to_string(source.ordinal));
  if (!details.empty()) words.append(" (").append(details).append(1, ')');
  return words;
}

std::vector<FindingLine> finding_lines(const pipeline::InspectedFeature& feature) {
  const auto side_of = [&](Index solid, const Place& place) -> Side {
    if (solid >= feature.solids.size()) return {nullptr, nullptr, place};
    return {&feature.solids[solid].source, submitted_solid(feature, solid), place,
            feature.solids[solid].surface.has_value()};
  };
  std::vector<FindingLine> lines;
  for (const PlacedFinding& placed : findings_of(feature)) {
    const Finding& finding = *placed.finding;
    LineParts parts{&finding, side_of(placed.solid, finding.place), {}, {}};
    if (finding.other) parts.other = side_of(placed.other_solid, *finding.other);
    parts.point = point_of(feature, placed);
    lines.push_back({&finding, line_of(parts)});
  }
  return lines;
}

std::vector<FindingLine> finding_lines(const pipeline::FeatureOutcome& feature) {
  std::vector<FindingLine> lines;
  for (const pipeline::SolidOutcome& solid : feature.solids) {
    for (const Finding& finding : solid.report.findings) {
      LineParts parts{&finding, {&solid.source, nullptr, finding.place}, {}, {}};
      if (finding.other) parts.other = Side{&solid.source, nullptr, *finding.other};
      parts.point = finding.witness;
      lines.push_back({&finding, line_of(parts)});
    }
  }
  for (const pipeline::InspectedGroup& group : feature.groups) {
    const auto side_of = [&](const Place& place) -> Side {
      const std::size_t member =
          place.solid < group.members.size() ? group.members[place.solid] : 0;
      const bool is_known = place.solid < group.members.size() && member < feature.solids.size();
      return {is_known ? &feature.solids[member].source : nullptr, nullptr, place};
    };
    for (const Finding& finding : group.report.findings) {
      LineParts parts{&finding, side_of(finding.place), {}, finding.witness};
      if (finding.other) parts.other = side_of(*finding.other);
      lines.push_back({&finding, line_of(parts)});
    }
  }
  return lines;
}

}  // namespace watertight::report
