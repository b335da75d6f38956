// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html/curved_rows.h"

#include "report/html/html_page.h"
#include "report/place.h"
#include "validate/finding_kinds.h"

namespace watertight::report {
namespace {

constexpr std::uint64_t kMostCurvedRows = 1000;
constexpr std::size_t kMostFacesNamed = 20;

/// What a reader of the row has to know beside the numbers.
std::string remarks_on(const formats::Tessellation& made) {
  std::string html;
  const auto add = [&](std::initializer_list<std::string_view> parts) {
    html += "<p>";
    append(html, parts);
    html += "</p>";
  };
  for (std::size_t i = 0; i < made.left_out.size() && i < kMostFacesNamed; ++i) {
    const auto& [face, reason] = made.left_out[i];
    add({"face ", html_text(shortened(face)), " is left out: ", html_text(shortened(reason))});
  }
  if (made.left_out.size() > kMostFacesNamed) {
    add({counted(made.left_out.size() - kMostFacesNamed, "more face"), " left out"});
  }
  if (made.halvings > 0) {
    add({"chord halved ", counted(static_cast<std::uint64_t>(made.halvings), "time"),
         " until no facets crossed"});
  }
  if (made.turned > 0) add({counted(made.turned, "face"), " turned"});
  if (made.gap > made.chord) add({"edges up to ", number_text(made.gap), " m off faces"});
  return html;
}

}  // namespace

void CurvedRows::add(const pipeline::InspectedFeature& feature) {
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    if (!solid.tessellation) continue;
    const formats::Tessellation& made = *solid.tessellation;
    left_out_ += made.left_out.size();
    if (++count_ > kMostCurvedRows) continue;
    const SolidSource& source = solid.source;
    const std::string& name = source.object_id.empty() ? feature.feature.id : source.object_id;
    const std::string_view verdict = validate::to_string(solid.inspection.report.verdict);
    append(rows_, {"<tr><td class=\"name\">", html_text(shortened(name)), "</td><td>", verdict,
                   "</td><td class=\"num\">", count_text(made.faces), "</td><td class=\"num\">"});
    if (const auto& measures = solid.inspection.report.measures) {
      append(rows_, {count_text(measures->facets), "</td><td class=\"num\">",
                     number_text(measures->volume)});
    } else {
      append(rows_, {"</td><td class=\"num\">"});
    }
    append(rows_,
           {"</td><td class=\"num\">", number_text(made.chord_error), " <span class=\"soft\">of ",
            number_text(made.chord), "</span></td><td>", remarks_on(made), "</td></tr>"});
  }
}

std::string CurvedRows::html() const {
  if (count_ == 0) return "";
  std::string html = "<h2 id=\"curved\">Curved solids</h2><p class=\"soft\">";
  append(html, {counted(count_, "solid"), " became polyhedra. "});
  if (left_out_ > 0) append(html, {counted(left_out_, "face"), " left out. "});
  if (count_ > kMostCurvedRows) {
    append(html,
           {"The first ", count_text(kMostCurvedRows), " are shown; the JSON report has all. "});
  }
  append(html, {"The chord error is the largest measured distance of a triangle from its surface, "
                "beside its limit.</p>",
                "<div class=\"listing curved\"><table><thead><tr><th>Solid</th><th>Verdict</th>",
                "<th>Faces</th><th>Facets</th><th>Volume, m\xc2\xb3</th><th>Chord error, m</th>",
                "<th>Remarks</th></tr></thead><tbody>", rows_, "</tbody></table></div>"});
  return html;
}

}  // namespace watertight::report
