// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/models/context_mixer.h"

#include <algorithm>
#include <bit>
#include <type_traits>

#include "base/assert.h"

namespace watertight::columns {
namespace {

using codec::counters::kCountBits;
using codec::counters::kUnknown;

constexpr Hash kAfterLength = 4096;  // the place of the bits after a length
constexpr Hash kLongLength = 8192;   // the place of a long length
constexpr int kShortLengthBits = 4;
constexpr int kLongest = (1 << kShortLengthBits) - 1;  // stands for a long length
constexpr int kLongLengthBits = 6;
constexpr std::size_t kStepAfterLength = 4;
constexpr std::size_t kStepOfLongLength = 7;

/// Calls a function with the number of contexts as a constant.
template <class Function>
auto with_count(std::size_t count, const Function& function) {
  switch (count) {
    case 1:
      return function(std::integral_constant<std::size_t, 1>{});
    case 2:
      return function(std::integral_constant<std::size_t, 2>{});
    case 3:
      return function(std::integral_constant<std::size_t, 3>{});
    default:
      WATERTIGHT_ASSERT(count == 4);
      return function(std::integral_constant<std::size_t, 4>{});
  }
}

}  // namespace

ContextMixer::ContextMixer(int table_bits)
    : shift_(static_cast<unsigned>(32 - table_bits)),
      counters_(std::size_t{1} << static_cast<unsigned>(table_bits), kUnknown),
      weights_(static_cast<std::size_t>(Question::count) * kSteps) {}

void ContextMixer::soften(std::uint32_t most_answers, std::uint32_t most_mixed) {
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    std::uint32_t& counter = counters_.change(i);
    counter = (counter & ~kCountBits) | std::min(counter & kCountBits, most_answers);
  }
  for (Weights& weights : weights_) weights.seen = std::min(weights.seen, most_mixed);
}

template <std::size_t count>
ContextMixer::Hashes<count> ContextMixer::hashes_of(Question question, ContextList contexts) {
  Hashes<count> hashes{};
  for (std::size_t i = 0; i < count; ++i) {
    hashes[i] =
        hash_of(contexts.begin()[i], static_cast<Hash>(question) * 16 + static_cast<Hash>(i));
  }
  return hashes;
}

template <std::size_t count>
ContextMixer::Hashes<count> ContextMixer::hashes_at(const Hashes<count>& hashes, Hash place) {
  Hashes<count> placed{};
  for (std::size_t i = 0; i < count; ++i) placed[i] = hash_of(hashes[i], place);
  return placed;
}

bool ContextMixer::flag(EntropyStream& stream, Question question, ContextList contexts,
                        bool value) {
  return with_count(contexts.size(), [&](auto count) {
    const Hashes<count> hashes = hashes_of<count>(question, contexts);
    Counters<count> counters{};
    for (std::size_t i = 0; i < count; ++i) counters[i] = counter(hashes[i]);
    return decide<count>(stream, question, 0, counters, value);
  });
}

template <std::size_t count>
std::uint64_t ContextMixer::code_low_bits(EntropyStream& stream, Question question,
                                          Hashes<count> hashes, std::size_t first_step, int bits,
                                          std::uint64_t value) {
  Counters<count> groups{};
  std::uint64_t result = 1;
  std::uint32_t node = 1;
  for (int i = 0; i < bits; ++i) {
    if (i % kGroupBits == 0) {
      for (std::size_t j = 0; j < count; ++j) {
        groups[j] = group(i == 0 ? hashes[j] : hash_of(hashes[j], static_cast<Hash>(result)));
      }
      node = 1;
    }
    Counters<count> counters{};
    for (std::size_t j = 0; j < count; ++j) counters[j] = groups[j] + node;
    const bool bit = decide<count>(stream, question, first_step + static_cast<std::size_t>(i),
                                   counters, ((value >> (bits - 1 - i)) & 1U) != 0);
    node = node * 2 + (bit ? 1U : 0U);
    result = result * 2 + (bit ? 1U : 0U);
  }
  return result - (std::uint64_t{1} << bits);
}

std::uint32_t ContextMixer::symbol(EntropyStream& stream, Question question, ContextList contexts,
                                   int bits, std::uint32_t value) {
  return with_count(contexts.size(), [&](auto count) {
    return static_cast<std::uint32_t>(code_low_bits<count>(
        stream, question, hashes_of<count>(question, contexts), 0, bits, value));
  });
}

template <std::size_t count>
int ContextMixer::code_length(EntropyStream& stream, Question question, const Hashes<count>& hashes,
                              int length) {
  const auto coded = static_cast<int>(
      code_low_bits<count>(stream, question, hashes, 0, kShortLengthBits,
                           static_cast<std::uint64_t>(std::min(length, kLongest))));
  if (coded < kLongest) return coded;
  return static_cast<int>(
      code_low_bits<count>(stream, question, hashes_at<count>(hashes, kLongLength),
                           kStepOfLongLength, kLongLengthBits, static_cast<std::uint64_t>(length)));
}

template <std::size_t count>
std::uint64_t ContextMixer::code_number(EntropyStream& stream, Question question,
                                        ContextList contexts, std::uint64_t value, int modelled) {
  const Hashes<count> hashes = hashes_of<count>(question, contexts);
  const int length =
      code_length<count>(stream, question, hashes, static_cast<int>(std::bit_width(value)));
  if (length <= 1) return static_cast<std::uint64_t>(length);
  const int under_contexts = std::min(length - 1, modelled);
  const int rest = length - 1 - under_contexts;
  const std::uint64_t high =
      (std::uint64_t{1} << under_contexts) |
      code_low_bits<count>(stream, question,
                           hashes_at<count>(hashes, static_cast<Hash>(length) + kAfterLength),
                           kStepAfterLength, under_contexts, value >> rest);
  return rest == 0 ? high : (high << rest) | stream.code_plain_bits(value, rest);
}

std::uint64_t ContextMixer::number(EntropyStream& stream, Question question, ContextList contexts,
                                   std::uint64_t value, int modelled) {
  return with_count(contexts.size(), [&](auto count) {
    return code_number<count>(stream, question, contexts, value, modelled);
  });
}

}  // namespace watertight::columns
