// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/changes.h"

#include <nlohmann/json.hpp>
#include <vector>

#include "geometry/vector3.h"
#include "tessellate/facets.h"
#include "validate/finding_kinds.h"

namespace watertight::repair {
namespace {

using geometry::Vector3;
using geometry::operator+;
using geometry::operator-;
using Json = nlohmann::ordered_json;

/// The facets of an edited solid, in their order.
std::vector<const EditedFacet*> facets_of(const EditedSolid& solid) {
  std::vector<const EditedFacet*> facets;
  for (const auto& shell : solid.shells) {
    for (const EditedFacet& facet : shell) facets.push_back(&facet);
  }
  return facets;
}

/// Twice the area vector of a ring, in square metres.
Vector3 area_vector(const EditedSolid& solid, const Ring& ring, const Vector3& units) {
  Vector3 area{};
  const Vector3 first = metres_of(solid, ring[0], units);
  for (std::size_t i = 2; i < ring.size(); ++i) {
    area = area + geometry::cross(metres_of(solid, ring[i - 1], units) - first,
                                  metres_of(solid, ring[i], units) - first);
  }
  return area;
}

/// The area of the facets that are new.
double new_area(const EditedSolid& edits, const std::vector<const EditedFacet*>& facets) {
  const Result<Solid> solid = solid_of(edits);
  if (!solid) return 0;
  const Vector3 units = metres_per_unit(edits);
  const tessellate::FacetTriangles triangles = tessellate::triangulate_facets(*solid);
  double area = 0;
  for (std::size_t i = 0; i < triangles.triangles.size(); ++i) {
    if (facets[triangles.facet_of[i]]->source != kNone) continue;
    const auto& [a, b, c] = triangles.triangles[i];
    area += geometry::length(area_vector(edits, {a, b, c}, units)) / 2;
  }
  return area;
}

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

Changes changes_of(const Solid& submitted, const Repaired& repaired) {
  Changes changes;
  if (!repaired.edits) return changes;
  const EditedSolid before = edited(submitted);
  const std::vector<const EditedFacet*> old = facets_of(before);
  const std::vector<const EditedFacet*> facets = facets_of(*repaired.edits);
  const Vector3 units = metres_per_unit(before);
  std::vector<std::size_t> parts(old.size());
  for (const EditedFacet* facet : facets) {
    if (facet->source == kNone) {
      ++changes.facets_added;
    } else {
      ++parts[facet->source];
    }
  }
  for (const std::size_t count : parts) {
    if (count == 1) continue;
    ++changes.facets_removed;
    changes.facets_added += count;
  }
  for (const EditedFacet* facet : facets) {
    if (facet->source == kNone || parts[facet->source] != 1) continue;
    const double agreement =
        geometry::dot(area_vector(before, old[facet->source]->rings[0], units),
                      area_vector(*repaired.edits, facet->rings[0], units));
    if (agreement < 0) ++changes.facets_turned;
  }
  changes.area_added = new_area(*repaired.edits, facets);
  return changes;
}

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
