// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repair_json.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "validate/finding_kinds.h"

namespace watertight::repair {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const HoleFill& hole) {
  Json json;
  json["shell"] = hole.shell;
  json["loops"] = hole.loops;
  json["vertices"] = hole.vertices;
  json["facets"] = hole.facets;
  json["method"] = hole.method;
  const bool is_optimum = hole.method == "delaunay" || hole.method == "all";
  if (is_optimum) {
    json["angle"] = hole.angle;
    json["area"] = hole.area;
  }
  if (!hole.reason.empty()) json["reason"] = hole.reason;
  return json;
}

std::string_view name_of(Repaired::Outcome outcome) {
  switch (outcome) {
    case Repaired::Outcome::valid_as_read:
      return "valid-as-read";
    case Repaired::Outcome::repaired:
      return "repaired";
    case Repaired::Outcome::not_repaired:
      return "not-repaired";
  }
  return "";
}

}  // namespace

std::string repair_json(const Repaired& repaired, const Changes& changes) {
  Json json;
  json["outcome"] = name_of(repaired.outcome);
  json["remedies"] = Json::array();
  for (const Remedy remedy : repaired.remedies) json["remedies"].push_back(to_string(remedy));
  json["codes_before"] = Json::array();
  for (const int code : validate::error_codes(repaired.before.findings)) {
    json["codes_before"].push_back(code);
  }
  json["facets_added"] = changes.facets_added;
  json["facets_removed"] = changes.facets_removed;
  json["facets_turned"] = changes.facets_turned;
  json["vertices_moved"] = repaired.moves.vertices;
  json["largest_move"] = repaired.moves.largest_metres;
  json["area_added"] = changes.area_added;
  if (repaired.after && repaired.after->report.measures) {
    json["volume"] = repaired.after->report.measures->volume;
  }
  json["holes"] = Json::array();
  for (const HoleFill& hole : repaired.holes) json["holes"].push_back(json_of(hole));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace watertight::repair
