// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/entropy/model_bank.h"

#include <algorithm>
#include <bit>

#include "base/assert.h"

namespace watertight::codec {
namespace {

// In the logistic domain an integer x from -2047 to 2047 stands for the probability p with
// ln(p / (1 - p)) = x / 256.
constexpr std::int32_t kDomain = 2047;
constexpr std::uint32_t kLeastProbability = 32;  // the least probability of an answer, in 1/65536

/// round(65536 / (1 + exp((32 - i) / 4))) for i = 0 to 64: part of the format.
constexpr std::array<std::int32_t, 65> kSquash{
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
constexpr auto kStretch = [] {
  std::array<std::int16_t, 4096> table{};
  std::int32_t x = -kDomain;
  for (std::int32_t i = 0; i < 4096; ++i) {
    while (x < kDomain && squash(x) < 16 * i + 8) ++x;
    table[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(x);
  }
  return table;
}();

// A counter has 22 bits for its probability, and below them 10 bits for the number of observations.
constexpr std::uint32_t kMaxCount = 250;
constexpr std::uint32_t kUnknown = (1U << 21) << 10;  // probability one half, nothing observed

/// The share, in 1/65536, by which a counter that observed n decisions moves towards the next
/// answer: 65536 / (n + 1.5).
constexpr auto kRates = [] {
  std::array<std::int32_t, kMaxCount + 1> rates{};
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(rates.size()); ++n) {
    rates[static_cast<std::size_t>(n)] = 131072 / (2 * n + 3);
  }
  return rates;
}();

/// The weight, in 1/256, of a counter that observed n decisions: n / (n + 0.4).
constexpr auto kConfidence = [] {
  std::array<std::int32_t, kMaxCount + 1> table{};
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(table.size()); ++n) {
    table[static_cast<std::size_t>(n)] = 2560 * n / (10 * n + 4);
  }
  return table;
}();

std::uint32_t learned(std::uint32_t counter, bool value) {
  const std::uint32_t count = counter & 1023U;
  const auto probability = static_cast<std::int64_t>(counter >> 10);
  const std::int64_t target = value ? (1 << 22) - 1 : 0;
  const std::int64_t next = probability + (((target - probability) * kRates[count]) >> 16);
  return (static_cast<std::uint32_t>(next) << 10) | std::min(count + 1, kMaxCount);
}

std::int32_t input_of(std::uint32_t counter) {
  return (kStretch[counter >> 20] * kConfidence[counter & 1023U]) >> 8;
}

// Weights are fixed-point numbers, 16.16. The weight of a constant input follows those of the
// inputs.
constexpr std::int32_t kBiasInput = 64;
constexpr std::int64_t kWeightLimit = 8 << 16;
constexpr std::uint32_t kMaxMixed = 1000;

/// The learning rate, in 1/4096, of a set of weights after `mixed` decisions.
std::int64_t mixing_rate(std::uint32_t mixed) { return 10 + 1600 / (16 + mixed); }

// A number has three families: its length in unary, the bits after the first, the sign.
constexpr std::uint32_t kLengths = 48;  // greater lengths share the last context
constexpr std::uint32_t kMantissaStates =
    7;  // the modelled bits so far: none (1 state), one (2) or two (4)
constexpr std::uint32_t kMantissaLengths = 16;
constexpr int kModelledBits = 3;

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
  return static_cast<std::int32_t>(is_agile_ ? (1U << 16) / inputs : (4U << 16) / (3U + inputs));
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

ModelBank::Mix ModelBank::mix(const Family& family, std::uint32_t selector,
                              const std::uint32_t* contexts) const {
  Mix result;
  const std::uint32_t* values = values_.data();
  const std::uint32_t* weight = values + family.first_weight + selector * (family.inputs + 1);
  const auto weighted = [](std::uint32_t weight_bits, std::int32_t input) {
    return std::int64_t{static_cast<std::int32_t>(weight_bits)} * input;
  };
  std::int64_t sum = 0;
  for (std::uint32_t i = 0; i < family.inputs; ++i) {
    WATERTIGHT_ASSERT(contexts[i] < family.sizes[i]);
    result.counter[i] = family.first_counter[i] + contexts[i];
    result.input[i] = input_of(values[result.counter[i]]);
    sum += weighted(weight[i], result.input[i]);
  }
  result.input[family.inputs] = kBiasInput;
  sum += weighted(weight[family.inputs], kBiasInput);

  const auto x = static_cast<std::int32_t>(std::clamp<std::int64_t>(sum >> 16, -kDomain, kDomain));
  result.ones = std::clamp(static_cast<std::uint32_t>(squash(x)), kLeastProbability,
                           65536 - kLeastProbability);
  return result;
}

bool ModelBank::code_at(EntropyStream& stream, const Family& family, std::uint32_t selector,
                        const std::uint32_t* contexts, bool value) {
  const Mix mixed = mix(family, selector, contexts);
  if (trials_ > 0) note_changes(family, selector, mixed);
  const bool bit = stream.code(value, mixed.ones);

  std::uint32_t* values = values_.data();
  std::uint32_t& seen = values[family.first_rate + selector];
  std::uint32_t* weight = values + family.first_weight + selector * (family.inputs + 1);
  const std::int64_t step = ((bit ? 65536 : 0) - static_cast<std::int64_t>(mixed.ones)) *
                            mixing_rate(seen) * (is_agile_ ? 2 : 1);
  for (std::uint32_t i = 0; i <= family.inputs; ++i) {
    const std::int64_t moved =
        static_cast<std::int32_t>(weight[i]) + ((step * mixed.input[i]) >> 20);
    weight[i] = static_cast<std::uint32_t>(std::clamp(moved, -kWeightLimit, kWeightLimit));
  }
  seen = std::min(seen + 1, kMaxMixed);
  for (std::uint32_t i = 0; i < family.inputs; ++i) {
    std::uint32_t& counter = values[mixed.counter[i]];
    counter = learned(counter, bit);
  }
  return bit;
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
  return mix(families_[family], selector, contexts.data()).ones;
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
