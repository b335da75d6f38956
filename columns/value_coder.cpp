// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/value_coder.h"

#include <algorithm>
#include <array>
#include <bit>

#include "columns/models/counter_text.h"
#include "columns/models/uuid.h"

namespace watertight::columns {
namespace {

constexpr std::uint32_t kMostListed = 4096;  // values that a column lists
constexpr int kKindBits = 4;
constexpr int kListedBits = 12;
constexpr int kDistanceBits = 4;
constexpr std::size_t kShortNumber = 6;
constexpr std::uint32_t kTrusts = 17;

std::uint64_t key_of(std::uint32_t column, std::uint32_t number) {
  return (std::uint64_t{column} << 32U) | number;
}

}  // namespace

void ValueCoder::restart() {
  last_ = 0;
  before_last_ = 0;
  last_number_.reset();
}

void ValueCoder::revert(const ValueCoder& original) {
  values_.revert(original.values_);
  affixes_.revert(original.affixes_);
  candidates_.revert(original.candidates_);
  column_of_.revert(original.column_of_);
  columns_ = original.columns_;
  numbers_.resize(original.numbers_.size());
  origins_.revert(original.origins_);
  uuids_.revert(original.uuids_);
  index_of_.revert(original.index_of_);
  last_ = original.last_;
  before_last_ = original.before_last_;
  last_known_ = original.last_known_;
  last_number_ = original.last_number_;
}

void ValueCoder::make_indexes() {
  for (std::uint32_t column = 0; column < columns_.size(); ++column) {
    const std::vector<std::uint32_t>& values = columns_[column].values;
    for (std::uint32_t i = 0; i < values.size(); ++i) index_of_[key_of(column, values[i])] = i;
  }
}

void ValueCoder::pass(std::optional<std::int64_t> number) {
  before_last_ = last_;
  last_ = 0;
  last_number_ = number;
}

std::uint32_t ValueCoder::column_at(const Place& place) {
  const std::uint32_t* const known = column_of_.find(place.column);
  if (known != nullptr) return *known;
  columns_.emplace_back();
  return column_of_[place.column] = static_cast<std::uint32_t>(columns_.size() - 1);
}

ValueCoder::Context ValueCoder::context_of(const Place& place, std::uint32_t number) {
  Column& column = columns_[number];
  Context context{place, number, column};
  context.facts = {hash_of(1, place.column, column.last, last_),
                   hash_of(2, place.column, last_, before_last_),
                   hash_of(3, place.column, column.last, column.before_last)};
  for (std::size_t i = 0; i < context.facts.size(); ++i) {
    auto found = candidates_.find(context.facts[i]);
    for (std::size_t j = 0; j < i && found; ++j) {
      const auto& earlier = context.candidates[j];
      if (earlier && earlier->value == found->value) found.reset();
    }
    context.candidates[i] = found;
  }
  return context;
}

ValueCoder::Kind ValueCoder::choose_kind(const Context& context, std::string_view text) const {
  const auto known = values_.find(text);
  if (known) {
    for (std::size_t i = 0; i < context.candidates.size(); ++i) {
      const auto& candidate = context.candidates[i];
      if (candidate && candidate->value == *known) return static_cast<Kind>(i);
    }
    if (index_of_.find(key_of(context.number, *known)) != nullptr) return Kind::listed;
  }
  const auto number = choose_form(text, context.column.numbers.form());
  if (known && !(number && text.size() < kShortNumber)) return Kind::known;
  if (number) return Kind::number;
  if (counted_from(values_.text(context.column.last), text)) return Kind::counter;
  const auto uuid = find_uuid(text);
  if (!uuid) return Kind::string;
  const bool is_alike = resembles(*uuid, find_uuid(values_.text(context.column.last)));
  return uuids_.knows(*uuid) || !is_alike ? Kind::uuid : Kind::string;
}

ValueCoder::Kind ValueCoder::code_kind(EntropyStream& stream, ContextMixer& mixer,
                                       const Context& context, Kind kind) {
  const Column& column = context.column;
  const auto last = static_cast<Hash>(column.last_kind);
  Hash trust = 0;
  Hash present = last;
  for (const auto& candidate : context.candidates) {
    trust = trust * kTrusts + (candidate ? candidate->trust + 1 : 0);
    present = present * 2 + (candidate ? 1 : 0);
  }
  const Hash place = context.place.column;
  if (mixer.flag(stream, Question::is_same_kind,
                 {hash_of(place, last, column.news), hash_of(place, trust), hash_of(present, trust),
                  hash_of(place, present)},
                 kind == column.last_kind)) {
    return column.last_kind;
  }
  const std::uint32_t coded =
      mixer.symbol(stream, Question::kind,
                   {hash_of(place, last), hash_of(place, trust), hash_of(present, trust)},
                   kKindBits, static_cast<std::uint32_t>(kind));
  if (coded <= static_cast<std::uint32_t>(Kind::counter)) return static_cast<Kind>(coded);
  stream.fail();
  return Kind::string;
}

std::uint32_t ValueCoder::code_listed(EntropyStream& stream, ContextMixer& mixer,
                                      const Context& context, std::string_view text) {
  const Hash column = context.place.column;
  std::uint64_t index = 0;
  if (!stream.is_reading()) {
    index = *index_of_.find(key_of(context.number, values_.find(text).value_or(0)));
  }
  index = mixer.number(stream, Question::list_index,
                       {column, hash_of(column, context.column.last), hash_of(column, last_, 1)},
                       index, kListedBits);
  if (index < context.column.values.size()) return context.column.values[index];
  stream.fail();
  return 0;
}

/// The value that came first after this one in the column where both came first.
std::optional<std::uint32_t> ValueCoder::next_known(std::uint32_t value) const {
  const Origin& origin = origins_[value];
  if (origin.index == kNotListed) return std::nullopt;
  const std::vector<std::uint32_t>& values = columns_[origin.column].values;
  if (origin.index + 1 >= values.size()) return std::nullopt;
  return values[origin.index + 1];
}

std::uint32_t ValueCoder::code_known(EntropyStream& stream, ContextMixer& mixer,
                                     const Context& context, std::string_view text) {
  Column& column = context.column;
  const Hash place = context.place.column;
  const Hash last = hash_of(place, column.last_distance);
  const std::uint32_t value = stream.is_reading() ? 0 : values_.find(text).value_or(0);
  const auto next = next_known(last_known_);
  if (next && mixer.flag(stream, Question::is_next_known, {place, last}, value == *next)) {
    column.last_distance = 0;
    last_known_ = *next;
    return last_known_;
  }
  const std::uint32_t newest = values_.size() - 1;
  const std::uint64_t distance =
      mixer.number(stream, Question::known_distance, {place, last}, newest - value, kDistanceBits);
  column.last_distance = static_cast<std::uint32_t>(std::bit_width(distance));
  if (distance > newest) {
    stream.fail();
    return 0;
  }
  last_known_ = newest - static_cast<std::uint32_t>(distance);
  return last_known_;
}

std::uint32_t ValueCoder::code_number(EntropyStream& stream, ContextMixer& mixer,
                                      const Context& context, std::string_view text) {
  NumberColumn& numbers = context.column.numbers;
  FormedNumber chosen;
  if (!stream.is_reading()) chosen = choose_form(text, numbers.form()).value_or(FormedNumber{});
  const Hash column = context.place.column;
  const auto coded_form = numbers.code_form(stream, mixer, column, chosen.form);
  if (!coded_form) stream.fail();
  const NumberForm form = coded_form.value_or(NumberForm{});
  const auto neighbour =
      context.place.is_in_array && form.is_decimal() ? last_number_ : std::nullopt;
  const std::int64_t number =
      numbers.code_number(stream, mixer, column, last_, neighbour, chosen.number);
  const std::string printed = print(form, number);
  if (printed.empty()) {
    stream.fail();
    return 0;
  }
  return add(printed, FormedNumber{form, number});
}

std::uint32_t ValueCoder::code_uuid(EntropyStream& stream, ContextMixer& mixer,
                                    StringCoder& strings, const Context& context,
                                    std::string_view text) {
  const Hash column = context.place.column;
  const Uuid uuid = find_uuid(text).value_or(Uuid{});
  const std::string around = affixes_of(uuid, text);
  std::optional<std::uint32_t> known;
  if (!stream.is_reading()) known = affixes_.find(around);
  std::uint32_t number = context.column.affixes;
  const bool has_last = number < affixes_.size();
  if (!has_last ||
      !mixer.flag(stream, Question::has_same_affixes, {column}, known && *known == number)) {
    number =
        affixes_.add(strings.code(stream, mixer, hash_of(column, 1), around, context.most_bytes));
  }
  context.column.affixes = number;
  auto coded = with_uuid(affixes_.text(number), uuids_.code(stream, mixer, column, uuid));
  if (!coded) {
    stream.fail();
    return 0;
  }
  return add(*std::move(coded));
}

std::uint32_t ValueCoder::code_counter(EntropyStream& stream, ContextMixer& mixer,
                                       const Context& context, std::string_view text) {
  constexpr int kModelledBits = 4;
  constexpr std::uint32_t kMostSize = 15;
  Column& column = context.column;
  const Hash place = context.place.column;
  const std::string_view last = values_.text(column.last);
  const std::int64_t step = stream.is_reading() ? 0 : counted_from(last, text).value_or(0);
  const Hash known = hash_of(place, column.last_step);
  const bool is_negative =
      mixer.flag(stream, Question::counter_sign, {place, known, column.last_step}, step < 0);
  const std::uint64_t size =
      mixer.number(stream, Question::counter_step,
                   {hash_of(place, is_negative ? 1 : 0), hash_of(known, is_negative ? 1 : 0),
                    hash_of(column.last_step, is_negative ? 1 : 0)},
                   magnitude(step), kModelledBits);
  column.last_step = static_cast<std::uint32_t>(std::min<std::uint64_t>(size, kMostSize)) * 2 +
                     (is_negative ? 1 : 0);
  const auto counter = find_counter(last);
  const bool is_step = size <= static_cast<std::uint64_t>(kLargestStep);
  const auto steps = is_step ? static_cast<std::int64_t>(size) : 0;
  const std::int64_t number = counter ? counter->number + (is_negative ? -steps : steps) : -1;
  if (number < 0 || !is_step) {
    stream.fail();
    return 0;
  }
  return add(with_number(*counter, number));
}

std::uint32_t ValueCoder::code_of_kind(EntropyStream& stream, ContextMixer& mixer,
                                       StringCoder& strings, const Context& context, Kind kind,
                                       std::string_view text) {
  switch (kind) {
    case Kind::after_both:
    case Kind::after_others:
    case Kind::after_own: {
      const auto& candidate = context.candidates[static_cast<std::size_t>(kind)];
      if (!candidate || candidate->value >= values_.size()) {
        stream.fail();
        return 0;
      }
      return candidate->value;
    }
    case Kind::listed:
      return code_listed(stream, mixer, context, text);
    case Kind::known:
      return code_known(stream, mixer, context, text);
    case Kind::number:
      return code_number(stream, mixer, context, text);
    case Kind::uuid:
      return code_uuid(stream, mixer, strings, context, text);
    case Kind::counter:
      return code_counter(stream, mixer, context, text);
    case Kind::string:
      break;
  }
  return add(strings.code(stream, mixer, context.place.column, text, context.most_bytes));
}

std::uint32_t ValueCoder::add(std::string_view text, const std::optional<FormedNumber>& number) {
  const std::uint32_t value = values_.add(text);
  if (value == numbers_.size()) {
    numbers_.push_back(number);
    origins_.push_back({});
  }
  return value;
}

void ValueCoder::learn(EntropyStream& stream, const Context& context, Kind kind,
                       std::uint32_t value) {
  Column& column = context.column;
  const bool is_new = kind > Kind::listed;
  if (is_new && column.values.size() < kMostListed) {
    if (!stream.is_reading()) {
      index_of_[key_of(context.number, value)] = static_cast<std::uint32_t>(column.values.size());
    }
    if (origins_[value].index == kNotListed) {
      origins_.change(value) = {context.number, static_cast<std::uint32_t>(column.values.size())};
    }
    column.values.push_back(value);
  }
  if (kind != Kind::number && numbers_[value]) column.numbers.see(*numbers_[value]);
  for (const Hash facts : context.facts) candidates_.learn(facts, value);
  column.last_kind = kind;
  column.news = (column.news * 2 + (is_new ? 1 : 0)) & 7U;
  column.before_last = column.last;
  column.last = value;
  before_last_ = last_;
  last_ = value;
  const auto& form = column.numbers.form();
  last_number_ = form && form->is_decimal() ? std::optional(column.numbers.last()) : std::nullopt;
}

std::string_view ValueCoder::code(EntropyStream& stream, ContextMixer& mixer, StringCoder& strings,
                                  const Place& place, std::string_view text,
                                  std::size_t most_bytes) {
  Context context = context_of(place, column_at(place));
  context.most_bytes = most_bytes;
  const Kind kind = code_kind(stream, mixer, context,
                              stream.is_reading() ? Kind::string : choose_kind(context, text));
  const std::uint32_t value = code_of_kind(stream, mixer, strings, context, kind, text);
  learn(stream, context, kind, value);
  return values_.text(value);
}

}  // namespace watertight::columns
