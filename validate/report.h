// SPDX-License-Identifier: GPL-3.0-or-later
//
// The validator's report on a solid: a verdict and every finding with code, place, witness and
// measured value. Plain data for service, command line, SQL and library.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "delaunay/rung.h"
#include "geometry/measures.h"
#include "geometry/valid_solid.h"

namespace watertight::validate {

enum class Verdict : std::uint8_t { valid, invalid, undecided };
enum class Severity : std::uint8_t { error, warning };
std::string_view to_string(Verdict verdict);
std::string_view to_string(Severity severity);

/// The place of a finding: indices into the submitted Solid, kNone for those that do not apply.
struct Place {
  Index shell = kNone;
  Index facet = kNone;
  Index ring = kNone;    // the index of the ring within its facet: 0 is the exterior ring
  Index vertex = kNone;  // the index in the submitted vertices
  Index solid = kNone;   // the member of a group (5xx, 6xx), see validate/groups.h
  friend auto operator<=>(const Place&, const Place&) = default;
};

/// The element of a document in which a place is, for formats that name elements (GML).
struct SourceElement {
  std::string polygon = {};  // the gml:id of the facet's polygon, "" without one
  std::string ring = {};     // the gml:id of the ring, "" without one
  std::uint64_t line = 0;    // the line on which the element starts, from 1; 0 if unknown
  friend auto operator<=>(const SourceElement&, const SourceElement&) = default;
};

struct Finding {
  int code = 0;  // the number of the finding in docs/findings.md
  Severity severity = Severity::error;
  Place place = {};
  std::optional<Place> other = {};  // the place of the other element of a pair
  std::optional<std::array<double, 3>> witness =
      {};  // the world coordinates of the witness, correctly rounded
  std::optional<double> measured = {};
  std::optional<double> limit = {};
  std::string unit = {};            // the unit of measured and limit: "m", "degree", "facets", ...
  std::string detail = {};          // one clause, lower case, for a person
  bool uncertain = false;           // a finding of a lower level makes this one unreliable
  SourceElement source = {};        // the element of `place`
  SourceElement other_source = {};  // the element of `other`
};

/// A rule that could not be evaluated, and why.
struct SkippedRule {
  std::vector<int> codes;
  std::string reason;
};

/// The verdict under val3dity's default tolerances (snap 1 mm, planarity 1 cm and 20 degrees).
struct TolerantVerdict {
  Verdict verdict = Verdict::undecided;  // the verdict of the exact tests on the snapped solid
  std::vector<int> first_level;          // the codes of the first level that fails, sorted
};

struct Report {
  Verdict verdict = Verdict::undecided;
  std::string undecided_reason;        // "" unless the verdict is undecided
  std::vector<Finding> findings;       // the findings, ordered by level, then place
  std::uint64_t findings_omitted = 0;  // the number of findings that are not in `findings`
  std::vector<SkippedRule> not_run;
  std::vector<int> first_level;             // the codes that val3dity would report, sorted
  std::optional<TolerantVerdict> tolerant;  // present if asked for; no decision depends on it
  Acceptance acceptance;
  std::vector<std::string> notes;               // remarks, e.g. on assumed units
  std::vector<delaunay::RungAttempt> attempts;  // the attempts on the ladder
  delaunay::Rung rung = delaunay::Rung::none;
  /// The refilled facets of the accepted tetrahedralization; the exact tests judged the canonical
  /// triangles. Only solids of one shell have any.
  std::vector<Index> refilled_facets;
  std::optional<geometry::Measures> measures;  // present if the boundary is closed and triangulated
  double seconds = 0;                          // the wall time; not deterministic
};

/// The name of a code, e.g. 302 -> "SHELL_NOT_CLOSED"; "" for an unknown code.
std::string_view finding_name(int code);

}  // namespace watertight::validate

namespace watertight {

using validate::Finding;
using validate::Place;
using validate::Report;
using validate::Severity;
using validate::Verdict;

}  // namespace watertight
