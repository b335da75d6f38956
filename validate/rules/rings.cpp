// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rules of rings: enough points (101), no point twice in a row (102), closed (103), simple (104),
// and the relations of the rings of a facet (201, 202, 206, 207). Exact, in the facet's projection.
#include <algorithm>

#include "base/quantity.h"
#include "tessellate/ring_problems.h"
#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

/// The largest number of problems that are reported for a facet; if there are more, one finding is
/// counted as omitted.
constexpr std::size_t kMostProblemsPerFacet = 100;

bool check_points(ExaminedSolid& examined, Index facet) {
  const Solid& solid = examined.solid();
  const IndexRange rings = solid.rings_of(facet);
  bool is_good = true;
  if (rings.size() == 0) {
    examined.findings.add({.code = kTooFewPoints,
                           .place = examined.at_facet(facet),
                           .measured = 0,
                           .limit = 3,
                           .unit = "points",
                           .detail = "the facet has no ring"});
    return false;
  }
  for (Index number = 0; number < rings.size(); ++number) {
    const std::span<const Index> ring = solid.ring(rings.begin + number);
    if (ring.size() < 3) {
      examined.findings.add({.code = kTooFewPoints,
                             .place = examined.at_ring(facet, number),
                             .measured = static_cast<double>(ring.size()),
                             .limit = 3,
                             .unit = "points",
                             .detail = "the ring has " + quantity(ring.size(), "point")});
      is_good = false;
      continue;
    }
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ring[i] != ring[(i + 1) % ring.size()]) continue;
      examined.findings.add({.code = kConsecutivePointsSame,
                             .place = examined.at_corner(facet, number, i + 1),
                             .witness = examined.world(ring[i]),
                             .detail = "the point equals the one before it"});
      is_good = false;
    }
  }
  return is_good;
}

Finding finding_of(const ExaminedSolid& examined, Index facet,
                   const tessellate::RingProblem& problem) {
  Finding finding;
  finding.place = problem.edge == kNone ? examined.at_ring(facet, problem.ring)
                                        : examined.at_corner(facet, problem.ring, problem.edge);
  if (problem.other_ring != kNone) {
    finding.other = problem.other_edge == kNone
                        ? examined.at_ring(facet, problem.other_ring)
                        : examined.at_corner(facet, problem.other_ring, problem.other_edge);
  }
  finding.witness = examined.world(problem.witness);
  switch (problem.kind) {
    case tessellate::RingProblemKind::collapsed:
      finding.code = kRingSelfIntersection;
      finding.detail = "all points of the ring lie on one line";
      break;
    case tessellate::RingProblemKind::self_contact:
      finding.code = kRingSelfIntersection;
      finding.detail = "the edges that start at these vertices meet";
      break;
    case tessellate::RingProblemKind::rings_meet:
      finding.code = kIntersectionRings;
      finding.detail = "the rings meet other than in a shared vertex";
      break;
    case tessellate::RingProblemKind::same_ring:
      finding.code = kDuplicatedRings;
      finding.detail = "the rings have the same vertices";
      break;
    case tessellate::RingProblemKind::outside_exterior:
      finding.code = kInnerRingOutside;
      finding.detail = "the interior ring lies outside the exterior ring";
      break;
    case tessellate::RingProblemKind::nested:
      finding.code = kInnerRingsNested;
      finding.detail = "the interior ring lies inside another interior ring";
      break;
  }
  return finding;
}

/// Reports a facet without a triangulation for which the search found no more precise reason.
void report_no_region(ExaminedSolid& examined, Index facet) {
  examined.findings.add({.code = examined.solid().rings_of(facet).size() == 1
                                     ? kRingSelfIntersection
                                     : kIntersectionRings,
                         .place = examined.at_facet(facet),
                         .detail = "the rings bound no region in the facet's projection"});
}

void check_shape(ExaminedSolid& examined, Index facet) {
  const tessellate::RingProblems found = tessellate::ring_problems(
      examined.solid(), facet, kMostProblemsPerFacet, [&] { return examined.ask_cancelled(); });
  for (const tessellate::RingProblem& problem : found.problems) {
    examined.findings.add(finding_of(examined, facet, problem));
  }
  if (!found.is_complete) examined.findings.omit(1);
  if (found.problems.empty()) report_no_region(examined, facet);
}

}  // namespace

void check_not_empty(ExaminedSolid& examined) {
  if (examined.solid().facet_count() > 0) return;
  examined.findings.add({.code = kEmptyPrimitive, .detail = "the solid has no facets"});
}

void check_closed_rings(ExaminedSolid& examined, std::span<const Index> unclosed) {
  const Solid& solid = examined.submitted();
  const std::vector<Index>& offsets = solid.arrays().facet_offsets;
  for (const Index ring : unclosed) {
    if (ring >= solid.ring_count()) continue;
    const auto next = std::upper_bound(offsets.begin(), offsets.end(), ring);
    const auto facet = static_cast<Index>(next - offsets.begin() - 1);
    Finding finding;
    finding.code = kRingNotClosed;
    finding.place = solid.ring(ring).empty() ? examined.at_ring(facet, ring - offsets[facet])
                                             : examined.at_corner(facet, ring - offsets[facet], 0);
    if (!solid.ring(ring).empty()) finding.witness = solid.world(finding.place.vertex);
    finding.detail = "the ring does not end with its first point, as its format demands";
    examined.findings.add(std::move(finding));
  }
}

void check_rings(ExaminedSolid& examined) {
  Index unshaped = kNone;
  for (Index facet = 0; facet < examined.solid().facet_count(); ++facet) {
    const bool has_points = check_points(examined, facet);
    const bool is_cancelled = examined.is_cancelled();
    const bool is_triangulated =
        examined.triangles().state[facet] == tessellate::FacetState::triangulated;
    if (has_points && is_triangulated) continue;
    examined.mark_faulty(facet);
    if (has_points && is_cancelled) {
      report_no_region(examined, facet);
    } else if (has_points) {
      check_shape(examined, facet);
    } else if (unshaped == kNone) {
      unshaped = facet;
    }
  }
  if (examined.was_cancelled())
    examined.findings.skip({104, 201, 202, 206, 207}, "the search was cancelled");
  if (unshaped != kNone) {
    examined.findings.skip(
        {104, 201, 202, 203, 204, 205, 206, 207, 208},
        "not on facets with finding 101 or 102 (first: facet " + std::to_string(unshaped) + ")");
  }
}

}  // namespace watertight::validate
