// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reports as JSON and as lines of text, for service, command line and SQL. The JSON has the members
// of val3dity's JSON (validity, all_errors, parameters, errors with code, description, id, info)
// and adds places as JSON Pointers, pairs, witnesses and measured values. docs/report.md describes
// the JSON. report/feature_report.h writes the reports of whole documents.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/solid.h"
#include "validate/report.h"

namespace watertight::validate {

/// The number of this JSON layout; raised when a member changes its meaning or is removed.
inline constexpr int kReportSchema = 2;

enum class JsonStyle : std::uint8_t { compact, indented };

struct ReportJsonOptions {
  /// The JSON Pointer to the solid's array of shells in its document ("/CityObjects/b/geometry/0/
  /// boundaries"); "" leaves pointers out.
  std::string pointer_prefix;
  /// False for a geometry whose boundaries are one shell (MultiSurface): pointers then have no step
  /// for the shell.
  bool has_shells = true;
  /// val3dity's path of the solid, "coid=b|geom=0|solid=1|", which starts the `id` of findings.
  std::string id_prefix;
  /// The index of the solid in a list, written as the member `solid` of places; kNone leaves the
  /// member out.
  Index solid_number = kNone;
  /// False leaves out wall times, so that equal solids give equal bytes.
  bool include_times = true;
  /// True adds `strict` to the parameters: the solid was judged with LadderOptions::strict.
  bool is_strict = false;
  JsonStyle style = JsonStyle::compact;
};

/// The report of one solid as UTF-8 JSON. `submitted` is the solid that was given to certify();
/// places are indices into it. Deterministic except for the times. Never fails: text that is not
/// UTF-8 is replaced.
std::string report_json(const Report& report, const Solid& submitted,
                        const ReportJsonOptions& options = {});

/// The solid to which places refer, and the options by which places are written.
struct PlacedSolid {
  const Solid* submitted = nullptr;
  const ReportJsonOptions* options = nullptr;
};

/// One finding as compact JSON, an element of `errors` or `warnings`. `here` is the solid of
/// Finding::place, `there` the solid of Finding::other; they differ only for findings about groups.
std::string finding_json(const Finding& finding, const PlacedSolid& here, const PlacedSolid& there);

/// The measures as JSON with the members volume, area, bbox, genus, vertices, facets, rings and
/// shells.
std::string report_measures_json(const geometry::Measures& measures);

/// Whether two JSON texts have the same values, in whatever order and spacing; false for text that
/// is no JSON.
bool is_same_json(std::string_view a, std::string_view b);

/// The JSON Pointer of a place: prefix, then shell, facet within the shell, ring, vertex within the
/// ring, as far as the place has them. "" if the prefix is empty.
std::string place_pointer(const Place& place, const Solid& submitted,
                          const ReportJsonOptions& options);

/// A finding as one line of text, for a person: "error 302 SHELL_NOT_CLOSED at shell 0 facet 5: a
/// border of 4 edges ..."; with the elements of a GML document after the places: "shell 0 facet 5
/// (polygon 'wall', line 12)".
std::string finding_text(const Finding& finding);

/// The report as lines of text: the verdict, then each finding.
std::vector<std::string> report_text(const Report& report);

}  // namespace watertight::validate
