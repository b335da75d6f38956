// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of findings: number, name, severity and meaning of each. docs/findings.md describes
// them. Numbers and names up to 799 are val3dity's; a number is never reused.
#pragma once

#include <set>
#include <span>
#include <string_view>

#include "validate/report.h"

namespace watertight::validate {

enum FindingCode : int {
  kTooFewPoints = 101,
  kConsecutivePointsSame = 102,
  kRingNotClosed = 103,
  kRingSelfIntersection = 104,
  kIntersectionRings = 201,
  kDuplicatedRings = 202,
  kNonPlanarDistance = 203,
  kNonPlanarNormals = 204,
  kInteriorDisconnected = 205,
  kInnerRingOutside = 206,
  kInnerRingsNested = 207,
  kOrientationRingsSame = 208,
  kNotValid2Manifold = 300,
  kTooFewPolygons = 301,
  kShellNotClosed = 302,
  kNonManifold = 303,
  kMultipleComponents = 305,
  kShellSelfIntersection = 306,
  kPolygonWrongOrientation = 307,
  kIntersectionShells = 401,
  kDuplicatedShells = 402,
  kInnerShellOutside = 403,
  kSolidInteriorDisconnected = 404,
  kWrongOrientationShell = 405,
  kIntersectionSolids = 501,
  kDuplicatedSolids = 502,
  kDisconnectedSolids = 503,
  kBuildingPartsOverlap = 601,
  kCellsOverlap = 701,
  kDualVertexOutsideCell = 702,
  kXlinksError = 703,
  kAdjacenciesInconsistent = 704,
  kNearDuplicateVertices = 801,
  kUnusedVertices = 802,
  kSliverFacet = 803,
  kTriangulationDependent = 804,
  kCoordinatesRounded = 805,
  kZeroVolume = 806,
  kInvalidInputFile = 901,
  kEmptyPrimitive = 902,
  kWrongInputParameters = 903,
  kFormatNotSupported = 904
};

struct FindingKind {
  int code = 0;
  std::string_view name;
  Severity severity = Severity::error;
  std::string_view summary;    // the meaning of the code, one clause in lower case
  std::string_view hint = {};  // a way to repair the defect, one sentence
  bool is_repairable = false;  // true if a program can repair it without guessing what was meant
};

/// All kinds of findings that this program reports, ascending by code.
std::span<const FindingKind> finding_kinds();

/// The kind of a code, or null.
const FindingKind* find_kind(int code);

/// The level of a code, by which findings are ordered: 0 input, 1 ring, 2 facet, 3 shell, 4 solid,
/// 5 composite solid, 6 building, 7 indoor model, 9 warnings.
int finding_level(int code);

/// The codes of the errors among findings.
std::set<int> error_codes(std::span<const Finding> findings);

}  // namespace watertight::validate
