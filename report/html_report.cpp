// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <map>

#include "geometry/measures.h"
#include "report/feature_report.h"
#include "report/footprints.h"
#include "report/html_page.h"
#include "report/picture.h"
#include "report/tally.h"
#include "validate/finding_kinds.h"

namespace watertight::report {
namespace {

/// The most documents that the page lists by name; more documents are only counted.
constexpr std::size_t kMostFiles = 200;

/// The most errors of reading that get a row of their own.
constexpr std::size_t kMostErrors = 200;

/// The most facets that all pictures together look at, which limits the time for very large solids.
constexpr std::uint64_t kMostFacetsVisited = 40'000'000;

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, 6)
                       .ptr;
  return {buffer.data(), end};
}

/// A count with separators, such as "12,345".
std::string count_text(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
  return digits;
}

std::string counted(std::uint64_t count, std::string_view noun) {
  std::string text = count_text(count);
  text += ' ';
  text += noun;
  if (count != 1) text += 's';
  return text;
}

std::string coordinates_text(const std::array<double, 3>& point) {
  std::string text;
  for (const double coordinate : point) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), coordinate).ptr;
    if (!text.empty()) text += ' ';
    text.append(buffer.data(), end);
  }
  return text;
}

std::string solid_name(const SolidSource& source) {
  if (!source.object_id.empty()) return source.object_id;
  std::string name = "solid ";
  name += std::to_string(source.ordinal);
  return name;
}

std::string place_words(const Place& place, const Solid* solid) {
  std::string text;
  const auto add = [&](std::string_view name, Index index) {
    if (!text.empty()) text += ' ';
    text += name;
    text += ' ';
    text += std::to_string(index);
  };
  const bool has_shells = solid != nullptr && solid->shell_count() > 1;
  if (place.shell != kNone && (has_shells || place.facet == kNone)) add("shell", place.shell);
  if (place.facet != kNone) add("facet", place.facet);
  if (place.ring != kNone && place.ring > 0) add("ring", place.ring);
  return text;
}

void append_fact(std::string& html, std::string_view name, const std::string& value,
                 bool is_code = false) {
  if (value.empty()) return;
  html += "<dt>";
  html += name;
  html += is_code ? "</dt><dd><code>" : "</dt><dd>";
  html += html_text(value);
  html += is_code ? "</code></dd>" : "</dd>";
}

/// The gml:ids and the line of an element; `which` is "other " for the other place of a pair.
void append_element(std::string& html, std::string_view which,
                    const validate::SourceElement& element) {
  const std::string name(which);
  append_fact(html, name + "polygon", element.polygon, true);
  append_fact(html, name + "ring", element.ring, true);
  if (element.line != 0) append_fact(html, name + "line", std::to_string(element.line), true);
}

class HtmlReport final : public FeatureReport {
 public:
  HtmlReport(TextSink sink, ReportHead head, const HtmlOptions& options)
      : sink_(std::move(sink)), head_(std::move(head)), options_(options) {}

  Status begin_document(const DocumentHead& document) override {
    file_ = document.file;
    ++documents_;
    if (files_.size() < kMostFiles) files_.push_back(document.file);
    return Done{};
  }

  Status add(const pipeline::ValidatedFeature& feature) override {
    tally_.add(feature.inspected);
    footprints_.add(feature.inspected);
    for (const PlacedFinding& placed : findings_of(feature.inspected)) {
      ++findings_;
      if (rows_.size() < options_.most_rows) rows_.push_back(row(feature.inspected, placed));
    }
    return Done{};
  }

  Status add_error(const Error& error) override {
    tally_.add_error(code_of(error));
    ++findings_;
    if (++errors_ <= kMostErrors) rows_.push_back(error_row(error));
    return Done{};
  }

  Status end_document(const DocumentEnd& end) override {
    seconds_ += end.seconds;
    for (const std::string& note : end.notes) {
      if (notes_.size() < kMostFiles) notes_.push_back(note);
    }
    return Done{};
  }

  Status finish() override {
    for (const std::string& part : {top(), cards(), table_top()}) {
      const Status status = sink_(part);
      if (!status) return status;
    }
    for (const std::string& row : rows_) {
      const Status status = sink_(row);
      if (!status) return status;
    }
    return sink_(bottom());
  }

 private:
  std::string row(const pipeline::InspectedFeature& feature, const PlacedFinding& placed);
  std::string picture_cell(const pipeline::InspectedFeature& feature, const PlacedFinding& placed);
  std::string place_cell(const pipeline::InspectedFeature& feature,
                         const PlacedFinding& placed) const;
  std::string error_row(const Error& error) const;
  std::string top() const;
  std::string banner() const;
  std::string cards() const;
  std::string verdict_card(std::string_view name, const VerdictCount& count) const;
  std::string codes_card() const;
  std::string settings_card() const;
  std::string table_top() const;
  std::string bottom() const;

  TextSink sink_;
  ReportHead head_;
  HtmlOptions options_;
  Tally tally_;
  Footprints footprints_;
  std::string file_;
  std::vector<std::string> files_;
  std::vector<std::string> notes_;
  std::vector<std::string> rows_;
  std::map<int, std::size_t> pictures_of_;  // the number of pictures by code
  std::size_t documents_ = 0;
  std::size_t pictures_ = 0;
  std::size_t errors_ = 0;
  std::uint64_t findings_ = 0;
  std::uint64_t facets_visited_ = 0;
  double seconds_ = 0;
};

std::string HtmlReport::picture_cell(const pipeline::InspectedFeature& feature,
                                     const PlacedFinding& placed) {
  const std::string none = "<td class=\"pic\"><div class=\"none\">";
  const int code = placed.finding->code;
  std::size_t& of_code = pictures_of_[code];
  if (pictures_ >= options_.most_pictures || of_code >= options_.most_pictures_per_code ||
      facets_visited_ > kMostFacetsVisited) {
    return none + "not drawn</div></td>";
  }
  for (const Index solid : {placed.solid, placed.other_solid}) {
    const Solid* visited = submitted_solid(feature, solid);
    if (visited != nullptr) facets_visited_ += visited->facet_count();
  }
  PictureOptions options;
  options.most_facets = options_.most_facets;
  const auto picture = picture_of(feature, placed, options);
  if (!picture) return none + "nothing to draw</div></td>";
  ++pictures_;
  ++of_code;
  std::string cell = "<td class=\"pic\"><figure tabindex=\"0\" role=\"button\" ";
  cell += "aria-label=\"Enlarge the view\" data-scene='";
  cell += picture->scene;  // JSON without apostrophes
  cell += "'>";
  cell += picture->svg;
  return cell + "</figure></td>";
}

std::string HtmlReport::place_cell(const pipeline::InspectedFeature& feature,
                                   const PlacedFinding& placed) const {
  const Finding& finding = *placed.finding;
  std::string cell = "<td><p><b>";
  const bool has_solid = placed.solid < feature.solids.size();
  const SolidSource none;
  const SolidSource& source = has_solid ? feature.solids[placed.solid].source : none;
  cell += html_text(solid_name(source));
  cell += "</b> ";
  if (!source.lod.empty()) {
    cell += "<span class=\"tag\">LoD ";
    cell += html_text(source.lod);
    cell += "</span>";
  }
  cell += "</p><p class=\"soft\">";
  std::string place = place_words(finding.place, submitted_solid(feature, placed.solid));
  if (finding.other) {
    const std::string other =
        place_words(*finding.other, submitted_solid(feature, placed.other_solid));
    if (!other.empty()) append(place, {" and ", other});
  }
  cell += place;
  cell += "</p><details><summary>where exactly</summary><dl class=\"facts\">";
  if (documents_ > 1) append_fact(cell, "file", file_);
  if (feature.feature.id != source.object_id) append_fact(cell, "feature", feature.feature.id);
  if (placed.group != nullptr && placed.other_solid < feature.solids.size()) {
    append_fact(cell, "other", feature.solids[placed.other_solid].source.object_id);
  }
  const auto point = point_of(feature, placed);
  if (point) append_fact(cell, "at", coordinates_text(*point), true);
  append_fact(cell, "pointer", pointer_of(feature, placed.solid, finding.place), true);
  append_element(cell, "", finding.source);
  append_element(cell, "other ", finding.other_source);
  if (finding.other) {
    append_fact(cell, "other", pointer_of(feature, placed.other_solid, *finding.other), true);
  }
  return cell + "</dl></details></td>";
}

std::string HtmlReport::row(const pipeline::InspectedFeature& feature,
                            const PlacedFinding& placed) {
  const Finding& finding = *placed.finding;
  const validate::FindingKind* kind = validate::find_kind(finding.code);
  const std::string code = std::to_string(finding.code);
  std::string html = "<tr class=\"";
  html += validate::to_string(finding.severity);
  append(html, {"\" data-code=\"", code, "\" data-severity=\""});
  html += validate::to_string(finding.severity);
  html += "\" data-object=\"";
  if (placed.solid < feature.solids.size()) {
    html += html_text(feature.solids[placed.solid].source.object_id);
  }
  html += "\" data-measured=\"";
  if (finding.measured) html += number_text(*finding.measured);
  html += "\">";
  html += picture_cell(feature, placed);
  append(html, {"<td><p><span class=\"code\">", code, "</span> <b>"});
  html += html_text(kind == nullptr ? std::string_view("unknown") : kind->summary);
  html += "</b></p><p class=\"soft\"><code>";
  html += html_text(validate::finding_name(finding.code));
  html += "</code></p><p>";
  html += html_text(finding.detail);
  html += "</p>";
  if (finding.uncertain) {
    html += "<p><span class=\"tag\">uncertain: an earlier finding concerns this place</span></p>";
  }
  html += "</td>";
  html += place_cell(feature, placed);
  html += "<td class=\"num\">";
  if (finding.measured) {
    append(html,
           {"<p><b>", number_text(*finding.measured), "</b> ", html_text(finding.unit), "</p>"});
  }
  if (finding.limit) {
    append(html, {"<p class=\"soft\">limit ", number_text(*finding.limit), "</p>"});
  }
  html += "</td><td>";
  if (kind != nullptr) {
    html += "<p class=\"hint\">";
    html += html_text(kind->hint);
    html += "</p>";
    if (kind->is_repairable) html += "<p><span class=\"tag\">repairable</span></p>";
  }
  return html + "</td></tr>\n";
}

std::string HtmlReport::error_row(const Error& error) const {
  const std::string code = std::to_string(code_of(error));
  std::string html = "<tr class=\"error\" data-code=\"";
  html += code;
  html += "\" data-severity=\"error\" data-object=\"\" data-measured=\"\">";
  html +=
      "<td class=\"pic\"><div class=\"none\">not readable</div></td><td><p><span class=\"code\">";
  append(html, {code, "</span> <b>could not be read</b></p><p class=\"soft\"><code>"});
  html += html_text(name_of(code_of(error)));
  append(html, {"</code></p><p>", html_text(error.message), "</p></td><td><dl class=\"facts\">"});
  append_fact(html, "file", file_);
  if (error.byte_offset) append_fact(html, "byte", std::to_string(*error.byte_offset));
  append_fact(html, "pointer", error.pointer, true);
  return html + "</dl></td><td></td><td></td></tr>\n";
}

std::string HtmlReport::banner() const {
  const VerdictCount features = tally_.all_features();
  const Verdict verdict = tally_.verdict();
  std::string html = "<div class=\"banner ";
  html += validate::to_string(verdict);
  html += "\"><svg viewBox=\"0 0 24 24\" fill=\"none\" stroke=\"#fff\" stroke-width=\"2.4\" ";
  html += "stroke-linecap=\"round\" aria-hidden=\"true\"><circle cx=\"12\" cy=\"12\" r=\"10\"/>";
  html += verdict == Verdict::valid     ? "<path d=\"M7.5 12.5l3 3 6-6.5\"/>"
          : verdict == Verdict::invalid ? "<path d=\"M8.5 8.5l7 7M15.5 8.5l-7 7\"/>"
                                        : "<path d=\"M12 7v6M12 16.5v.1\"/>";
  html += "</svg><span>";
  if (tally_.unreadable() > 0) {
    append(html, {counted(tally_.unreadable(), "part"), " of the input could not be read. "});
  }
  if (features.total() == 0) {
    html += "No features were validated.";
  } else if (features.valid == features.total()) {
    if (features.total() == 1) return html + "The feature is valid.</span></div>";
    append(html, {"All ", counted(features.total(), "feature"), " are valid."});
  } else {
    append(html, {count_text(features.invalid), " of ", counted(features.total(), "feature")});
    html += features.invalid == 1 ? " is not valid" : " are not valid";
    if (features.undecided > 0) append(html, {", ", count_text(features.undecided), " undecided"});
    html += '.';
  }
  return html + "</span></div>";
}

std::string HtmlReport::top() const {
  std::string title = "Validation report";
  if (documents_ == 1) append(title, {": ", files_.front()});
  std::string html = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">";
  html += "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">";
  html += "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; ";
  html += "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">";
  html += "<meta name=\"generator\" content=\"watertight ";
  html += html_text(head_.program_version);
  append(html, {"\"><title>", html_text(title), "</title>\n<style>"});
  html += kPageStyle;
  html += "</style></head>\n<body><main><header><h1>";
  html += html_text(documents_ == 1 ? files_.front() : counted(documents_, "file"));
  html += "</h1><span class=\"soft\">Watertight ";
  html += html_text(head_.program_version);
  if (!head_.time.empty()) {
    append(html, {" \xC2\xB7 ", html_text(head_.time), " \xC2\xB7 ", number_text(seconds_), " s"});
  }
  return html + "</span></header>\n" + banner();
}

std::string HtmlReport::verdict_card(std::string_view name, const VerdictCount& count) const {
  std::string html = "<section class=\"card\"><h3>";
  html += name;
  append(html,
         {"</h3><div class=\"big\">", count_text(count.total()), "</div><div class=\"bar\">"});
  std::string legend;
  const auto add = [&](std::string_view style, std::uint64_t part) {
    if (part > 0) {
      html += "<i class=\"";
      html += style;
      append(html, {"\" style=\"flex:", std::to_string(part), " 0 2px\"></i>"});
    }
    legend += "<span><i class=\"dot ";
    legend += style;
    append(legend, {"\"></i><b>", count_text(part), "</b> "});
    legend += style;
    legend += "</span>";
  };
  add("valid", count.valid);
  add("invalid", count.invalid);
  add("undecided", count.undecided);
  return html + "</div><div class=\"legend\">" + legend + "</div></section>";
}

std::string HtmlReport::codes_card() const {
  std::string html = "<section class=\"card\" style=\"grid-column:1/-1\"><h3>Findings by code</h3>";
  std::uint64_t most = 1;
  for (const auto& [code, count] : tally_.findings()) most = std::max(most, count);
  html += "<table class=\"codes\">";
  for (const auto& [code, count] : tally_.findings()) {
    const validate::FindingKind* kind = validate::find_kind(code);
    const std::string number = std::to_string(code);
    html += tally_.errors().contains(code) ? "<tr class=\"error\">" : "<tr class=\"warning\">";
    append(html, {"<td><button data-code=\"", number, "\">", number, "</button></td>"});
    html += "<td class=\"name\"><code>";
    html += html_text(name_of(code));
    html += "</code><br><span class=\"soft\">";
    html += html_text(kind == nullptr ? std::string_view{} : kind->summary);
    html += "</span></td><td class=\"track\"><i style=\"width:";
    html += number_text(100.0 * static_cast<double>(count) / static_cast<double>(most));
    append(html, {"%\"></i></td><td class=\"num\"><b>", count_text(count), "</b></td></tr>"});
  }
  return html + "</table></section>";
}

std::string HtmlReport::settings_card() const {
  const Tolerances& tolerances = head_.acceptance.tolerances;
  std::string html = "<section class=\"card\"><h3>Validated with</h3><dl class=\"facts\">";
  append_fact(html, "planarity",
              number_text(tolerances.planarity_metres) + " m, " +
                  number_text(tolerances.planarity_degrees) + "\xC2\xB0");
  append_fact(html, "snap", number_text(tolerances.snap_metres) + " m");
  append_fact(html, "overlap", number_text(head_.overlap_metres) + " m");
  append_fact(html, "proof",
              head_.acceptance.proof == Proof::boundary
                  ? "boundary (exact tests)"
                  : "constrained Delaunay tetrahedralization");
  if (head_.is_strict) append_fact(html, "strict", "canonical triangles only");
  append_fact(html, "rule set", std::to_string(head_.acceptance.rule_set));
  html += "</dl></section>";
  return html;
}

std::string HtmlReport::cards() const {
  std::string html = "<div class=\"cards\">";
  html += verdict_card("Features", tally_.all_features());
  html += verdict_card("Solids", tally_.all_solids());
  html += settings_card();
  const std::string map = documents_ == 1 ? footprints_.svg() : "";
  if (!map.empty()) {
    append(html, {"<section class=\"card map\" style=\"grid-column:1/-1\"><h3>Map</h3>", map});
    html += "<div class=\"legend\"><span>each feature is a dot; those that are not valid are ";
    html += "coloured</span></div></section>";
  }
  if (!tally_.findings().empty()) html += codes_card();
  html += "</div>\n";
  if (documents_ > 1) {
    html += "<details class=\"card\" style=\"margin-top:16px\"><summary>Files</summary><ul>";
    for (const std::string& file : files_) append(html, {"<li>", html_text(file), "</li>"});
    if (documents_ > files_.size()) {
      append(html, {"<li>and ", count_text(documents_ - files_.size()), " more</li>"});
    }
    html += "</ul></details>";
  }
  return html;
}

std::string HtmlReport::table_top() const {
  if (rows_.empty()) return "<h2 id=\"findings\">No findings</h2>";
  std::string html = "<h2 id=\"findings\">Findings</h2>";
  if (findings_ + tally_.omitted() > rows_.size()) {
    append(html,
           {"<p class=\"soft\">The first ", count_text(rows_.size()), " of ",
            count_text(findings_ + tally_.omitted()), " findings; the JSON report has more.</p>"});
  }
  append(html, {"<p class=\"soft\">", counted(pictures_, "picture")});
  html += ": <span class=\"key\" style=\"background:var(--a)\"></span>the facet concerned ";
  html += "<span class=\"key\" style=\"background:var(--b)\"></span>the other of a pair ";
  html += "<span class=\"key\" style=\"background:var(--w)\"></span>the exact place, or edges ";
  html += "concerned. Select a picture to enlarge and turn it.</p>";
  html += "<div class=\"tools\"><input id=\"search\" type=\"search\" ";
  html += "placeholder=\"Filter by id, facet, words\" aria-label=\"Filter\">";
  html += "<select id=\"code\" aria-label=\"Code\"><option value=\"\">all codes</option>";
  html += "<option value=\"error\">errors</option><option value=\"warning\">warnings</option>";
  for (const auto& [code, count] : tally_.findings()) {
    const std::string number = std::to_string(code);
    append(html, {"<option value=\"", number, "\">", number, " "});
    html += html_text(name_of(code));
    html += "</option>";
  }
  html += "</select><span id=\"shown\" class=\"soft\" role=\"status\">";
  append(html, {counted(rows_.size(), "finding"), "</span></div>"});
  html += "<div class=\"findings\"><table><thead><tr><th>Picture</th>";
  html += "<th><button data-key=\"code\">Finding</button></th>";
  html += "<th><button data-key=\"object\">Where</button></th>";
  html += "<th><button data-key=\"measured\">Measured</button></th>";
  return html + "<th>What to do</th></tr></thead><tbody>\n";
}

std::string HtmlReport::bottom() const {
  std::string html;
  if (!rows_.empty()) {
    html += "</tbody></table></div><dialog aria-label=\"Finding\">";
    html += "<button class=\"close\">Close</button><figure></figure>";
    html += "<div class=\"text\"><p class=\"soft\">Drag to turn, scroll to zoom.</p>";
    html += "<div class=\"content\"></div></div></dialog>";
  }
  html += "<footer>";
  for (const std::string& note : notes_) append(html, {"<p>Note: ", html_text(note), "</p>"});
  html +=
      "<p>All decisions are exact, on the coordinates as written. Facets are numbered from 0 in "
      "the ";
  html +=
      "order of the document, lines from 1. This page holds everything it shows and loads "
      "nothing.</p>";
  html += "</footer></main><script>";
  html += kPageScript;
  return html + "</script></body></html>\n";
}

}  // namespace

std::unique_ptr<FeatureReport> html_report(TextSink sink, ReportHead head,
                                           const HtmlOptions& options) {
  return std::make_unique<HtmlReport>(std::move(sink), std::move(head), options);
}

}  // namespace watertight::report
