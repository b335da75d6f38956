// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reports as JSON and as lines of text, for service, command line and SQL. The JSON says what
// val3dity's says (validity, all_errors, parameters, errors with code, description, id, info) and
// adds places as JSON Pointers, pairs, witnesses and measured values. Described in
// docs/findings.md.
#pragma once

#include <string>
#include <vector>

#include "geometry/solid.h"
#include "validate/report.h"

namespace watertight {

/// Number of this JSON layout; raised when a member changes its meaning or goes.
inline constexpr int kReportSchema = 1;

enum class JsonStyle : std::uint8_t { compact, indented };

struct ReportJsonOptions {
  /// JSON Pointer to the solid's array of shells in its document ("/CityObjects/b/geometry/0/
  /// boundaries"); "" leaves pointers out.
  std::string pointer_prefix;
  /// False for a geometry whose boundaries are one shell (MultiSurface): no shell step in pointers.
  bool has_shells = true;
  /// False leaves out wall times, so that equal solids give equal bytes.
  bool include_times = true;
  JsonStyle style = JsonStyle::compact;
};

/// UTF-8 JSON of one solid's report. `submitted` is the solid that was certified (places are
/// indices into it). Deterministic but for the times. Never fails: text that is not UTF-8 is
/// replaced.
std::string report_json(const Report& report, const Solid& submitted,
                        const ReportJsonOptions& options = {});

/// JSON Pointer of a place: prefix, then shell, facet within the shell, ring, vertex within the
/// ring, as far as they are given. "" when the prefix is empty.
std::string place_pointer(const Place& place, const Solid& submitted,
                          const ReportJsonOptions& options);

/// One line for a person: "error 302 SHELL_NOT_CLOSED at shell 0 facet 5: a border of 4 edges ...".
std::string finding_text(const Finding& finding);

/// The findings as lines, after one line with the verdict.
std::vector<std::string> report_text(const Report& report);

}  // namespace watertight
