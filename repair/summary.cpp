// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/summary.h"

#include <vector>

#include "geometry/vector3.h"
#include "tessellate/facets.h"
#include "validate/finding_kinds.h"

namespace watertight::repair {
namespace {

using geometry::Vector3;

/// The facets of an edited solid, in their order.
std::vector<const EditedFacet*> facets_of(const EditedSolid& solid) {
  std::vector<const EditedFacet*> facets;
  for (const auto& shell : solid.shells) {
    for (const EditedFacet& facet : shell) facets.push_back(&facet);
  }
  return facets;
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

void count_facets(const Solid& submitted, const EditedSolid& edits, RepairSummary& summary) {
  const EditedSolid before = edited(submitted);
  const std::vector<const EditedFacet*> old = facets_of(before);
  const std::vector<const EditedFacet*> facets = facets_of(edits);
  const Vector3 units = metres_per_unit(before);
  std::vector<std::size_t> parts(old.size());
  for (const EditedFacet* facet : facets) {
    if (facet->source == kNone) {
      ++summary.facets_added;
    } else {
      ++parts[facet->source];
    }
  }
  for (const std::size_t count : parts) {
    if (count == 1) continue;
    ++summary.facets_removed;
    summary.facets_added += count;
  }
  for (const EditedFacet* facet : facets) {
    if (facet->source == kNone || parts[facet->source] != 1) continue;
    const double agreement = geometry::dot(area_vector(before, old[facet->source]->rings[0], units),
                                           area_vector(edits, facet->rings[0], units));
    if (agreement < 0) ++summary.facets_turned;
  }
  summary.area_added = new_area(edits, facets);
}

}  // namespace

RepairSummary summary_of(const Solid& submitted, const Repaired& repaired) {
  RepairSummary summary;
  summary.outcome = repaired.outcome;
  summary.undecided_reason = repaired.undecided_reason.empty() ? repaired.before.undecided_reason
                                                               : repaired.undecided_reason;
  summary.is_undecided = repaired.is_stopped || repaired.before.verdict == Verdict::undecided ||
                         !repaired.undecided_reason.empty();
  summary.codes_before = validate::error_codes(repaired.before.findings);
  summary.holes = repaired.holes;
  if (!repaired.edits) return summary;
  summary.remedies = repaired.remedies;
  count_facets(submitted, *repaired.edits, summary);
  summary.moves = repaired.moves;
  if (repaired.after->report.measures) summary.volume = repaired.after->report.measures->volume;
  return summary;
}

}  // namespace watertight::repair
