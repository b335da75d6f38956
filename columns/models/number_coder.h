// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the numbers of a column: the form in which they are written, and the difference from a
// prediction. Internal to columns/.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "columns/models/context_mixer.h"
#include "columns/models/number_form.h"

namespace watertight::columns {

/// What is known about the numbers of a column.
class NumberColumn {
 public:
  const std::optional<NumberForm>& form() const { return form_; }
  /// The last number, in units of the form.
  std::int64_t last() const { return last_; }

  /// Codes the form of the next number, or that none comes. Fails the stream when the form that is
  /// read is none.
  std::optional<NumberForm> code_form(EntropyStream& stream, ContextMixer& mixer, Hash column,
                                      const std::optional<NumberForm>& form);
  /// Codes a number of the last form. `neighbour` is the value before it, if that is a number.
  std::int64_t code_number(EntropyStream& stream, ContextMixer& mixer, Hash column, Hash sibling,
                           std::optional<std::int64_t> neighbour, std::int64_t number);
  /// Takes a number that was not coded here, if it is of the form.
  void see(const FormedNumber& number);

 private:
  static constexpr std::size_t kPredictions = 6;
  std::array<std::int64_t, kPredictions> predictions(std::optional<std::int64_t> neighbour) const;
  void take(std::int64_t number);

  std::optional<NumberForm> form_;
  std::int64_t last_ = 0;
  std::int64_t before_last_ = 0;
  std::int64_t largest_ = -1;
  std::uint32_t last_residual_ = 0;                  // its length in bits, and its sign
  std::array<std::int32_t, kPredictions> misses_{};  // the usual lengths of residuals, in 1/256 bit
};

/// The difference of two numbers, and a number and its difference; on all numbers of 64 bits.
std::int64_t difference(std::int64_t a, std::int64_t b);
std::int64_t sum(std::int64_t a, std::int64_t b);
/// The size of a number; that of the least one is 2^63.
std::uint64_t magnitude(std::int64_t number);

/// Follows how well predictions do: the usual lengths of their residuals, in 1/256 bit.
template <std::size_t count>
void judge(std::array<std::int32_t, count>& misses,
           const std::array<std::int64_t, count>& predictions, std::int64_t number, int memory) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto length =
        static_cast<std::int32_t>(std::bit_width(magnitude(difference(number, predictions[i]))));
    misses[i] += (length * 256 - misses[i]) >> memory;
  }
}
template <std::size_t count>
std::size_t best_of(const std::array<std::int32_t, count>& misses) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < count; ++i) {
    if (misses[i] < misses[best]) best = i;
  }
  return best;
}

}  // namespace watertight::columns
