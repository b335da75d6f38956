// SPDX-License-Identifier: GPL-3.0-or-later
//
// Let A be the region inside the exterior shell of a solid X, A_i the regions of its cavities, and
// B, B_j those of Y.
//
// (1) The interiors of X and Y are disjoint if and only if the interiors of A and B are disjoint,
//     or B lies in one A_i, or A lies in one B_j. Proof: the interior of Y is connected. If it
//     misses X, it lies in the closed regions that X leaves: outside A, A_1, A_2, ... Two of these
//     regions have at most points and segments in common, which do not divide an open connected
//     set, so the interior of Y lies in one region. If that region is an A_i, B is in A_i too: the
//     outside of A_i is connected, reaches infinity and meets no point of B's surface. If the
//     region is the outside of A, then A misses Y; the same argument for A, which is connected,
//     shows that A lies outside B or in one B_j.
// (2) X and Y are equal if and only if A = B and each cavity of one is a cavity of the other: the
//     regions that a solid leaves are determined by its points.
//
// Every question is about two regions with one shell each (validate/overlap/region_relation.h).
#include "validate/overlap/solid_overlap.h"

#include <algorithm>
#include <map>

#include "geometry/measures.h"

namespace watertight::validate {
namespace {

bool are_same(const Box& a, const Box& b) { return a.min == b.min && a.max == b.max; }

/// False only if two regions differ: equal regions have equal boxes and equal volumes.
bool may_be_equal(const RegionSurface& a, const RegionSurface& b) {
  return are_same(a.box(), b.box()) && geometry::six_volume(a.vertices(), a.triangles()) ==
                                           geometry::six_volume(b.vertices(), b.triangles());
}

class SolidComparison {
 public:
  SolidComparison(const SolidSurface& first, const SolidSurface& second, const CancelPoll& cancel)
      : first_(first), second_(second), cancel_(cancel) {}

  SolidRelation run() {
    const bool ask = may_be_equal(first_.exterior(), second_.exterior());
    const RegionRelation outer =
        relate_regions(first_.exterior(), second_.exterior(), {ask, ask}, cancel_);
    result_.is_cancelled = outer.is_cancelled;
    result_.share_area = outer.touch_back_to_back;
    if (outer.is_cancelled || !outer.do_overlap) return result_;
    if (is_in_cavity(second_.exterior(), first_) || is_in_cavity(first_.exterior(), second_)) {
      return result_;
    }
    result_.do_overlap = true;
    result_.facet = outer.facet;
    result_.other_facet = outer.other_facet;
    if (outer.facet == kNone || outer.other_facet == kNone) name_crossing_facets();
    result_.are_equal = outer.is_first_inside && outer.is_second_inside && have_equal_cavities();
    return result_;
  }

 private:
  RegionRelation ask(const RegionSurface& a, const RegionSurface& b, RegionQuestions questions) {
    if (result_.is_cancelled || !a.box().overlaps(b.box())) return {};
    const RegionRelation relation = relate_regions(a, b, questions, cancel_);
    result_.is_cancelled = relation.is_cancelled;
    return relation;
  }

  /// True if a region lies in a cavity of the solid, or if the comparison was cancelled. The solids
  /// then share an area where the region reaches the wall of the cavity.
  bool is_in_cavity(const RegionSurface& region, const SolidSurface& solid) {
    for (const RegionSurface& cavity : solid.cavities()) {
      if (!contains(cavity.box(), region.box())) continue;
      const RegionRelation relation = ask(region, cavity, {true, false});
      if (!relation.is_first_inside || relation.is_cancelled) continue;
      result_.share_area = relation.touch_side_by_side;
      return true;
    }
    return result_.is_cancelled;
  }

  /// If one exterior shell is inside the other, no two facets of these shells show the overlap. A
  /// facet of a cavity and a facet of the exterior shell of the other solid may then show it.
  void name_crossing_facets() {
    for (const RegionSurface& cavity : first_.cavities()) {
      const RegionRelation relation = ask(cavity, second_.exterior(), {});
      if (name_facets(relation.facet, relation.other_facet)) return;
    }
    for (const RegionSurface& cavity : second_.cavities()) {
      const RegionRelation relation = ask(first_.exterior(), cavity, {});
      if (name_facets(relation.facet, relation.other_facet)) return;
    }
  }

  bool name_facets(Index facet, Index other_facet) {
    if (facet == kNone || other_facet == kNone) return false;
    result_.facet = facet;
    result_.other_facet = other_facet;
    return true;
  }

  /// True if each cavity of one solid equals a cavity of the other. The cavities of a solid are
  /// disjoint, so no two of them equal one cavity of the other solid.
  bool have_equal_cavities() {
    if (first_.cavities().size() != second_.cavities().size()) return false;
    std::map<std::pair<Point, Point>, std::vector<const RegionSurface*>> by_box;
    for (const RegionSurface& cavity : second_.cavities()) {
      by_box[{cavity.box().min, cavity.box().max}].push_back(&cavity);
    }
    return std::all_of(first_.cavities().begin(), first_.cavities().end(), [&](const auto& cavity) {
      const auto& candidates = by_box[{cavity.box().min, cavity.box().max}];
      return std::any_of(candidates.begin(), candidates.end(), [&](const RegionSurface* other) {
        if (!may_be_equal(cavity, *other)) return false;
        const RegionRelation relation = ask(cavity, *other, {true, true});
        return relation.is_first_inside && relation.is_second_inside;
      });
    });
  }

  const SolidSurface& first_;
  const SolidSurface& second_;
  const CancelPoll& cancel_;
  SolidRelation result_;
};

}  // namespace

SolidSurface::SolidSurface(const Solid& solid, std::span<const Point> vertices,
                           const tessellate::FacetTriangles& facets)
    : boundary_(surface_of_shells(solid, vertices, facets, {0, solid.shell_count()}, false)) {
  if (solid.shell_count() == 1) return;
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    shells_.push_back(surface_of_shells(solid, vertices, facets, {shell, shell + 1}, shell > 0));
  }
}

SolidRelation relate(const SolidSurface& first, const SolidSurface& second,
                     const CancelPoll& cancel) {
  if (!first.boundary().box().overlaps(second.boundary().box())) return {};
  return SolidComparison(first, second, cancel).run();
}

}  // namespace watertight::validate
