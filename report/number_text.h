// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers of findings as people write them: "0.1 mm", "1.83 m", coordinates to about a millimetre.
// For the text, HTML and CSV outputs; the JSON report has the numbers as they are.
#pragma once

#include <array>
#include <string>

#include "validate/report.h"

namespace watertight::report {

/// The measured value and the limit of a finding; "" for those it does not have. The limit is never
/// written like another measured value: further digits tell the two apart.
struct MeasureText {
  std::string measured;
  std::string limit;
  std::string unit;
};

/// With units: {"0.1 mm", "10 mm", ""}, {"72 edges", "0", ""}. Metres are rounded to centimetres
/// from 1 m on, else to a tenth of a millimetre, or of a smaller unit where that would be 0.
MeasureText readable_measure(const Finding& finding);

/// The same digits as plain numbers in the unit of the finding, which stands apart: {"0.0001",
/// "0.01", "m"}.
MeasureText measure_columns(const Finding& finding);

/// readable_measure() as one phrase: "0.1 mm, limit 10 mm"; "" without a measured value.
std::string measure_words(const Finding& finding);

/// Coordinates with nine digits for the largest of them: millimetres in a national grid, about as
/// much in degrees.
std::array<std::string, 3> point_columns(const std::array<double, 3>& point);

/// point_columns() with blanks between: "84616.468 447422.999 0.45".
std::string point_text(const std::array<double, 3>& point);

}  // namespace watertight::report
