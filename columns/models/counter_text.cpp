// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/models/counter_text.h"

#include <charconv>

namespace watertight::columns {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::size_t kMostDigits = 15;

}  // namespace

std::optional<CounterText> find_counter(std::string_view text) {
  const std::size_t last = text.find_last_of(kDigits);
  if (last == std::string_view::npos) return std::nullopt;
  const std::size_t end = last + 1;
  const std::size_t other = text.find_last_not_of(kDigits, last);
  std::size_t begin = other == std::string_view::npos ? 0 : other + 1;
  while (begin < last && text[begin] == '0') ++begin;
  if (end - begin > kMostDigits) return std::nullopt;
  CounterText found{text.substr(0, begin), 0, text.substr(end)};
  std::from_chars(text.data() + begin, text.data() + end, found.number);
  return found;
}

std::string with_number(const CounterText& text, std::int64_t number) {
  return std::string(text.before).append(std::to_string(number)).append(text.after);
}

std::optional<std::int64_t> counted_from(std::string_view before, std::string_view text) {
  const auto a = find_counter(before);
  const auto b = find_counter(text);
  if (!a || !b || a->before != b->before || a->after != b->after) return std::nullopt;
  const std::int64_t step = b->number - a->number;
  if (step > kLargestStep || step < -kLargestStep) return std::nullopt;
  return step;
}

}  // namespace watertight::columns
