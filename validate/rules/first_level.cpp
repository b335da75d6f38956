// SPDX-License-Identifier: GPL-3.0-or-later
//
// The order of tests in val3dity: an open ring (103) ends all tests while the file is read; the
// first failing test of a facet ends the tests of that facet; a shell is tested only if all its
// facets pass, the solid only if all shells pass; a shell turned the wrong way (405) ends the tests
// of the solid. val3dity reports 303 for a one-sided shell (300), because its builder cannot add
// the facet that closes the strip.
#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>

#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

using Codes = std::set<int>;

bool has(const Codes& codes, int code) { return codes.count(code) != 0; }

/// The first code of `order` that is in `codes`, or none.
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
  if (has(codes, kNonManifold) || has(codes, kNotValid2Manifold)) result.insert(kNonManifold);
  if (has(codes, kPolygonWrongOrientation)) result.insert(kPolygonWrongOrientation);
  if (!result.empty()) return result;
  return first_of(codes, {kMultipleComponents, kShellNotClosed, kShellSelfIntersection});
}

/// The codes of one shell.
struct ShellCodes {
  std::map<Index, Codes> facets;
  bool has_folds = false;
  Codes shell;

  /// The codes of the first level that fails: the facets, then 204, then the shell itself.
  Codes first_level() const {
    Codes result;
    for (const auto& [facet, codes] : facets) result.merge(of_facet(codes));
    if (!result.empty()) return result;
    if (has_folds) return {kNonPlanarNormals};
    return of_shell(shell);
  }
};

}  // namespace

std::vector<int> first_level_codes(const std::vector<Finding>& findings) {
  std::map<Index, ShellCodes> shells;
  Codes input;
  Codes solid;
  for (const Finding& finding : findings) {
    if (finding.severity != Severity::error) continue;
    const int level = finding_level(finding.code);
    if (level == 0 || finding.code == kRingNotClosed) {
      input.insert(finding.code);
    } else if (finding.code == kNonPlanarNormals) {
      shells[finding.place.shell].has_folds = true;
    } else if (level == 1 || level == 2) {
      shells[finding.place.shell].facets[finding.place.facet].insert(finding.code);
    } else if (level == 3) {
      shells[finding.place.shell].shell.insert(finding.code);
    } else {
      solid.insert(finding.code);
    }
  }
  Codes result = input;
  if (result.empty()) {
    for (const auto& [shell, codes] : shells) result.merge(codes.first_level());
  }
  if (result.empty()) {
    result = has(solid, kWrongOrientationShell) ? Codes{kWrongOrientationShell} : solid;
  }
  return {result.begin(), result.end()};
}

}  // namespace watertight::validate
