// SPDX-License-Identifier: GPL-3.0-or-later
//
// The models of texts. A decision has contexts, each of which is a hash of facts that are known; a
// context picks one adaptive counter, and weights, which learn too, mix the counters. The
// arithmetic is that of the models of solids (docs/format.md, "Models"), but all contexts share one
// table of counters, as the facts about a text have no bounds. Internal to columns/.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <vector>

#include "codec/entropy/counter.h"
#include "codec/entropy/entropy_stream.h"
#include "columns/noted_array.h"

namespace watertight::columns {

using codec::EntropyStream;

/// Facts as a number of 32 bits.
using Hash = std::uint32_t;

/// The hash of facts in order. Cost: one multiplication for each.
constexpr Hash hash_of(Hash first, Hash second) {
  const std::uint64_t both = (std::uint64_t{first} << 32U) | second;
  return static_cast<Hash>(((both ^ 0x9E37'79B9'7F4A'7C15U) * 0xD6E8'FEB8'6659'FD93U) >> 32U);
}
template <class... More>
constexpr Hash hash_of(Hash first, Hash second, More... more) {
  return hash_of(hash_of(first, second), static_cast<Hash>(more)...);
}

/// The questions that decisions answer. The decisions of a question share weights, by their number
/// within an answer.
enum class Question : std::uint8_t {
  is_same_kind,
  kind,
  is_same_form,
  form,
  decimals,
  residual,
  residual_sign,
  list_index,
  is_next_known,
  known_distance,
  is_upper_case,
  has_same_affixes,
  is_last_uuid,
  is_known_uuid,
  is_next_uuid,
  uuid_distance,
  uuid_version,
  character,
  character_after_match,
  copy_length,
  is_end,
  mark_first,
  mark_second,
  mark_third,
  is_new_mark,
  mark_index,
  is_new_vertex,
  is_before_neighbour,
  is_after_neighbour,
  is_recent,
  recent_rank,
  is_vertex,
  vertex_distance,
  vertex_sign,
  coordinate_x,
  coordinate_y,
  coordinate_z,
  coordinate_sign,
  is_near_guess,
  guess_residual,
  is_known_coordinate,
  known_coordinate,
  is_equal_coordinate,
  counter_step,
  counter_sign,
  text_kind,
  count
};

class ContextMixer {
 public:
  /// A flag, symbol or number has 1 to 4 contexts.
  using ContextList = std::initializer_list<Hash>;
  /// The counters of a decision, one for each context.
  template <std::size_t count>
  using Counters = std::array<std::uint32_t*, count>;

  /// The mixer has 2^table_bits counters.
  explicit ContextMixer(int table_bits);

  /// Makes all that was learned count as so few answers and decisions at most, so that what comes
  /// changes it soon.
  void soften(std::uint32_t most_answers, std::uint32_t most_mixed);

  /// Makes this copy of a mixer that has not changed since equal to it again.
  void revert(const ContextMixer& original) {
    counters_.revert(original.counters_);
    weights_ = original.weights_;
  }

  /// Codes a yes or no.
  bool flag(EntropyStream& stream, Question question, ContextList contexts, bool value);
  /// Codes the lowest `bits` bits of a number, high ones first.
  std::uint32_t symbol(EntropyStream& stream, Question question, ContextList contexts, int bits,
                       std::uint32_t value);
  /// Codes a number below 2^63: its length in bits, then the `modelled` bits after the first under
  /// contexts, and the rest as they are.
  std::uint64_t number(EntropyStream& stream, Question question, ContextList contexts,
                       std::uint64_t value, int modelled);

  /// The counter of a context.
  std::uint32_t* counter(Hash context) { return &counters_.change(context >> shift_); }
  /// The counters of four decisions in a row, each of which knows the answers before it: that of a
  /// decision is the one at 1 and the answers before it.
  std::uint32_t* group(Hash context) {
    static_assert(kGroupBits <= NotedArray<std::uint32_t>::kBlockBits);
    return &counters_.change((context >> shift_) & ~((1U << kGroupBits) - 1));
  }
  static constexpr int kGroupBits = 4;
  /// Codes one decision, the `step`-th of an answer.
  template <std::size_t count>
  bool decide(EntropyStream& stream, Question question, std::size_t step,
              const Counters<count>& counters, bool value);

 private:
  static constexpr std::size_t kMostContexts = 7;
  static constexpr std::int64_t kSmallError = 512;  // in 1/65536: weights do not learn from less
  static constexpr std::size_t kSteps = 8;          // later decisions of an answer share weights
  struct Weights {
    std::array<std::int32_t, kMostContexts + 1> values{};
    std::uint32_t seen = 0;
  };
  template <std::size_t count>
  using Hashes = std::array<Hash, count>;

  template <std::size_t count>
  static Hashes<count> hashes_of(Question question, ContextList contexts);
  template <std::size_t count>
  static Hashes<count> hashes_at(const Hashes<count>& hashes, Hash place);
  template <std::size_t count>
  std::uint64_t code_low_bits(EntropyStream& stream, Question question, Hashes<count> hashes,
                              std::size_t first_step, int bits, std::uint64_t value);
  template <std::size_t count>
  int code_length(EntropyStream& stream, Question question, const Hashes<count>& hashes,
                  int length);
  template <std::size_t count>
  std::uint64_t code_number(EntropyStream& stream, Question question, ContextList contexts,
                            std::uint64_t value, int modelled);

  unsigned shift_;
  NotedArray<std::uint32_t> counters_;
  std::vector<Weights> weights_;
};

template <std::size_t count>
bool ContextMixer::decide(EntropyStream& stream, Question question, std::size_t step,
                          const Counters<count>& counters, bool value) {
  using namespace codec::counters;  // NOLINT(google-build-using-namespace)
  static_assert(count <= kMostContexts);
  Weights& weights =
      weights_[static_cast<std::size_t>(question) * kSteps + std::min(step, kSteps - 1)];
  if (weights.seen == 0) {
    weights.values.fill(first_weight(static_cast<std::uint32_t>(count)));
    weights.values[count] = 0;
  }
  std::array<std::int32_t, count + 1> inputs{};
  std::int64_t sum = static_cast<std::int64_t>(weights.values[count]) * kBiasInput;
  for (std::size_t i = 0; i < count; ++i) {
    inputs[i] = input_of(*counters[i]);
    sum += static_cast<std::int64_t>(weights.values[i]) * inputs[i];
  }
  inputs[count] = kBiasInput;
  const std::uint32_t ones = probability_of(sum);
  const bool bit = stream.code(value, ones);
  const std::int64_t error = (bit ? 65536 : 0) - static_cast<std::int64_t>(ones);
  if (std::abs(error) > kSmallError) {
    const std::int64_t move = error * mixing_rate(weights.seen);
    for (std::size_t i = 0; i <= count; ++i) {
      weights.values[i] = moved_weight(weights.values[i], move, inputs[i]);
    }
  }
  weights.seen = std::min(weights.seen + 1, kMaxMixed);
  for (std::size_t i = 0; i < count; ++i) *counters[i] = learned(*counters[i], bit);
  return bit;
}

}  // namespace watertight::columns
