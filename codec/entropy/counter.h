// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arithmetic of adaptive models (docs/format.md, "Models"): counters, which estimate the
// probability of an answer, and weights, which mix them in the logistic domain. All of it is on
// integers. Source: M. Mahoney, "Adaptive weighing of context models for lossless data compression"
// (2005).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace watertight::codec::counters {

// In the logistic domain an integer x from -2047 to 2047 stands for the probability p with
// ln(p / (1 - p)) = x / 256.
inline constexpr std::int32_t kDomain = 2047;
inline constexpr std::uint32_t kLeastProbability = 32;  // the least probability of an answer, in
                                                        // 1/65536

/// round(65536 / (1 + exp((32 - i) / 4))) for i = 0 to 64: part of the format.
inline constexpr std::array<std::int32_t, 65> kSquash{
    22,    28,    36,    47,    60,    77,    98,    126,   162,   208,   267,   342,   439,
    562,   720,   922,   1179,  1506,  1921,  2446,  3108,  3938,  4971,  6249,  7812,  9702,
    11955, 14595, 17625, 21025, 24743, 28693, 32768, 36843, 40793, 44511, 47911, 50941, 53581,
    55834, 57724, 59287, 60565, 61598, 62428, 63090, 63615, 64030, 64357, 64614, 64816, 64974,
    65097, 65194, 65269, 65328, 65374, 65410, 65438, 65459, 65476, 65489, 65500, 65508, 65514};

/// The probability, in 1/65536, at `x`; linear between the points of kSquash.
constexpr std::int32_t squash(std::int32_t x) {
  const std::int32_t offset = std::clamp(x, -kDomain, kDomain) + 2048;
  const auto i = static_cast<std::size_t>(offset >> 6);
  const std::int32_t rest = offset & 63;
  return (kSquash[i] * (64 - rest) + kSquash[i + 1] * rest) >> 6;
}

/// The inverse of squash() by the upper 12 bits of a probability: the least x whose squash() is not
/// below that probability.
inline constexpr auto kStretch = [] {
  std::array<std::int16_t, 4096> table{};
  std::int32_t x = -kDomain;
  for (std::int32_t i = 0; i < 4096; ++i) {
    while (x < kDomain && squash(x) < 16 * i + 8) ++x;
    table[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(x);
  }
  return table;
}();

// A counter has 22 bits for its probability, and below them 10 bits for the number of observations.
inline constexpr std::uint32_t kCountBits = 1023;
inline constexpr std::uint32_t kMaxCount = 250;
inline constexpr std::uint32_t kUnknown = (1U << 21) << 10;  // one half, nothing observed

/// The share, in 1/65536, by which a counter that observed n decisions moves towards the next
/// answer: 65536 / (n + 1.5).
inline constexpr auto kRates = [] {
  std::array<std::int32_t, kMaxCount + 1> rates{};
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(rates.size()); ++n) {
    rates[static_cast<std::size_t>(n)] = 131072 / (2 * n + 3);
  }
  return rates;
}();

/// The weight, in 1/256, of a counter that observed n decisions: n / (n + 0.4).
inline constexpr auto kConfidence = [] {
  std::array<std::int32_t, kMaxCount + 1> table{};
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(table.size()); ++n) {
    table[static_cast<std::size_t>(n)] = 2560 * n / (10 * n + 4);
  }
  return table;
}();

/// The counter after an answer.
constexpr std::uint32_t learned(std::uint32_t counter, bool value) {
  const std::uint32_t count = counter & 1023U;
  const auto probability = static_cast<std::int64_t>(counter >> 10);
  const std::int64_t target = value ? (1 << 22) - 1 : 0;
  const std::int64_t next = probability + (((target - probability) * kRates[count]) >> 16);
  return (static_cast<std::uint32_t>(next) << 10) | std::min(count + 1, kMaxCount);
}

/// The input that a counter gives to the mix.
constexpr std::int32_t input_of(std::uint32_t counter) {
  return (kStretch[counter >> 20] * kConfidence[counter & 1023U]) >> 8;
}

// Weights are fixed-point numbers, 16.16. The weight of a constant input follows those of the
// inputs.
inline constexpr std::int32_t kBiasInput = 64;
inline constexpr std::int64_t kWeightLimit = 8 << 16;
inline constexpr std::uint32_t kMaxMixed = 1000;

/// The weight of each of so many inputs at first.
constexpr std::int32_t first_weight(std::uint32_t inputs) {
  return static_cast<std::int32_t>((1U << 18U) / (3 + inputs));
}

/// The learning rates, in 1/4096, of a set of weights after so many decisions.
inline constexpr auto kMixingRates = [] {
  std::array<std::uint8_t, kMaxMixed + 1> rates{};
  for (std::uint32_t mixed = 0; mixed < rates.size(); ++mixed) {
    rates[mixed] = static_cast<std::uint8_t>(10 + 1600 / (16 + mixed));
  }
  return rates;
}();
constexpr std::int64_t mixing_rate(std::uint32_t mixed) { return kMixingRates[mixed]; }

/// The probability of a yes, in 1/65536, of a sum of weights times inputs.
constexpr std::uint32_t probability_of(std::int64_t sum) {
  const auto x = static_cast<std::int32_t>(std::clamp<std::int64_t>(sum >> 16, -kDomain, kDomain));
  return std::clamp(static_cast<std::uint32_t>(squash(x)), kLeastProbability,
                    65536 - kLeastProbability);
}

/// The weight of an input after a decision; `step` is its error times the learning rate.
constexpr std::int32_t moved_weight(std::int32_t weight, std::int64_t step, std::int32_t input) {
  return static_cast<std::int32_t>(
      std::clamp<std::int64_t>(weight + ((step * input) >> 20), -kWeightLimit, kWeightLimit));
}

}  // namespace watertight::codec::counters
