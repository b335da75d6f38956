// SPDX-License-Identifier: GPL-3.0-or-later
//
// Texts that differ in a number: ids with a counter in them. Internal to columns/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace watertight::columns {

constexpr std::int64_t kLargestStep = 9999;  // from one number to the next

/// A text around its last whole number, which has no zeros in front.
struct CounterText {
  std::string_view before;
  std::int64_t number = 0;
  std::string_view after;
};

/// None for a text without digits, or with too many.
std::optional<CounterText> find_counter(std::string_view text);
/// The text with another number.
std::string with_number(const CounterText& text, std::int64_t number);
/// How much the number grew since `before`, if `text` is it with another number; none for a step
/// beyond kLargestStep.
std::optional<std::int64_t> counted_from(std::string_view before, std::string_view text);

}  // namespace watertight::columns
