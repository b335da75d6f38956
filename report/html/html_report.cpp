// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "geometry/measures.h"
#include "report/feature_report.h"
#include "report/html/curved_rows.h"
#include "report/html/footprints.h"
#include "report/html/html_page.h"
#include "report/html/html_rows.h"
#include "report/html/repair_rows.h"
#include "report/tally.h"
#include "validate/finding_kinds.h"

namespace watertight::report {
namespace {

/// The most documents that the page lists by name; more documents are only counted.
constexpr std::size_t kMostFiles = 200;

class HtmlReport final : public FeatureReport {
 public:
  HtmlReport(TextSink sink, ReportHead head, const HtmlOptions& options)
      : sink_(std::move(sink)), head_(std::move(head)), rows_(options) {}

  Status begin_document(const DocumentHead& document) override {
    file_ = document.file;
    ++documents_;
    if (files_.size() < kMostFiles) files_.push_back(document.file);
    return Done{};
  }

  Status add(const pipeline::ValidatedFeature& feature) override {
    tally_.add(feature.inspected);
    footprints_.add(feature.inspected);
    findings_ += findings_of(feature.inspected).size();
    rows_.add(file_, feature.inspected);
    curved_.add(feature.inspected);
    repairs_.add(feature.inspected);
    return Done{};
  }

  Status add_error(const Error& error) override {
    tally_.add_error(code_of(error));
    ++findings_;
    rows_.add_error(file_, error);
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
    for (const std::string& part :
         {top(), cards(), curved_.html(), repairs_.html(tally_.repairs()), table_top()}) {
      const Status status = sink_(part);
      if (!status) return status;
    }
    const Status status = rows_.write(sink_);
    return status ? sink_(bottom()) : status;
  }

 private:
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
  FindingRows rows_;
  Tally tally_;
  Footprints footprints_;
  CurvedRows curved_;
  RepairRows repairs_;
  std::string file_;
  std::vector<std::string> files_;
  std::vector<std::string> notes_;
  std::size_t documents_ = 0;
  std::uint64_t findings_ = 0;
  double seconds_ = 0;
};

std::string HtmlReport::banner() const {
  const VerdictCount features = tally_.all_features();
  const bool is_unchecked =
      tally_.all_solids().total() + tally_.surfaces().checked == 0 && tally_.findings().empty();
  const Verdict verdict = is_unchecked ? Verdict::undecided : tally_.verdict();
  std::string html = "<div class=\"banner ";
  html += validate::to_string(verdict);
  html += "\"><svg viewBox=\"0 0 24 24\" fill=\"none\" stroke=\"#fff\" stroke-width=\"2.4\" ";
  html += "stroke-linecap=\"round\" aria-hidden=\"true\"><circle cx=\"12\" cy=\"12\" r=\"10\"/>";
  html += verdict == Verdict::valid     ? "<path d=\"M7.5 12.5l3 3 6-6.5\"/>"
          : verdict == Verdict::invalid ? "<path d=\"M8.5 8.5l7 7M15.5 8.5l-7 7\"/>"
                                        : "<path d=\"M12 7v6M12 16.5v.1\"/>";
  html += "</svg><span>";
  if (is_unchecked) return html + "Nothing was checked: there are no solids.</span></div>";
  if (tally_.unreadable() > 0) {
    append(html, {counted(tally_.unreadable(), "part"), " of the input could not be read. "});
  }
  if (features.total() == 0) {
    html += "No features were validated.";
  } else if (features.valid == features.total() && tally_.all_solids().total() == 0) {
    append(html, {"There are no solids; rings and facets of ",
                  counted(tally_.surfaces().checked, "surface"), " were checked."});
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
  std::string title = head_.repair ? "Repair report" : "Validation report";
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
  if (head_.repair) append_fact(html, "remedies", remedies_text(*head_.repair));
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
  if (rows_.rows() == 0) return "<h2 id=\"findings\">No findings</h2>";
  std::string html = "<h2 id=\"findings\">Findings</h2>";
  if (findings_ + tally_.omitted() > rows_.rows()) {
    append(html,
           {"<p class=\"soft\">The first ", count_text(rows_.rows()), " of ",
            count_text(findings_ + tally_.omitted()), " findings; the JSON report has more.</p>"});
  }
  append(html, {"<p class=\"soft\">", counted(rows_.pictures(), "picture")});
  html += ": <span class=\"key\" style=\"background:var(--a)\"></span>the facet concerned ";
  html += "<span class=\"key\" style=\"background:var(--b)\"></span>the other of a pair ";
  html += "<span class=\"key\" style=\"background:var(--w)\"></span>the exact place, or edges ";
  html +=
      "concerned. Select a picture to enlarge and turn it. A finding without a picture of its own "
      "shows ";
  html += "the example of its code.</p>";
  html += "<svg class=\"symbols\" aria-hidden=\"true\">";
  for (const auto& [code, count] : tally_.findings()) html += figure_symbol(code);
  html += "</svg>";
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
  append(html, {counted(rows_.rows(), "finding"), "</span></div>"});
  html += "<div class=\"findings\"><table><thead><tr><th>Picture</th>";
  html += "<th><button data-key=\"code\">Finding</button></th>";
  html += "<th><button data-key=\"object\">Where</button></th>";
  html += "<th><button data-key=\"measured\">Measured</button></th>";
  return html + "<th>What to do</th></tr></thead></table>\n";
}

std::string HtmlReport::bottom() const {
  std::string html;
  if (rows_.rows() > 0) {
    html += "</div><dialog aria-label=\"Finding\">";
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
