// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reports as JSON and as lines of text, for service, command line and SQL. The JSON says what
// val3dity's says (validity, all_errors, parameters, errors with code, description, id, info) and
// adds places as JSON Pointers, pairs, witnesses and measured values. Described in
// docs/report.md; reports of whole documents are report/feature_report.h's.
#pragma once

#include <string>
#include <vector>

#include "geometry/solid.h"
#include "validate/report.h"

namespace watertight::validate {

/// Number of this JSON layout; raised when a member changes its meaning or is removed.
inline constexpr int kReportSchema = 2;

enum class JsonStyle : std::uint8_t { compact, indented };

struct ReportJsonOptions {
  /// JSON Pointer to the solid's array of shells in its document ("/CityObjects/b/geometry/0/
  /// boundaries"); "" leaves pointers out.
  std::string pointer_prefix;
  /// False for a geometry whose boundaries are one shell (MultiSurface): no shell step in pointers.
  bool has_shells = true;
  /// val3dity's path of the solid, "coid=b|geom=0|solid=1|", which starts the `id` of findings.
  std::string id_prefix;
  /// Position of the solid in a list, the member `solid` of places; kNone leaves it out.
  Index solid_number = kNone;
  /// False leaves out wall times, so that equal solids give equal bytes.
  bool include_times = true;
  JsonStyle style = JsonStyle::compact;
};

/// UTF-8 JSON of one solid's report. `submitted` is the solid that was certified (places are
/// indices into it). Deterministic but for the times. Never fails: text that is not UTF-8 is
/// replaced.
std::string report_json(const Report& report, const Solid& submitted,
                        const ReportJsonOptions& options = {});

/// The solid to which places refer, and how they are written.
struct PlacedSolid {
  const Solid* submitted = nullptr;
  const ReportJsonOptions* options = nullptr;
};

/// One finding as compact JSON, an element of `errors` or `warnings`. `here` is the solid of
/// Finding::place, `there` that of Finding::other: the same one but for findings about groups.
std::string finding_json(const Finding& finding, const PlacedSolid& here, const PlacedSolid& there);

/// {"volume", "area", "bbox", "genus", "vertices", "facets", "rings", "shells"}
std::string report_measures_json(const geometry::Measures& measures);

/// JSON Pointer of a place: prefix, then shell, facet within the shell, ring, vertex within the
/// ring, as far as they are given. "" when the prefix is empty.
std::string place_pointer(const Place& place, const Solid& submitted,
                          const ReportJsonOptions& options);

/// One line for a person: "error 302 SHELL_NOT_CLOSED at shell 0 facet 5: a border of 4 edges ...".
std::string finding_text(const Finding& finding);

/// The findings as lines, after one line with the verdict.
std::vector<std::string> report_text(const Report& report);

}  // namespace watertight::validate
