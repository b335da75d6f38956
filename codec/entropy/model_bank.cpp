// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/entropy/model_bank.h"

#include <algorithm>
#include <bit>
#include <type_traits>

#include "base/assert.h"
#include "codec/entropy/counter.h"

namespace watertight::codec {
namespace {

using namespace counters;  // NOLINT(google-build-using-namespace)

// A number has three families: its length in unary, the bits after the first, the sign.
constexpr std::uint32_t kLengths = 48;  // greater lengths share the last context
constexpr std::uint32_t kMantissaStates =
    7;  // the modelled bits so far: none (1 state), one (2) or two (4)
constexpr std::uint32_t kMantissaLengths = 16;
constexpr int kModelledBits = 3;
constexpr std::uint32_t kMostUnrolled = 6;  // nearly all families have fewer inputs

/// Calls a function with the number of inputs, as a constant if it is at most `most`: the compiler
/// then unrolls the loops over the inputs.
template <std::uint32_t most, class Function>
auto with_count(std::uint32_t inputs, const Function& function) {
  if constexpr (most == 0) {
    return function(inputs);
  } else {
    if (inputs == most) return function(std::integral_constant<std::uint32_t, most>{});
    return with_count<most - 1>(inputs, function);
  }
}

}  // namespace

ModelBank::ModelBank(const ModelLayout& layout) : is_agile_(layout.is_agile) {
  for (const FamilyShape& shape : layout.families) add_family(shape);
  number_base_ = families_.size();
  for (const NumberShape& number : layout.numbers) {
    FamilyShape length{.selectors = number.selectors};
    FamilyShape mantissa{.selectors = kModelledBits, .inputs = {kLengths * kMantissaStates}};
    const FamilyShape sign{.selectors = number.selectors, .inputs = number.inputs};
    WATERTIGHT_ASSERT(input_count(number) < kMaxInputs);
    for (std::size_t i = 0; i < input_count(number); ++i) {
      length.inputs[i] = number.inputs[i] * kLengths;
      mantissa.inputs[i + 1] = number.inputs[i] * kMantissaLengths * kMantissaStates;
    }
    add_family(length);
    add_family(mantissa);
    add_family(sign);
  }
  set_first_values();
}

std::int32_t ModelBank::first_weight(std::uint32_t inputs) const {
  return is_agile_ ? static_cast<std::int32_t>((1U << 16) / inputs)
                   : counters::first_weight(inputs);
}

void ModelBank::add_family(const FamilyShape& shape) {
  Family family;
  family.selectors = shape.selectors;
  family.first_weight = static_cast<std::uint32_t>(weights_);
  family.first_rate = static_cast<std::uint32_t>(rates_);
  family.inputs = static_cast<std::uint32_t>(input_count(shape));
  family.sizes = shape.inputs;
  for (std::uint32_t i = 0; i < family.inputs; ++i) {
    family.first_counter[i] = static_cast<std::uint32_t>(counters_);
    counters_ += shape.inputs[i];
  }
  weights_ += shape.selectors * (family.inputs + std::size_t{1});
  rates_ += shape.selectors;
  families_.push_back(family);
}

/// Makes the values of a bank that learned nothing. The weights of the families then follow the
/// counters, and the rates follow the weights.
void ModelBank::set_first_values() {
  values_.assign(counters_ + weights_ + rates_, 0);
  std::fill_n(values_.begin(), counters_, kUnknown);
  for (Family& family : families_) {
    family.first_weight += static_cast<std::uint32_t>(counters_);
    family.first_rate += static_cast<std::uint32_t>(counters_ + weights_);
    std::uint32_t* weight = &values_[family.first_weight];
    for (std::uint32_t selector = 0; selector < family.selectors; ++selector) {
      weight = std::fill_n(weight, family.inputs,
                           static_cast<std::uint32_t>(first_weight(family.inputs)));
      ++weight;  // the weight of the constant input is 0
    }
  }
}

template <class Count>
ModelBank::Mix ModelBank::mix(Count inputs, const Family& family, const std::uint32_t* weight,
                              const std::uint32_t* contexts) const {
  Mix result;
  const std::uint32_t* values = values_.data();
  const auto weighted = [](std::uint32_t weight_bits, std::int32_t input) {
    return std::int64_t{static_cast<std::int32_t>(weight_bits)} * input;
  };
  std::int64_t sum = weighted(weight[inputs], kBiasInput);
  for (std::uint32_t i = 0; i < inputs; ++i) {
    WATERTIGHT_ASSERT(contexts[i] < family.sizes[i]);
    result.counter[i] = family.first_counter[i] + contexts[i];
    result.input[i] = input_of(values[result.counter[i]]);
    sum += weighted(weight[i], result.input[i]);
  }
  result.input[inputs] = kBiasInput;
  result.ones = probability_of(sum);
  return result;
}

template <class Count>
bool ModelBank::code_at(Count inputs, EntropyStream& stream, const Family& family,
                        std::uint32_t selector, const std::uint32_t* contexts, bool value) {
  std::uint32_t* const values = values_.data();
  std::uint32_t* const weight = values + family.first_weight + selector * (inputs + 1);
  const Mix mixed = mix(inputs, family, weight, contexts);
  if (trials_ > 0) note_changes(family, selector, mixed);
  const bool bit = stream.code(value, mixed.ones);

  std::uint32_t& seen = values[family.first_rate + selector];
  const std::int64_t step = ((bit ? 65536 : 0) - static_cast<std::int64_t>(mixed.ones)) *
                            mixing_rate(seen) * (is_agile_ ? 2 : 1);
  for (std::uint32_t i = 0; i <= inputs; ++i) {
    const std::int32_t moved =
        moved_weight(static_cast<std::int32_t>(weight[i]), step, mixed.input[i]);
    weight[i] = static_cast<std::uint32_t>(moved);
  }
  seen = std::min(seen + 1, kMaxMixed);
  for (std::uint32_t i = 0; i < inputs; ++i) {
    std::uint32_t& counter = values[mixed.counter[i]];
    counter = learned(counter, bit);
  }
  return bit;
}

bool ModelBank::code_at(EntropyStream& stream, const Family& family, std::uint32_t selector,
                        const std::uint32_t* contexts, bool value) {
  return with_count<kMostUnrolled>(family.inputs, [&](auto inputs) {
    return code_at(inputs, stream, family, selector, contexts, value);
  });
}

void ModelBank::note_from_now() {
  WATERTIGHT_ASSERT(trials_ == 0);
  is_noting_ = true;
  trials_ = 1;
}

bool ModelBank::take_back() {
  if (!is_noting_) return false;
  undo(0);
  return true;
}

void ModelBank::note_changes(const Family& family, std::uint32_t selector, const Mix& mixed) {
  // To note and undo a change takes several times as long as to copy a value.
  if (is_noting_ && trials_ == 1 && changes_.size() > counters_ / 4) {
    changes_ = {};
    trials_ = 0;
    is_noting_ = false;
    return;
  }
  const std::size_t noted = changes_.size();
  changes_.resize(noted + 2 * std::size_t{family.inputs} + 2);
  Change* change = &changes_[noted];
  const std::uint32_t* values = values_.data();
  const auto note = [&](std::uint32_t index) { *change++ = {index, values[index]}; };
  for (std::uint32_t i = 0; i < family.inputs; ++i) note(mixed.counter[i]);
  const std::uint32_t first = family.first_weight + selector * (family.inputs + 1);
  for (std::uint32_t i = first; i <= first + family.inputs; ++i) note(i);
  note(family.first_rate + selector);
}

void ModelBank::undo(std::size_t left) {
  for (std::size_t i = changes_.size(); i > left; --i) {
    values_[changes_[i - 1].index] = changes_[i - 1].before;
  }
  changes_.resize(left);
}

std::uint32_t ModelBank::probability(std::uint32_t family, std::uint32_t selector,
                                     std::span<const std::uint32_t> contexts) const {
  WATERTIGHT_ASSERT(family < number_base_ && contexts.size() == families_[family].inputs);
  const Family& asked = families_[family];
  const std::uint32_t* const weight =
      &values_[asked.first_weight + selector * (asked.inputs + std::size_t{1})];
  return mix(asked.inputs, asked, weight, contexts.data()).ones;
}

bool ModelBank::code(EntropyStream& stream, std::uint32_t family, std::uint32_t selector,
                     std::span<const std::uint32_t> contexts, bool value) {
  WATERTIGHT_ASSERT(family < number_base_ && contexts.size() == families_[family].inputs);
  return code_at(stream, families_[family], selector, contexts.data(), value);
}

std::uint64_t ModelBank::code_number(EntropyStream& stream, std::uint32_t number,
                                     std::uint32_t selector,
                                     std::span<const std::uint32_t> contexts, std::uint64_t value,
                                     int max_length) {
  const Family& lengths = families_[number_base_ + 3 * std::size_t{number}];
  const Family& mantissas = families_[number_base_ + 3 * std::size_t{number} + 1];
  WATERTIGHT_ASSERT(contexts.size() == lengths.inputs);
  std::array<std::uint32_t, kMaxInputs> at{};

  // The bit length of the number (0 for 0) in unary: one zero for each bit, then a one.
  const auto true_length = static_cast<int>(std::bit_width(value));
  int length = 0;
  while (true) {
    const std::uint32_t step = std::min(static_cast<std::uint32_t>(length), kLengths - 1);
    std::size_t i = 0;
    for (const std::uint32_t context : contexts) at[i++] = context * kLengths + step;
    if (code_at(stream, lengths, selector, at.data(), length == true_length)) break;
    if (++length > max_length || stream.failed()) {
      stream.fail();
      return 0;
    }
  }
  if (length <= 1) return static_cast<std::uint64_t>(length);

  // The bits after the first: the next three under models, the others plain.
  std::uint64_t result = 1;
  const int modelled = std::min(length - 1, kModelledBits);
  for (int bit = 0; bit < modelled; ++bit) {
    const auto state = static_cast<std::uint32_t>(result - 1);  // 0; then 1 or 2; then 3 to 6
    const auto lower = static_cast<std::uint32_t>(length);
    at[0] = std::min(lower, kLengths - 1) * kMantissaStates + state;
    std::size_t i = 1;
    for (const std::uint32_t context : contexts) {
      at[i++] =
          (context * kMantissaLengths + std::min(lower, kMantissaLengths - 1)) * kMantissaStates +
          state;
    }
    const bool one = ((value >> (length - 2 - bit)) & 1U) != 0;
    result =
        (result << 1) | static_cast<std::uint64_t>(code_at(
                            stream, mantissas, static_cast<std::uint32_t>(bit), at.data(), one));
  }
  const int rest = length - 1 - modelled;
  return rest == 0 ? result : (result << rest) | stream.code_bits(value, rest);
}

std::int64_t ModelBank::code_signed(EntropyStream& stream, std::uint32_t number,
                                    std::uint32_t selector, std::span<const std::uint32_t> contexts,
                                    std::int64_t value, int max_length) {
  const std::uint64_t magnitude =
      code_number(stream, number, selector, contexts,
                  static_cast<std::uint64_t>(value < 0 ? -value : value), max_length);
  if (magnitude == 0) return 0;
  const Family& signs = families_[number_base_ + 3 * std::size_t{number} + 2];
  const bool is_negative = code_at(stream, signs, selector, contexts.data(), value < 0);
  const auto result = static_cast<std::int64_t>(magnitude);
  return is_negative ? -result : result;
}

Bytes ModelBank::save(const PriorShape& shape) const {
  ByteWriter writer;
  const auto is_kept = [&](std::size_t i) {
    return (values_[i] & 1023U) >= std::max(shape.least_count, 1U);
  };
  for (std::size_t i = 0; i < counters_;) {
    if (is_kept(i)) {
      const std::uint32_t count = values_[i] & 1023U;
      writer.u8(static_cast<std::uint8_t>(std::min({count, shape.max_count, 255U})));
      writer.u16(static_cast<std::uint16_t>(values_[i++] >> 16));
      continue;
    }
    std::size_t next = i;  // the end of a run of counters that observed too little
    while (next < counters_ && !is_kept(next)) ++next;
    writer.u8(0);
    writer.varint(next - i);
    i = next;
  }
  const auto put_weight = [&](std::int32_t weight) {
    writer.u16(static_cast<std::uint16_t>(
        static_cast<std::int16_t>(std::clamp(weight >> 4, -32768, 32767))));
  };
  for (const Family& family : families_) {
    for (std::uint32_t selector = 0; selector < family.selectors; ++selector) {
      const std::uint32_t* weight = &values_[family.first_weight + selector * (family.inputs + 1)];
      for (std::uint32_t i = 0; i <= family.inputs; ++i) {
        const std::int32_t neutral = i < family.inputs ? first_weight(family.inputs) : 0;
        put_weight(shape.has_weights ? static_cast<std::int32_t>(weight[i]) : neutral);
      }
    }
  }
  for (const std::uint32_t mixed : std::span(values_).last(rates_)) {
    writer.u8(static_cast<std::uint8_t>(shape.has_weights ? std::min(mixed, 255U) : 0));
  }
  return std::move(writer).bytes();
}

bool ModelBank::load(ByteView state) {
  std::vector<std::uint32_t> loaded(values_.size());
  ByteReader reader(state);
  std::fill_n(loaded.begin(), counters_, kUnknown);
  for (std::size_t i = 0; i < counters_;) {
    const std::uint32_t count = reader.u8();
    if (reader.failed() || count > kMaxCount) return false;
    if (count > 0) {
      loaded[i++] = (static_cast<std::uint32_t>(reader.u16()) << 16) | count;
      continue;
    }
    const std::uint64_t run = reader.varint();
    if (run == 0 || run > counters_ - i) return false;
    i += run;
  }
  for (std::uint32_t& weight : std::span(loaded).subspan(counters_, weights_)) {
    weight = static_cast<std::uint32_t>(static_cast<std::int16_t>(reader.u16()) * 16);
  }
  for (std::uint32_t& mixed : std::span(loaded).last(rates_)) mixed = reader.u8();
  if (reader.failed() || reader.remaining() != 0) return false;
  values_ = std::move(loaded);
  return true;
}

}  // namespace watertight::codec
