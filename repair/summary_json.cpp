// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/summary_json.h"

#include <string_view>

#include "base/json_text.h"

namespace watertight::repair {
namespace {

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

void write_smooth(JsonText& json, const SmoothMeasures& smooth) {
  json.key("smooth").open('{').key("vertices").value(std::uint64_t{smooth.vertices});
  json.key("unknowns").value(std::uint64_t{smooth.unknowns}).key("energy").value(smooth.energy);
  json.key("condition").value(smooth.condition).key("stretch").value(smooth.stretch);
  json.key("value_jump").value(smooth.value_jump).key("normal_jump").value(smooth.normal_jump);
  json.key("border_distance").value(smooth.border_distance);
  json.key("least_curvature").value(smooth.least_curvature);
  json.key("largest_curvature").value(smooth.largest_curvature);
  json.key("mean_turn").value(smooth.mean_turn).key("largest_turn").value(smooth.largest_turn);
  json.close('}');
}

void write_hole(JsonText& json, const HoleFill& hole) {
  json.open('{').key("shell").value(hole.shell);
  json.key("loops").value(std::uint64_t{hole.loops});
  json.key("vertices").value(std::uint64_t{hole.vertices});
  json.key("facets").value(std::uint64_t{hole.facets}).key("method").value(hole.method);
  if (hole.method == "delaunay" || hole.method == "all") {
    json.key("angle").value(hole.angle).key("area").value(hole.area);
    json.key("alternatives").value(std::uint64_t{hole.alternatives});
  }
  if (!hole.reason.empty()) json.key("reason").value(hole.reason);
  if (hole.smooth) write_smooth(json, *hole.smooth);
  if (!hole.smooth_refusal.empty()) {
    json.key("not_smooth").open('{').key("reason").value(hole.smooth_refusal);
    json.key("detail").value(hole.smooth_detail).close('}');
  }
  json.close('}');
}

}  // namespace

std::string summary_json(const RepairSummary& summary) {
  JsonText json;
  json.open('{').key("outcome").value(name_of(summary.outcome));
  if (!is_repaired(summary) && !summary.undecided_reason.empty()) {
    json.key("undecided_reason").value(summary.undecided_reason);
  }
  json.key("remedies").open('[');
  for (const Remedy remedy : summary.remedies) json.value(to_string(remedy));
  json.close(']').key("codes_before").open('[');
  for (const int code : summary.codes_before) json.value(std::int64_t{code});
  json.close(']').key("facets_added").value(std::uint64_t{summary.facets_added});
  json.key("facets_removed").value(std::uint64_t{summary.facets_removed});
  json.key("facets_turned").value(std::uint64_t{summary.facets_turned});
  json.key("vertices_moved").value(std::uint64_t{summary.moves.vertices});
  json.key("largest_move").value(summary.moves.largest_metres);
  json.key("area_added").value(summary.area_added);
  if (summary.volume) json.key("volume").value(*summary.volume);
  json.key("holes").open('[');
  for (const HoleFill& hole : summary.holes) write_hole(json, hole);
  json.close(']').close('}');
  return std::move(json).take();
}

}  // namespace watertight::repair
