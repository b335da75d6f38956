// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.h"
#include "pipeline/repaired/repair_document.h"
#include "repair/summary_json.h"

namespace watertight::pipeline {

std::string repair_report_json(const DocumentRepair& outcome) {
  std::uint64_t repaired = 0;
  for (const SolidRepair& repair : outcome.repairs) repaired += repair.is_repaired() ? 1 : 0;
  JsonText json;
  json.open('{').key("features").value(outcome.features).key("solids").value(outcome.solids);
  json.key("valid_as_read").value(outcome.valid_as_read).key("repaired").value(repaired);
  json.key("repairs").open('[');
  for (const SolidRepair& repair : outcome.repairs) {
    const SolidSource& source = repair.source;
    json.open('{').key("feature").value(repair.feature).key("object").value(source.object_id);
    if (!source.lod.empty()) json.key("lod").value(source.lod);
    if (!source.pointer.empty()) json.key("pointer").value(source.pointer);
    json.key("repair").raw(repair::summary_json(repair.summary)).close('}');
  }
  json.close(']').close('}');
  return std::move(json).take();
}

}  // namespace watertight::pipeline
