// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/lattice/grid_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/assert.h"

namespace watertight::geometry {
namespace {

constexpr Wide kWideMax = static_cast<Wide>(~UnsignedWide{0} >> 1U);
constexpr int kDigits = 18;  // significant digits that always fit a 64-bit mantissa

bool is_digit(char c) { return c >= '0' && c <= '9'; }

Error not_a_number(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string message("'");
  message.append(text.substr(0, kShown)).append(text.size() > kShown ? "...'" : "'");
  message.append(" is not a decimal number");
  return {ErrorCode::malformed, std::move(message)};
}

/// Reads a decimal literal: sign, digits with at most one point, exponent.
class DecimalReader {
 public:
  explicit DecimalReader(std::string_view text) : text_(text) {}

  Result<GridNumber> read() {
    read_sign();
    if (!read_digits()) return not_a_number(text_);
    if (!read_exponent()) return not_a_number(text_);
    if (at_ != text_.size()) return not_a_number(text_);
    if (mantissa_ == 0) return GridNumber{};
    if (is_too_long_) {
      return Error{ErrorCode::limit_exceeded, "a number has more than 18 significant digits"};
    }
    if (exponent_ > 309 || exponent_ < -400) {
      return Error{ErrorCode::limit_exceeded, "a number is outside the range of coordinates"};
    }
    return GridNumber{is_negative_ ? -mantissa_ : mantissa_, static_cast<std::int32_t>(exponent_)};
  }

 private:
  void read_sign() {
    if (at_ < text_.size() && (text_[at_] == '-' || text_[at_] == '+')) {
      is_negative_ = text_[at_] == '-';
      ++at_;
    }
  }

  /// Reads the digits and the point; false if there is no digit. A zero enters the mantissa only
  /// when another digit than zero follows, so trailing zeros do not count as significant digits.
  bool read_digits() {
    bool has_digit = false;
    bool after_point = false;
    std::int64_t zeros = 0;  // the number of zeros since the last digit that is not zero
    int digits = 0;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '.' && !after_point) {
        after_point = true;
        continue;
      }
      if (!is_digit(c)) break;
      has_digit = true;
      if (after_point) --exponent_;
      if (c == '0') {
        if (mantissa_ != 0) ++zeros;
        continue;
      }
      const std::int64_t needed = mantissa_ == 0 ? 1 : digits + zeros + 1;
      if (is_too_long_ || needed > kDigits) {
        is_too_long_ = true;
        continue;
      }
      for (; zeros > 0; --zeros) mantissa_ *= 10;
      mantissa_ = mantissa_ * 10 + (c - '0');
      digits = static_cast<int>(needed);
    }
    exponent_ += zeros;
    return has_digit;
  }

  bool read_exponent() {
    if (at_ == text_.size() || (text_[at_] != 'e' && text_[at_] != 'E')) return true;
    ++at_;
    bool is_negative = false;
    if (at_ < text_.size() && (text_[at_] == '-' || text_[at_] == '+')) {
      is_negative = text_[at_] == '-';
      ++at_;
    }
    if (at_ == text_.size()) return false;
    constexpr std::int64_t kCap = std::int64_t{1} << 40;  // far beyond the length of any text
    std::int64_t value = 0;
    for (; at_ < text_.size() && is_digit(text_[at_]); ++at_) {
      value = std::min(value * 10 + (text_[at_] - '0'), kCap);
    }
    exponent_ += is_negative ? -value : value;
    return is_digit(text_[at_ - 1]);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool is_negative_ = false;
  bool is_too_long_ = false;
  std::int64_t mantissa_ = 0;
  std::int64_t exponent_ = 0;
};

}  // namespace

UnsignedWide power_of_ten(int exponent) {
  WATERTIGHT_ASSERT(exponent >= 0 && exponent <= 38);
  UnsignedWide power = 1;
  for (; exponent > 0; --exponent) power *= 10;
  return power;
}

std::optional<Wide> scaled_up(Wide value, std::int32_t radix, std::int64_t count) {
  if (value == 0) return Wide{0};
  for (; count > 0; --count) {
    if (value > kWideMax / radix || value < -kWideMax / radix) return std::nullopt;
    value *= radix;
  }
  return value;
}

std::optional<WideNumber> wide_sum(WideNumber a, WideNumber b, std::int32_t radix) {
  if (a.mantissa == 0) return b;
  if (b.mantissa == 0) return a;
  if (a.exponent < b.exponent) std::swap(a, b);
  const auto raised = scaled_up(a.mantissa, radix, std::int64_t{a.exponent} - b.exponent);
  if (!raised) return std::nullopt;
  if ((b.mantissa > 0 && *raised > kWideMax - b.mantissa) ||
      (b.mantissa < 0 && *raised < -kWideMax - b.mantissa)) {
    return std::nullopt;
  }
  return WideNumber{*raised + b.mantissa, b.exponent};
}

std::optional<GridNumber> normalized(WideNumber number, std::int32_t radix) {
  if (number.mantissa == 0) return GridNumber{};
  while (number.mantissa % radix == 0) {
    number.mantissa /= radix;
    ++number.exponent;
  }
  if (number.mantissa > std::numeric_limits<std::int64_t>::max() ||
      number.mantissa < -std::numeric_limits<std::int64_t>::max()) {
    return std::nullopt;
  }
  return GridNumber{static_cast<std::int64_t>(number.mantissa), number.exponent};
}

std::string digits_of(Wide value) {
  if (value == 0) return "0";
  const bool is_negative = value < 0;
  UnsignedWide rest =
      is_negative ? -static_cast<UnsignedWide>(value) : static_cast<UnsignedWide>(value);
  std::string digits;
  for (; rest != 0; rest /= 10)
    digits.push_back(static_cast<char>('0' + static_cast<int>(rest % 10)));
  if (is_negative) digits.push_back('-');
  std::reverse(digits.begin(), digits.end());
  return digits;
}

double nearest_double(const WideNumber& decimal) {
  // A mantissa up to 2^53 and a power of ten up to 10^22 are exact doubles, so their product or
  // quotient is rounded only once.
  constexpr Wide kExact = Wide{1} << 53U;
  constexpr int kExactPower = 22;
  if (decimal.mantissa == 0) return 0.0;
  if (decimal.mantissa <= kExact && decimal.mantissa >= -kExact &&
      std::abs(decimal.exponent) <= kExactPower) {
    const double mantissa = static_cast<double>(decimal.mantissa);
    const double power = static_cast<double>(power_of_ten(std::abs(decimal.exponent)));
    return decimal.exponent < 0 ? mantissa / power : mantissa * power;
  }
  const std::string text = digits_of(decimal.mantissa) + "e" + std::to_string(decimal.exponent);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc::result_out_of_range) return value + 0.0;
  // The exponent shows whether the number is too large or too small.
  const bool is_large = decimal.exponent > 0;
  const double magnitude = is_large ? std::numeric_limits<double>::infinity() : 0.0;
  return decimal.mantissa < 0 && is_large ? -magnitude : magnitude;
}

std::string plain_decimal(std::string digits, std::int64_t exponent) {
  const bool is_negative = !digits.empty() && digits.front() == '-';
  if (is_negative) digits.erase(0, 1);
  if (exponent < 0) {
    const auto places = static_cast<std::size_t>(-exponent);
    if (digits.size() <= places) digits.insert(0, places - digits.size() + 1, '0');
    digits.insert(digits.size() - places, 1, '.');
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
  } else if (digits != "0") {
    digits.append(static_cast<std::size_t>(exponent), '0');
  }
  if (is_negative && digits != "0") digits.insert(0, 1, '-');
  return digits;
}

Result<GridNumber> parse_decimal(std::string_view text) { return DecimalReader(text).read(); }

namespace {

template <class Float>
GridNumber shortest_of(Float value) {
  WATERTIGHT_ASSERT(std::isfinite(value));
  std::array<char, 32> text{};
  const auto [end, code] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific);
  WATERTIGHT_ASSERT(code == std::errc{});
  const auto parsed = parse_decimal({text.data(), static_cast<std::size_t>(end - text.data())});
  return parsed ? *parsed : GridNumber{};
}

}  // namespace

GridNumber shortest_decimal(double value) { return shortest_of(value); }

GridNumber shortest_decimal(float value) { return shortest_of(value); }

GridNumber binary_number(double value) {
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  return normalized({mantissa, exponent - 53}, 2).value_or(GridNumber{});
}

}  // namespace watertight::geometry
