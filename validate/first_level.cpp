// SPDX-License-Identifier: GPL-3.0-or-later
//
// val3dity's cascade: per facet the first failing test ends the facet; facets must all pass before
// a shell is looked at, shells before the solid.
#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>

#include "validate/rules.h"

namespace watertight {
namespace {

using Codes = std::set<int>;

bool has(const Codes& codes, int code) { return codes.count(code) != 0; }

/// The first of `order` that is in `codes`, alone.
Codes first_of(const Codes& codes, std::initializer_list<int> order) {
  for (const int code : order) {
    if (has(codes, code)) return {code};
  }
  return {};
}

Codes of_facet(const Codes& codes) {
  Codes result = first_of(
      codes, {kTooFewPoints, kConsecutivePointsSame, kNonPlanarDistance, kRingSelfIntersection});
  if (!result.empty()) return result;
  result = first_of(codes, {kIntersectionRings, kDuplicatedRings, kInnerRingOutside,
                            kInnerRingsNested, kInteriorDisconnected});
  if (has(codes, kOrientationRingsSame)) result.insert(kOrientationRingsSame);
  return result;
}

Codes of_shell(const Codes& codes) {
  if (has(codes, kTooFewPolygons)) return {kTooFewPolygons};
  Codes result;
  for (const int code : {kNonManifold, kPolygonWrongOrientation}) {
    if (has(codes, code)) result.insert(code);
  }
  if (!result.empty()) return result;
  return first_of(codes, {kMultipleComponents, kShellNotClosed, kShellSelfIntersection});
}

}  // namespace

std::vector<int> first_level_codes(const std::vector<Finding>& findings) {
  std::map<Index, Codes> of_facets;
  std::map<Index, Codes> of_shells;
  Codes result;
  Codes folds;
  Codes of_solid;
  for (const Finding& finding : findings) {
    if (finding.severity != Severity::error) continue;
    const int level = finding_level(finding.code);
    if (level == 0) result.insert(finding.code);
    if (finding.code == kNonPlanarNormals) {
      folds.insert(finding.code);
    } else if (level == 1 || level == 2) {
      of_facets[finding.place.facet].insert(finding.code);
    } else if (level == 3) {
      of_shells[finding.place.shell].insert(finding.code);
    } else if (level == 4) {
      of_solid.insert(finding.code);
    }
  }
  const auto gather = [&](const std::map<Index, Codes>& groups, auto choose) {
    for (const auto& [place, codes] : groups) {
      Codes chosen = choose(codes);
      result.merge(chosen);
    }
  };
  if (result.empty()) gather(of_facets, of_facet);
  if (result.empty()) result = folds;
  if (result.empty()) gather(of_shells, of_shell);
  if (result.empty()) result = of_solid;
  return {result.begin(), result.end()};
}

}  // namespace watertight
