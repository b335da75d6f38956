// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/models/number_form.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace watertight::columns {
namespace {

using Kind = NumberForm::Kind;

constexpr int kMostFloatDecimals = 4;
constexpr std::int64_t kFloatDecimalLimit = 10'000'000'000;
constexpr std::uint32_t kSignBit = 0x8000'0000;
constexpr std::size_t kLongestNumber = 20;

constexpr auto kPowers = [] {
  std::array<std::int64_t, 19> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = powers[i - 1] * 10;
  return powers;
}();

std::int64_t power_of_ten(int exponent) { return kPowers[static_cast<std::size_t>(exponent)]; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A decimal as it is written: `number` units of 10^-decimals.
struct Decimal {
  std::int64_t number = 0;
  int decimals = 0;
};

/// Reads -?digits[.digits] without zeros in front, with at most 18 digits, and not "-0".
std::optional<Decimal> read_decimal(std::string_view text) {
  if (text.empty() || text.size() > kLongestNumber) return std::nullopt;
  const bool is_negative = text[0] == '-';
  std::string_view digits = text.substr(is_negative ? 1 : 0);
  const std::size_t point = digits.find('.');
  const std::string_view whole = digits.substr(0, point);
  const std::string_view fraction =
      point == std::string_view::npos ? std::string_view() : digits.substr(point + 1);
  if (whole.empty() || (whole.size() > 1 && whole[0] == '0')) return std::nullopt;
  if (point != std::string_view::npos && fraction.empty()) return std::nullopt;
  if (whole.size() + fraction.size() > 18 || fraction.size() > kMostDecimals) return std::nullopt;
  std::int64_t number = 0;
  for (const std::string_view part : {whole, fraction}) {
    for (const char c : part) {
      if (!is_digit(c)) return std::nullopt;
      number = number * 10 + (c - '0');
    }
  }
  if (is_negative && number == 0) return std::nullopt;
  return Decimal{is_negative ? -number : number, static_cast<int>(fraction.size())};
}

/// The digits of a decimal, with all digits after the point.
std::string fixed_text(std::int64_t number, int decimals) {
  const bool is_negative = number < 0;
  std::string text = std::to_string(is_negative ? -number : number);
  const auto count = static_cast<std::size_t>(decimals);
  if (text.size() <= count) text.insert(0, count + 1 - text.size(), '0');
  if (count > 0) text.insert(text.size() - count, 1, '.');
  if (is_negative) text.insert(0, 1, '-');
  return text;
}

std::string trimmed_text(std::int64_t number, int decimals, bool keeps_point) {
  std::string text = fixed_text(number, decimals);
  if (decimals == 0) return text;
  text.resize(text.find_last_not_of('0') + 1);
  if (text.back() == '.') {
    if (keeps_point) {
      text += '0';
    } else {
      text.pop_back();
    }
  }
  return text;
}

/// The shortest digits that read back as the same double, without an exponent.
std::string double_text(double value) {
  std::array<char, 400> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  return {digits.data(), end.ptr};
}

/// Floats as whole numbers in their order, except that -0 has none.
std::string float_text(std::int64_t number) {
  constexpr std::int64_t kInfinity = 0x7F80'0000;
  if (number >= kInfinity || number <= -kInfinity) return {};
  const std::int64_t size = std::abs(number);
  const auto bits = static_cast<std::uint32_t>(size) | (number < 0 ? kSignBit : 0);
  return double_text(std::bit_cast<float>(bits));
}

std::string float_decimal_text(std::int64_t number, int decimals) {
  if (std::abs(number) >= kFloatDecimalLimit || decimals > kMostFloatDecimals) return {};
  const double value = static_cast<double>(number) / static_cast<double>(power_of_ten(decimals));
  return double_text(static_cast<float>(value));
}

std::optional<double> read_double(std::string_view text) {
  double value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  return value;
}

NumberForm unscaled(const NumberForm& form) {
  switch (form.kind) {
    case Kind::scaled:
      return {Kind::short_trimmed, form.decimals};
    case Kind::scaled_float32:
      return {Kind::float32, form.decimals};
    case Kind::scaled_float_decimal:
      return {Kind::float_decimal, form.decimals};
    default:
      return form;
  }
}

NumberForm scaled(const NumberForm& form) {
  switch (form.kind) {
    case Kind::float32:
      return {Kind::scaled_float32, form.decimals};
    case Kind::float_decimal:
      return {Kind::scaled_float_decimal, form.decimals};
    default:
      return {Kind::scaled, form.decimals};
  }
}

/// The text of a decimal as a whole number times a power of ten.
std::string scaled_text(std::string_view plain) {
  std::string digits(plain.starts_with('-') ? plain.substr(1) : plain);
  const std::size_t point = digits.find('.');
  int exponent = 0;
  if (point != std::string::npos) {
    exponent = -static_cast<int>(digits.size() - point - 1);
    digits.erase(point, 1);
  }
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  if (digits.empty()) return "0";
  const std::size_t size = digits.find_last_not_of('0') + 1;
  exponent += static_cast<int>(digits.size() - size);
  digits.resize(size);
  if (exponent != 0) digits.append("e").append(std::to_string(exponent));
  if (plain.starts_with('-')) digits.insert(0, 1, '-');
  return digits;
}

/// The text of a whole number times a power of ten as a decimal. None unless scaled_text() gives it
/// back.
std::optional<std::string> plain_text(std::string_view text) {
  constexpr int kMostZeros = 40;
  const std::size_t mark = std::min(text.find('e'), text.size());
  const bool is_negative = text.starts_with('-');
  std::string digits(text.substr(0, mark).substr(is_negative ? 1 : 0));
  if (digits.empty() || !std::all_of(digits.begin(), digits.end(), is_digit)) return std::nullopt;
  int exponent = 0;
  if (mark < text.size()) {
    const auto [rest, error] =
        std::from_chars(text.data() + mark + 1, text.data() + text.size(), exponent);
    if (error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  }
  if (exponent > kMostZeros || exponent < -kMostZeros) return std::nullopt;
  if (exponent > 0) digits.append(static_cast<std::size_t>(exponent), '0');
  if (exponent < 0) {
    const auto decimals = static_cast<std::size_t>(-exponent);
    if (digits.size() <= decimals) digits.insert(0, decimals + 1 - digits.size(), '0');
    digits.insert(digits.size() - decimals, 1, '.');
  }
  if (is_negative) digits.insert(0, 1, '-');
  if (scaled_text(digits) != text) return std::nullopt;
  return digits;
}

std::optional<std::int64_t> nearest_number(const NumberForm& form, std::string_view text) {
  if (form.kind == Kind::float32 || form.kind == Kind::float_decimal) {
    const auto value = read_double(text);
    if (!value || !(std::abs(*value) < 1e15)) return std::nullopt;
    if (form.kind == Kind::float_decimal) {
      const double scaled = *value * static_cast<double>(power_of_ten(form.decimals));
      if (!(std::abs(scaled) < static_cast<double>(kFloatDecimalLimit))) return std::nullopt;
      return std::llround(scaled);
    }
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(*value));
    const auto size = static_cast<std::int64_t>(bits & ~kSignBit);
    return (bits & kSignBit) != 0 ? -size : size;
  }
  const auto decimal = read_decimal(text);
  if (!decimal || decimal->decimals > form.decimals) return std::nullopt;
  const std::int64_t power = power_of_ten(form.decimals - decimal->decimals);
  if (std::abs(decimal->number) >= kDecimalLimit / power) return std::nullopt;
  return decimal->number * power;
}

/// A number of many digits may be a float of 32 bits.
std::optional<FormedNumber> choose_float(std::string_view text,
                                         const std::optional<NumberForm>& before) {
  if (before && before->kind == Kind::float_decimal) {
    if (const auto number = number_in(*before, text)) return FormedNumber{*before, *number};
  }
  for (int decimals = 1; decimals <= kMostFloatDecimals; ++decimals) {
    const NumberForm form{Kind::float_decimal, decimals};
    if (const auto number = number_in(form, text)) return FormedNumber{form, *number};
  }
  const NumberForm form{Kind::float32, 0};
  if (const auto number = number_in(form, text)) return FormedNumber{form, *number};
  return std::nullopt;
}

constexpr std::size_t kManyDigits = 9;

}  // namespace

std::string print(const NumberForm& form, std::int64_t number) {
  if (form.is_decimal() && (number >= kDecimalLimit || number <= -kDecimalLimit)) return {};
  switch (form.kind) {
    case Kind::trimmed:
      return form.decimals == 0 ? std::string() : trimmed_text(number, form.decimals, true);
    case Kind::short_trimmed:
      return trimmed_text(number, form.decimals, false);
    case Kind::fixed:
      return fixed_text(number, form.decimals);
    case Kind::float32:
      return float_text(number);
    case Kind::float_decimal:
      return float_decimal_text(number, form.decimals);
    case Kind::scaled:
    case Kind::scaled_float32:
    case Kind::scaled_float_decimal: {
      const std::string plain = print(unscaled(form), number);
      return plain.empty() ? plain : scaled_text(plain);
    }
    case Kind::count:
      break;
  }
  return {};
}

std::optional<std::int64_t> number_in(const NumberForm& form, std::string_view text) {
  if (form.is_scaled()) {
    const auto plain = plain_text(text);
    return plain ? number_in(unscaled(form), *plain) : std::nullopt;
  }
  const auto number = nearest_number(form, text);
  if (!number || print(form, *number) != text) return std::nullopt;
  return number;
}

std::optional<FormedNumber> choose_form(std::string_view text,
                                        const std::optional<NumberForm>& before) {
  const char first = text.empty() ? '\0' : text[0];
  if (first != '-' && !is_digit(first)) return std::nullopt;
  const bool has_exponent = text.find('e') != std::string_view::npos;
  if (has_exponent || (before && before->is_scaled())) {
    if (const auto plain = plain_text(text)) {
      auto chosen = choose_form(*plain, before ? std::optional(unscaled(*before)) : std::nullopt);
      if (chosen) chosen->form = scaled(chosen->form);
      return chosen;
    }
    if (has_exponent) return std::nullopt;
  }
  const auto decimal = read_decimal(text);
  if (decimal ? decimal->decimals > static_cast<int>(kManyDigits) : text.size() > kManyDigits) {
    if (auto chosen = choose_float(text, before)) return chosen;
  }
  if (before) {
    if (const auto number = number_in(*before, text)) return FormedNumber{*before, *number};
  }
  if (!decimal) return std::nullopt;
  const bool was_trimmed =
      before && (before->kind == Kind::trimmed || before->kind == Kind::short_trimmed);
  const int wider = std::max(decimal->decimals, was_trimmed ? before->decimals : 0);
  const bool is_short = before && before->kind == Kind::short_trimmed;
  for (const NumberForm& form :
       {NumberForm{is_short || wider == 0 ? Kind::short_trimmed : Kind::trimmed, wider},
        NumberForm{Kind::short_trimmed, wider}, NumberForm{Kind::trimmed, wider},
        NumberForm{Kind::fixed, decimal->decimals}}) {
    if (const auto number = number_in(form, text)) return FormedNumber{form, *number};
  }
  return std::nullopt;
}

std::int64_t with_decimals(std::int64_t number, int from, int to) {
  if (to <= from) return number / power_of_ten(from - to);
  const std::int64_t power = power_of_ten(to - from);
  return std::abs(number) < kDecimalLimit / power ? number * power : 0;
}

}  // namespace watertight::columns
