// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/outcome_json.h"

#include <cstdint>

namespace watertight {
namespace {

void write_solid(JsonText& json, const SolidOutcome& solid) {
  const SolidSource& source = solid.source;
  json.open('{').key("object").value(source.object_id);
  json.key("geometryType").value(source.geometry_type);
  if (!source.lod.empty()) json.key("lod").value(source.lod);
  json.key("geometry").value(source.geometry).key("ordinal").value(source.ordinal);
  if (!source.pointer.empty()) json.key("pointer").value(source.pointer);
  if (solid.blob_bytes > 0) json.key("blobBytes").value(std::uint64_t{solid.blob_bytes});
  json.key("report").raw(solid.report_json).close('}');
}

}  // namespace

std::string measures_json(const Measures& measures) {
  JsonText json;
  json.open('{').key("volume").value(measures.volume).key("area").value(measures.area);
  json.key("boxMin").value(measures.box_min).key("boxMax").value(measures.box_max);
  json.key("genus").value(measures.genus).key("vertices").value(measures.vertices);
  json.key("facets").value(measures.facets).key("rings").value(measures.rings);
  json.key("shells").value(measures.shells).close('}');
  return json.take();
}

std::string outcome_json(const IngestOutcome& outcome) {
  JsonText json;
  json.open('{').key("verdict").value(to_string(outcome.verdict));
  json.key("stored").value(std::uint64_t{outcome.stored});
  json.key("features").open('[');
  for (const FeatureOutcome& feature : outcome.features) {
    json.open('{').key("id").value(feature.id);
    json.key("verdict").value(to_string(feature.verdict));
    json.key("stored").value(feature.is_stored).key("solids").open('[');
    for (const SolidOutcome& solid : feature.solids) write_solid(json, solid);
    json.close(']').close('}');
  }
  json.close(']').close('}');
  return json.take();
}

}  // namespace watertight
