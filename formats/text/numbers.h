// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers of text formats as exact decimals. Internal to formats/.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/result.h"
#include "geometry/placement.h"

namespace watertight::formats {

struct ExactNumber {
  GridNumber value;
  bool is_rounded = false;  // more than 18 significant digits: the value of the nearest double
};

/// Reads a number. Errors: malformed (not a number), limit_exceeded (beyond the range of doubles).
Result<ExactNumber> exact_number(std::string_view text);

/// The count of numbers in a transformationMatrix.
inline constexpr std::size_t kMatrixSize = 16;

/// The placement of a 4 x 4 matrix, rows one after the other, at `anchor` (world coordinates).
/// Errors: malformed (not 16 numbers, a last row other than 0 0 0 1).
Result<geometry::Placement> placement_of_matrix(std::span<const GridNumber> matrix,
                                                const std::array<GridNumber, 3>& anchor);

/// The digits of a number, without exponent where that is short: "-0.125".
std::string plain_text(const GridNumber& number);

/// The EPSG code in "https://www.opengis.net/def/crs/EPSG/0/7415", "urn:ogc:def:crs:EPSG::7415",
/// "EPSG:7415", "[EPSG:7415]": the last number of the first run of digits, dots, colons and slashes
/// after "EPSG". 0 when there is none.
std::uint32_t epsg_code(std::string_view text);

}  // namespace watertight::formats
