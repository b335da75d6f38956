// SPDX-License-Identifier: GPL-3.0-or-later
//
// The text of a feature in a store before it is packed: lines about its solids, then the line of
// its city model, if it has one, then the layout of its document. Where it names the feature's id
// often, it is made shorter.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"

namespace watertight::packing {

// How lines about solids begin; the number of the solid follows, but for findings.
inline constexpr std::string_view kMergedLine = "merged ";
inline constexpr std::string_view kUnprovenLine = "unproven ";
inline constexpr std::string_view kRepairedLine = "repaired ";
inline constexpr std::string_view kMeasuresLine = "measures ";
inline constexpr std::string_view kReportLine = "report ";
inline constexpr std::string_view kFindingsLine = "findings ";

/// The lines about solids that stand in front of the skeleton of an encoded feature too.
inline constexpr std::array kSolidLines{kMergedLine, kUnprovenLine, kRepairedLine};

/// The skeleton of the feature's city model (formats/city_json/city_json.h), a part of its text; ""
/// without one.
std::string_view model_line(std::string_view text);

/// The JSON of the repair of a solid (docs/report.md, "Repairs"), a part of the feature's text; ""
/// for a solid that was not repaired.
std::string_view repair_of(std::string_view text, std::uint64_t solid);

/// The text with a mark for each id, and a byte at its front that says so; the text itself when the
/// id is short or the text has bytes like marks.
std::string with_marks(const std::string& text, const std::string& id);

/// The text that with_marks() was given. Errors: limit_exceeded above `most_bytes`.
Result<std::string> without_marks(const std::string& marked, const std::string& id,
                                  std::uint64_t most_bytes);

}  // namespace watertight::packing
