// SPDX-License-Identifier: GPL-3.0-or-later
//
// Contexts: what is known when a decision is coded, as an index into a table of counters. The type
// of a context carries the number of its values, so that the size of the table follows from the
// expression of the index (model_layout.h compares it with the size that the format states). Sizes
// exist at compile time only and cost nothing.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "base/assert.h"

namespace watertight::codec {

/// A number from 0 to `size` - 1.
template <std::uint32_t size>
struct Context {
  std::uint32_t value;

  /// Requires number < size.
  template <class Number>
  requires std::unsigned_integral<Number> || std::is_enum_v<Number>
  explicit constexpr Context(Number number) : value(static_cast<std::uint32_t>(number)) {
    WATERTIGHT_ASSERT(value < size);
  }
};

/// The context of a table that has one counter.
inline constexpr Context<1> kNothingKnown{0U};

/// Several contexts as one, in mixed radix, the most significant first. In the texts of the format:
/// (a, b [size of b], c [size of c]).
template <std::uint32_t size>
constexpr Context<size> combine(Context<size> only) {
  return only;
}
template <std::uint32_t first, std::uint32_t second, std::uint32_t... others>
constexpr auto combine(Context<first> a, Context<second> b, Context<others>... rest) {
  return combine(Context<first * second>(a.value * second + b.value), rest...);
}

/// The number from 0 to size - 1 that is nearest to `number`. In the texts of the format:
/// cap(number, size).
template <std::uint32_t size, std::integral Number>
constexpr Context<size> capped(Number number) {
  if (number < 0) return Context<size>(0U);
  return Context<size>(std::min<std::uint64_t>(static_cast<std::uint64_t>(number), size - 1));
}

/// A context with half as many classes, each of twice the width.
template <std::uint32_t size>
constexpr Context<(size + 1) / 2> halved(Context<size> context) {
  return Context<(size + 1) / 2>(context.value / 2);
}

/// Two kinds of contexts may share the table of one input. leading() makes the index of a context
/// of the first kind, for a table in which `others` values of the second kind follow. trailing()
/// makes the index of a context of the second kind, after the `others` values of the first kind.
template <std::uint32_t others, std::uint32_t size>
constexpr Context<size + others> leading(Context<size> context) {
  return Context<size + others>(context.value);
}
template <std::uint32_t others, std::uint32_t size>
constexpr Context<others + size> trailing(Context<size> context) {
  return Context<others + size>(others + context.value);
}

/// The last answers to one question, at most `count`: the latest is the lowest bit, answers not
/// given yet count as 0.
template <std::uint32_t count>
class Answers {
 public:
  void add(bool answer) { bits_ = (bits_ * 2 + (answer ? 1U : 0U)) & ((1U << count) - 1); }
  /// The last `fewer` answers.
  template <std::uint32_t fewer = count>
  Context<(1U << fewer)> last() const {
    static_assert(fewer <= count);
    return Context<(1U << fewer)>(bits_ & ((1U << fewer) - 1));
  }

 private:
  std::uint32_t bits_ = 0;
};

/// The contexts of one decision: one for each input of its family.
template <std::uint32_t... sizes>
struct Contexts {
  std::array<std::uint32_t, sizeof...(sizes)> values{};

  explicit constexpr Contexts() = default;
  // Not explicit: calls write the contexts in braces.
  // NOLINTNEXTLINE(google-explicit-constructor)
  constexpr Contexts(Context<sizes>... contexts) : values{contexts.value...} {}
};

}  // namespace watertight::codec
