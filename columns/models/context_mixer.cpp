// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/models/context_mixer.h"

#include <algorithm>
#include <bit>

#include "base/assert.h"
#include "codec/entropy/counter.h"

namespace watertight::columns {
namespace {

using namespace codec::counters;  // NOLINT(google-build-using-namespace)

constexpr Hash kAfterLength = 4096;  // the place of the bits after a length
constexpr int kLengthBits = 6;
constexpr std::size_t kStepAfterLength = 4;

}  // namespace

ContextMixer::Inputs::Inputs(Question question, std::span<const Hash> contexts)
    : count_(contexts.size()) {
  WATERTIGHT_ASSERT(count_ <= hashes_.size());
  for (std::size_t i = 0; i < count_; ++i) {
    hashes_[i] = hash_of(contexts[i], static_cast<Hash>(question) * 16 + static_cast<Hash>(i));
  }
}

ContextMixer::Inputs ContextMixer::Inputs::at(Hash place) const {
  Inputs placed = *this;
  for (std::size_t i = 0; i < count_; ++i) placed.hashes_[i] = hash_of(hashes_[i], place);
  return placed;
}

ContextMixer::Inputs ContextMixer::Inputs::with(Hash context) const {
  WATERTIGHT_ASSERT(count_ < hashes_.size());
  Inputs more = *this;
  more.hashes_[more.count_++] = context;
  return more;
}

ContextMixer::ContextMixer(int table_bits)
    : shift_(32 - table_bits),
      counters_(std::size_t{1} << static_cast<unsigned>(table_bits), kUnknown),
      weights_(static_cast<std::size_t>(Question::count) * kSteps) {}

void ContextMixer::soften(std::uint32_t most_answers, std::uint32_t most_mixed) {
  for (std::uint32_t& counter : counters_) {
    counter = (counter & ~kCountBits) | std::min(counter & kCountBits, most_answers);
  }
  for (Weights& weights : weights_) weights.seen = std::min(weights.seen, most_mixed);
}

template <std::size_t count>
bool ContextMixer::decide_of(EntropyStream& stream, Weights& weights, const Inputs& contexts,
                             std::uint32_t node, bool value) {
  constexpr std::uint32_t kGroup = 1U << kGroupBits;
  if (weights.seen == 0) {
    weights.values.fill(first_weight(static_cast<std::uint32_t>(count)));
    weights.values[count] = 0;
  }
  std::array<std::int32_t, count + 1> inputs{};
  std::array<std::uint32_t*, count> counters{};
  std::int64_t sum = static_cast<std::int64_t>(weights.values[count]) * kBiasInput;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t counter = contexts.hashes_[i] >> static_cast<unsigned>(shift_);
    counters[i] = &counters_[node == 0 ? counter : (counter & ~(kGroup - 1)) + node];
    inputs[i] = input_of(*counters[i]);
    sum += static_cast<std::int64_t>(weights.values[i]) * inputs[i];
  }
  inputs[count] = kBiasInput;
  const std::uint32_t ones = probability_of(sum);
  const bool bit = stream.code(value, ones);
  const std::int64_t error = (bit ? 65536 : 0) - static_cast<std::int64_t>(ones);
  const std::int64_t move = error * mixing_rate(weights.seen);
  for (std::size_t i = 0; i <= count; ++i) {
    weights.values[i] = moved_weight(weights.values[i], move, inputs[i]);
  }
  weights.seen = std::min(weights.seen + 1, kMaxMixed);
  for (std::size_t i = 0; i < count; ++i) *counters[i] = learned(*counters[i], bit);
  return bit;
}

bool ContextMixer::decide(EntropyStream& stream, Question question, std::size_t step,
                          const Inputs& inputs, std::uint32_t node, bool value) {
  WATERTIGHT_ASSERT(node < (1U << kGroupBits));
  Weights& weights =
      weights_[static_cast<std::size_t>(question) * kSteps + std::min(step, kSteps - 1)];
  switch (inputs.count_) {
    case 1:
      return decide_of<1>(stream, weights, inputs, node, value);
    case 2:
      return decide_of<2>(stream, weights, inputs, node, value);
    case 3:
      return decide_of<3>(stream, weights, inputs, node, value);
    case 4:
      return decide_of<4>(stream, weights, inputs, node, value);
    case 7:
      return decide_of<7>(stream, weights, inputs, node, value);
    default:
      WATERTIGHT_ASSERT(false);
      return false;
  }
}

bool ContextMixer::flag(EntropyStream& stream, Question question, ContextList contexts,
                        bool value) {
  return decide(stream, question, 0, Inputs(question, contexts), 0, value);
}

std::uint64_t ContextMixer::code_low_bits(EntropyStream& stream, Question question,
                                          const Inputs& inputs, std::size_t first_step, int bits,
                                          std::uint64_t value) {
  Inputs group = inputs;
  std::uint64_t result = 1;
  std::uint32_t node = 1;
  for (int i = 0; i < bits; ++i) {
    if (i > 0 && i % kGroupBits == 0) {
      group = inputs.at(static_cast<Hash>(result));
      node = 1;
    }
    const bool bit = decide(stream, question, first_step + static_cast<std::size_t>(i), group, node,
                            ((value >> (bits - 1 - i)) & 1U) != 0);
    node = node * 2 + (bit ? 1U : 0U);
    result = result * 2 + (bit ? 1U : 0U);
  }
  return result - (std::uint64_t{1} << bits);
}

std::uint32_t ContextMixer::symbol(EntropyStream& stream, Question question, ContextList contexts,
                                   int bits, std::uint32_t value) {
  return static_cast<std::uint32_t>(
      code_low_bits(stream, question, Inputs(question, contexts), 0, bits, value));
}

std::uint64_t ContextMixer::number(EntropyStream& stream, Question question, ContextList contexts,
                                   std::uint64_t value, int modelled) {
  const Inputs inputs(question, contexts);
  const auto length = static_cast<int>(code_low_bits(
      stream, question, inputs, 0, kLengthBits, static_cast<std::uint64_t>(std::bit_width(value))));
  if (length <= 1) return static_cast<std::uint64_t>(length);
  const int under_contexts = std::min(length - 1, modelled);
  const int rest = length - 1 - under_contexts;
  const Inputs after = inputs.at(static_cast<Hash>(length) + kAfterLength);
  const std::uint64_t high =
      (std::uint64_t{1} << under_contexts) |
      code_low_bits(stream, question, after, kStepAfterLength, under_contexts, value >> rest);
  return rest == 0 ? high : (high << rest) | stream.code_bits(value, rest);
}

}  // namespace watertight::columns
