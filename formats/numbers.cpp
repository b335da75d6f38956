// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/numbers.h"

#include <charconv>
#include <cmath>
#include <string>

namespace watertight {

Result<ExactNumber> exact_number(std::string_view text) {
  auto exact = parse_decimal(text);
  if (exact) return ExactNumber{*exact, false};
  if (exact.error().code != ErrorCode::limit_exceeded) return exact.error();
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return exact.error();
  }
  return ExactNumber{shortest_decimal(value), true};
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

}  // namespace watertight
