// SPDX-License-Identifier: GPL-3.0-or-later
//
// The forms in which programs write numbers. A number in a form is a whole number, from which its
// text follows. Internal to columns/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace watertight::columns {

struct NumberForm {
  enum class Kind : std::uint8_t {
    trimmed,        // a decimal without zeros at its end, but "11.0"
    short_trimmed,  // likewise, but "11"
    fixed,          // a decimal with all its digits after the point
    float32,        // a float of 32 bits, in the digits of the same double
    float_decimal,  // the float of 32 bits nearest to a decimal, in the digits of that double
    // The digits of short_trimmed, float32 and float_decimal as a whole number without zeros at its
    // end, times a power of ten: "28155563e-2", "59e1", "594".
    scaled,
    scaled_float32,
    scaled_float_decimal,
    count
  };
  Kind kind = Kind::short_trimmed;
  int decimals = 0;  // digits after the point; 0 for float32

  /// Whether the whole number counts units of 10^-decimals.
  bool is_decimal() const { return kind != Kind::float32 && kind != Kind::scaled_float32; }
  bool is_scaled() const { return kind >= Kind::scaled; }
  friend bool operator==(const NumberForm&, const NumberForm&) = default;
};

/// The most digits after the point.
inline constexpr int kMostDecimals = 17;
/// Whole numbers of decimal forms are below this, and above its negative.
inline constexpr std::int64_t kDecimalLimit = 1'000'000'000'000'000'000;

/// The text of a number. Empty when the form has no such number.
std::string print(const NumberForm& form, std::int64_t number);

/// The number whose text in this form is `text`.
std::optional<std::int64_t> number_in(const NumberForm& form, std::string_view text);

struct FormedNumber {
  NumberForm form;
  std::int64_t number = 0;
};
/// The form for a text after numbers of the form `before`, and the number. None for a text that is
/// no number, or that no form gives back.
std::optional<FormedNumber> choose_form(std::string_view text,
                                        const std::optional<NumberForm>& before);

/// The number in other decimals, rounded toward 0; 0 when it would be too large.
std::int64_t with_decimals(std::int64_t number, int from, int to);

}  // namespace watertight::columns
