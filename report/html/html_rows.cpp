// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html/html_rows.h"

#include <algorithm>

#include "report/html/html_page.h"
#include "report/html/picture.h"
#include "report/number_text.h"
#include "report/tally.h"
#include "validate/finding_kinds.h"

namespace watertight::report {
namespace {

/// The most errors of reading that get a row of their own.
constexpr std::size_t kMostErrors = 200;

/// The most facets that all pictures together look at, which limits the time for very large solids.
constexpr std::uint64_t kMostFacetsVisited = 40'000'000;

/// The heights of a section's head and of a row, roughly, pixels: the browser lays out a section
/// when it comes into view and takes these heights until then.
constexpr std::size_t kHeadHeight = 46;
constexpr std::size_t kRowHeight = 150;

const SolidSource* source_of(const pipeline::InspectedFeature& feature, Index solid) {
  return solid < feature.solids.size() ? &feature.solids[solid].source : nullptr;
}

std::string object_name(const pipeline::InspectedFeature& feature, const PlacedFinding& placed) {
  const SolidSource* source = source_of(feature, placed.solid);
  if (source == nullptr) return feature.feature.id;
  if (!source->object_id.empty()) return source->object_id;
  std::string name = "solid ";
  return name.append(std::to_string(source->ordinal));
}

std::string head_of(std::string_view object, std::string_view file, std::string_view feature) {
  std::string head = "<h3>";
  append(head, {html_text(object), " <span class=\"soft\">"});
  if (feature != object && !feature.empty()) append(head, {"of ", html_text(feature), ", "});
  return head.append("in ").append(html_text(file)).append("</span>");
}

std::string row_start(const Finding& finding) {
  const std::string_view severity = validate::to_string(finding.severity);
  std::string start = "<tr class=\"";
  append(start, {severity, "\" data-code=\"", std::to_string(finding.code), "\" data-severity=\"",
                 severity, "\" data-measured=\""});
  if (finding.measured) start += number_text(*finding.measured);
  return start + "\">";
}

std::string finding_cell(const Finding& finding) {
  const validate::FindingKind* kind = validate::find_kind(finding.code);
  const std::string code = std::to_string(finding.code);
  std::string html = "<td><p><span class=\"code\">";
  append(html, {code, "</span> <b>"});
  html += html_text(kind == nullptr ? std::string_view("unknown") : kind->summary);
  append(html, {"</b></p><p class=\"soft\"><code>", html_text(validate::finding_name(finding.code)),
                "</code></p><p>", html_text(shortened(finding.detail)), "</p>"});
  if (finding.uncertain) {
    html += "<p><span class=\"tag\">uncertain: an earlier finding concerns this place</span></p>";
  }
  return html + "</td>";
}

/// The gml:ids and the line of an element; `which` is "other " for the other place of a pair.
void append_element(std::string& facts, std::string_view which,
                    const validate::SourceElement& element) {
  const std::string name(which);
  append_fact(facts, name + "polygon", shortened(element.polygon), FactStyle::code);
  append_fact(facts, name + "ring", shortened(element.ring), FactStyle::code);
  if (element.line == 0) return;
  append_fact(facts, name + "line", std::to_string(element.line), FactStyle::code);
}

std::string place_cell(const pipeline::InspectedFeature& feature, const PlacedFinding& placed) {
  const Finding& finding = *placed.finding;
  std::string cell = "<td>";
  const SolidSource* source = source_of(feature, placed.solid);
  if (source != nullptr && !source->lod.empty()) {
    append(cell, {"<p><span class=\"tag\">LoD ", html_text(shortened(source->lod)), "</span></p>"});
  }
  std::string place = place_words(finding.place, submitted_solid(feature, placed.solid));
  if (finding.other) {
    const std::string other =
        place_words(*finding.other, submitted_solid(feature, placed.other_solid));
    if (!other.empty()) append(place, {" and ", other});
  }
  append(cell, {"<p class=\"soft\">", place, "</p>"});
  std::string facts;
  if (placed.group != nullptr && source_of(feature, placed.other_solid) != nullptr) {
    append_fact(facts, "other", shortened(source_of(feature, placed.other_solid)->object_id));
  }
  const auto point = point_of(feature, placed);
  if (point) append_fact(facts, "at", point_text(*point), FactStyle::code);
  append_fact(facts, "pointer", shortened(pointer_of(feature, placed.solid, finding.place)),
              FactStyle::code);
  append_element(facts, "", finding.source);
  append_element(facts, "other ", finding.other_source);
  if (finding.other) {
    append_fact(facts, "other", shortened(pointer_of(feature, placed.other_solid, *finding.other)),
                FactStyle::code);
  }
  if (!facts.empty()) {
    append(cell, {"<details><summary>where exactly</summary><dl class=\"facts\">", facts,
                  "</dl></details>"});
  }
  return cell + "</td>";
}

std::string measure_cell(const Finding& finding) {
  const MeasureText measure = readable_measure(finding);
  std::string html = "<td class=\"num\">";
  if (!measure.measured.empty()) {
    append(html, {"<p><b>", html_text(measure.measured), "</b></p>"});
  }
  if (!measure.limit.empty()) {
    append(html, {"<p class=\"soft\">limit ", html_text(measure.limit), "</p>"});
  }
  return html + "</td>";
}

std::string hint_cell(int code) {
  const validate::FindingKind* kind = validate::find_kind(code);
  std::string html = "<td>";
  if (kind != nullptr) {
    append(html, {"<p class=\"hint\">", html_text(kind->hint), "</p>"});
    if (kind->is_repairable) html += "<p><span class=\"tag\">repairable</span></p>";
  }
  return html + "</td>";
}

/// The figure of a code, of which the page has one symbol.
std::string figure_of(int code) {
  if (figure_symbol(code).empty()) return "<div class=\"none\">not drawn</div>";
  std::string html = "<svg class=\"figure\" viewBox=\"0 0 160 120\"><use href=\"#figure-";
  return html.append(std::to_string(code)).append("\"/></svg>");
}

}  // namespace

FindingRows::Section& FindingRows::section_of(std::string_view file,
                                              const pipeline::InspectedFeature& feature,
                                              const PlacedFinding& placed, std::size_t first) {
  std::string object = object_name(feature, placed);
  const auto begin = sections_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto found = std::find_if(begin, sections_.end(),
                                  [&](const Section& section) { return section.object == object; });
  if (found != sections_.end()) return *found;
  std::string head = head_of(object, file, feature.feature.id);
  sections_.push_back({std::move(object), std::move(head), {}});
  return sections_.back();
}

void FindingRows::add(std::string_view file, const pipeline::InspectedFeature& feature) {
  const std::size_t first = sections_.size();
  for (const PlacedFinding& placed : findings_of(feature)) {
    if (row_count_ >= options_.most_rows) return;
    ++row_count_;
    const Finding& finding = *placed.finding;
    Section& section = section_of(file, feature, placed, first);
    section.rows.push_back({finding.code,
                            row_start(finding),
                            {},
                            finding_cell(finding) + place_cell(feature, placed) +
                                measure_cell(finding) + hint_cell(finding.code) + "</tr>\n"});
    add_picture(feature, placed,
                {static_cast<std::size_t>(&section - sections_.data()), section.rows.size() - 1});
  }
}

/// The code with the most pictures; pictures_ must not be empty.
std::map<int, std::vector<FindingRows::RowPlace>>::iterator FindingRows::most_drawn() {
  return std::max_element(pictures_.begin(), pictures_.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
}

bool FindingRows::has_room(int code) {
  const std::size_t own = pictures_[code].size();
  if (own >= options_.most_pictures_per_code) return false;
  if (picture_count_ < options_.most_pictures) return true;
  return most_drawn()->second.size() > own + 1;
}

void FindingRows::make_room() {
  if (picture_count_ < options_.most_pictures) return;
  std::vector<RowPlace>& most = most_drawn()->second;
  sections_[most.back().section].rows[most.back().row].picture.clear();
  most.pop_back();
  --picture_count_;
}

void FindingRows::add_picture(const pipeline::InspectedFeature& feature,
                              const PlacedFinding& placed, RowPlace place) {
  const int code = placed.finding->code;
  if (facets_visited_ > kMostFacetsVisited || !has_room(code)) return;
  for (const Index solid : {placed.solid, placed.other_solid}) {
    const Solid* visited = submitted_solid(feature, solid);
    if (visited != nullptr) facets_visited_ += visited->facet_count();
  }
  PictureOptions options;
  options.most_facets = options_.most_facets;
  const auto picture = picture_of(feature, placed, options);
  if (!picture) return;
  make_room();
  ++picture_count_;
  pictures_[code].push_back(place);
  std::string& html = sections_[place.section].rows[place.row].picture;
  html = "<figure tabindex=\"0\" role=\"button\" aria-label=\"Enlarge the view\" data-scene='";
  html += picture->scene;  // JSON without apostrophes
  append(html, {"'>", picture->svg, "</figure>"});
}

void FindingRows::add_error(std::string_view file, const Error& error) {
  if (++error_count_ > kMostErrors) return;
  ++row_count_;
  const int code = code_of(error);
  Row row{code,
          "<tr class=\"error\" data-code=\"" + std::to_string(code) +
              "\" data-severity=\"error\" data-measured=\"\">",
          {},
          "<td><p><span class=\"code\">"};
  append(row.cells, {std::to_string(code), "</span> <b>could not be read</b></p><p class=\"soft\">",
                     "<code>", html_text(name_of(code)), "</code></p><p>", html_text(error.message),
                     "</p></td><td><dl class=\"facts\">"});
  if (error.byte_offset) append_fact(row.cells, "byte", std::to_string(*error.byte_offset));
  append_fact(row.cells, "pointer", error.pointer, FactStyle::code);
  row.cells += "</dl></td><td></td><td></td></tr>\n";
  std::string head = "<h3>";
  head.append(html_text(file)).append(" <span class=\"soft\">not readable</span>");
  sections_.push_back({{}, std::move(head), {}});
  sections_.back().rows.push_back(std::move(row));
}

Status FindingRows::write(const TextSink& sink) const {
  for (const Section& section : sections_) {
    const std::size_t height = kHeadHeight + kRowHeight * section.rows.size();
    std::string html = "<section style=\"contain-intrinsic-size:auto ";
    append(html, {std::to_string(height), "px\">", section.head, " <span class=\"soft\">",
                  counted(section.rows.size(), "finding"), "</span></h3>\n<table><tbody>\n"});
    for (const Row& row : section.rows) {
      append(html, {row.start, "<td class=\"pic\">"});
      html += row.picture.empty() ? figure_of(row.code) : row.picture;
      append(html, {"</td>", row.cells});
    }
    html += "</tbody></table></section>\n";
    const Status status = sink(html);
    if (!status) return status;
  }
  return Done{};
}

}  // namespace watertight::report
