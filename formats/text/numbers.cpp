// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/text/numbers.h"

#include <charconv>
#include <cmath>
#include <string>

namespace watertight::formats {

Result<ExactNumber> exact_number(std::string_view text) {
  auto exact = geometry::parse_decimal(text);
  if (exact) return ExactNumber{*exact, false};
  if (exact.error().code != ErrorCode::limit_exceeded) return exact.error();
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return exact.error();
  }
  return ExactNumber{geometry::shortest_decimal(value), true};
}

Result<geometry::Placement> placement_of_matrix(std::span<const GridNumber> matrix,
                                                const std::array<GridNumber, 3>& anchor) {
  constexpr std::size_t kRowSize = 4;
  if (matrix.size() != kMatrixSize) {
    return Error{ErrorCode::malformed, "a transformationMatrix needs 16 numbers"};
  }
  for (std::size_t i = kMatrixSize - kRowSize; i < kMatrixSize; ++i) {
    if (matrix[i] == GridNumber{i + 1 == kMatrixSize ? 1 : 0, 0}) continue;
    return Error{ErrorCode::malformed,
                 "the last row of a transformationMatrix is 0 0 0 1, rows one after the other"};
  }
  geometry::Placement placement;
  placement.anchor = anchor;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      placement.linear[row][column] = matrix[row * kRowSize + column];
    }
    placement.offset[row] = matrix[row * kRowSize + 3];
  }
  return placement;
}

std::string plain_text(const GridNumber& number) {
  std::string digits = std::to_string(number.mantissa);
  if (number.exponent > 0 && number.exponent <= 18) {
    return digits.append(static_cast<std::size_t>(number.exponent), '0');
  }
  if (number.exponent > 0 || number.exponent < -40) {
    return digits + 'e' + std::to_string(number.exponent);
  }
  if (number.exponent == 0) return digits;
  const bool is_negative = digits.front() == '-';
  if (is_negative) digits.erase(0, 1);
  const auto places = static_cast<std::size_t>(-number.exponent);
  if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
  digits.insert(digits.size() - places, 1, '.');
  return is_negative ? '-' + digits : digits;
}

std::uint32_t epsg_code(std::string_view text) {
  std::size_t start = text.find("EPSG");
  if (start == std::string_view::npos) start = text.find("epsg");
  if (start == std::string_view::npos) return 0;
  text.remove_prefix(start + 4);
  text = text.substr(0, text.find_first_not_of("0123456789.:/"));
  while (!text.empty() && (text.back() == '/' || text.back() == ':')) text.remove_suffix(1);
  text.remove_prefix(
      text.find_last_of(":/") == std::string_view::npos ? 0 : text.find_last_of(":/") + 1);
  std::uint32_t code = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), code);
  return status == std::errc() && end == text.data() + text.size() ? code : 0;
}

}  // namespace watertight::formats
