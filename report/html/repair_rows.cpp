// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html/repair_rows.h"

#include "pipeline/repaired/repair_notes.h"
#include "report/html/html_page.h"
#include "report/place.h"

namespace watertight::report {
namespace {

/// The most rows of the table.
constexpr std::uint64_t kMostRows = 1000;

std::string codes_text(const std::set<int>& codes) {
  std::string text;
  for (const int code : codes) {
    if (!text.empty()) text += ", ";
    text += std::to_string(code);
  }
  return text;
}

}  // namespace

void RepairRows::add(const pipeline::InspectedFeature& feature) {
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    if (!solid.repair || row_count_ == kMostRows) continue;
    ++row_count_;
    const SolidSource& source = solid.source;
    const std::string& name = source.object_id.empty() ? feature.feature.id : source.object_id;
    append(rows_, {"<tr class=\"", is_repaired(*solid.repair) ? "repaired" : "left",
                   "\"><td class=\"name\">", html_text(shortened(name))});
    if (!source.lod.empty()) {
      append(rows_, {" <span class=\"tag\">LoD ", html_text(shortened(source.lod)), "</span>"});
    }
    append(rows_, {"</td><td>", codes_text(solid.repair->codes_before), "</td><td>",
                   html_text(pipeline::account_of(*solid.repair)), "</td></tr>"});
  }
}

std::string RepairRows::html(const RepairCount& count) const {
  if (row_count_ == 0) return "";
  const std::uint64_t all = count.repaired + count.left;
  std::string html = "<h2 id=\"repairs\">Repairs</h2><p class=\"soft\">";
  append(html, {count_text(count.repaired), " of ", counted(all, "invalid solid"),
                " could be repaired. "});
  if (all > row_count_) {
    append(html, {"The first ", count_text(row_count_), " are shown; the JSON report has all. "});
  }
  append(html, {"The findings below are about the document after the repair.</p>",
                "<div class=\"listing repairs\"><table><thead><tr><th>Solid</th>",
                "<th>Codes as read</th><th>Outcome</th></tr></thead><tbody>", rows_,
                "</tbody></table></div>"});
  return html;
}

std::string remedies_text(const repair::RepairOptions& options) {
  std::string text;
  for (const repair::Remedy remedy : options.remedies) {
    if (remedy == repair::Remedy::weld && options.weld_metres == 0) continue;
    if (!text.empty()) text += ", ";
    text += repair::to_string(remedy);
    if (remedy == repair::Remedy::weld) text += " (" + number_text(options.weld_metres) + " m)";
  }
  return text;
}

}  // namespace watertight::report
