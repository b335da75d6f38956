// SPDX-License-Identifier: GPL-3.0-or-later
//
// The models of texts. A decision has contexts, each of which is a hash of facts that are known; a
// context picks one adaptive counter, and weights, which learn too, mix the counters. The
// arithmetic is that of the models of solids (docs/format.md, "Models"), but all contexts share one
// table of counters, as the facts about a text have no bounds. Internal to columns/.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "codec/entropy/entropy_stream.h"

namespace watertight::columns {

using codec::EntropyStream;

/// Facts as a number of 32 bits.
using Hash = std::uint32_t;

/// The hash of facts in order. Cost: one multiplication for each.
constexpr Hash hash_of(Hash first, Hash second) {
  std::uint64_t mixed = (first ^ 0x9E3779B9U) * 0xD6E8FEB86659FD93U + second * 0xA0761D6478BD642FU;
  mixed ^= mixed >> 32U;
  mixed *= 0xE7037ED1A0B428DBU;
  return static_cast<Hash>(mixed >> 32U);
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
  vertex_distance,
  vertex_sign,
  coordinate_x,
  coordinate_y,
  coordinate_z,
  coordinate_sign,
  text_kind,
  count
};

class ContextMixer {
 public:
  /// A decision has 1 to 4 contexts, or this many.
  static constexpr std::size_t kMostContexts = 7;
  using ContextList = std::initializer_list<Hash>;

  /// The mixer has 2^table_bits counters.
  explicit ContextMixer(int table_bits);

  /// Makes all that was learned count as so few answers and decisions at most, so that what comes
  /// changes it soon.
  void soften(std::uint32_t most_answers = 1, std::uint32_t most_mixed = 8);

  /// Codes a yes or no.
  bool flag(EntropyStream& stream, Question question, ContextList contexts, bool value);
  /// Codes the lowest `bits` bits of a number, high ones first.
  std::uint32_t symbol(EntropyStream& stream, Question question, ContextList contexts, int bits,
                       std::uint32_t value);
  /// Codes a number below 2^63: its length in bits, then the `modelled` bits after the first under
  /// contexts, and the rest as they are.
  std::uint64_t number(EntropyStream& stream, Question question, ContextList contexts,
                       std::uint64_t value, int modelled);

  /// The counters of the contexts of a question. Those of four decisions in a row, each of which
  /// knows the answers before it, lie side by side.
  class Inputs {
   public:
    Inputs(Question question, std::span<const Hash> contexts);
    /// The same inputs at a place within an answer.
    Inputs at(Hash place) const;
    /// These inputs and one more.
    Inputs with(Hash context) const;

   private:
    friend class ContextMixer;
    std::array<Hash, kMostContexts> hashes_{};
    std::size_t count_ = 0;
  };
  static constexpr int kGroupBits = 4;
  /// Codes one decision, the `step`-th of an answer. `node` is 1 and the answers before it in its
  /// group, 1 to 15; 0 for a decision that has no group.
  bool decide(EntropyStream& stream, Question question, std::size_t step, const Inputs& inputs,
              std::uint32_t node, bool value);

 private:
  static constexpr std::size_t kSteps = 8;  // later decisions of an answer share weights
  struct Weights {
    std::array<std::int32_t, kMostContexts + 1> values{};
    std::uint32_t seen = 0;
  };

  template <std::size_t count>
  bool decide_of(EntropyStream& stream, Weights& weights, const Inputs& contexts,
                 std::uint32_t node, bool value);
  std::uint64_t code_low_bits(EntropyStream& stream, Question question, const Inputs& inputs,
                              std::size_t first_step, int bits, std::uint64_t value);

  int shift_;
  std::vector<std::uint32_t> counters_;
  std::vector<Weights> weights_;
};

}  // namespace watertight::columns
