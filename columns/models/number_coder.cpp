// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/models/number_coder.h"

#include <algorithm>
#include <bit>

namespace watertight::columns {
namespace {

constexpr int kResidualBits = 3;
constexpr NumberForm::Kind kNoNumber = NumberForm::Kind::count;
constexpr int kNumberMemory = 3;  // a length of a residual counts for 1/8 in the usual length

}  // namespace

std::int64_t difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

std::int64_t sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

std::uint64_t magnitude(std::int64_t number) {
  const auto bits = static_cast<std::uint64_t>(number);
  return number < 0 ? 0 - bits : bits;
}

std::optional<NumberForm> NumberColumn::code_form(EntropyStream& stream, ContextMixer& mixer,
                                                  Hash column,
                                                  const std::optional<NumberForm>& form) {
  const Hash known =
      form_ ? hash_of(static_cast<Hash>(form_->kind) + 1, static_cast<Hash>(form_->decimals)) : 0;
  if (form_ && mixer.flag(stream, Question::is_same_form, {column, known}, form == form_)) {
    return *form_;
  }
  NumberForm coded;
  const std::uint32_t kind =
      mixer.symbol(stream, Question::form, {column, known}, 4,
                   static_cast<std::uint32_t>(form ? form->kind : kNoNumber));
  coded.kind = static_cast<NumberForm::Kind>(kind);
  if (coded.kind == kNoNumber) return std::nullopt;
  coded.decimals =
      static_cast<int>(mixer.symbol(stream, Question::decimals, {hash_of(kind, 1), column}, 5,
                                    static_cast<std::uint32_t>(form ? form->decimals : 0)));
  if (kind >= static_cast<std::uint32_t>(NumberForm::Kind::count) ||
      coded.decimals > kMostDecimals) {
    stream.fail();
    return {};
  }
  if (form_ && form_->is_decimal() && coded.is_decimal()) {
    for (std::int64_t* number : {&last_, &before_last_, &largest_}) {
      *number = with_decimals(*number, form_->decimals, coded.decimals);
    }
  }
  form_ = coded;
  return coded;
}

std::array<std::int64_t, NumberColumn::kPredictions> NumberColumn::predictions(
    std::optional<std::int64_t> neighbour) const {
  return {0,
          last_,
          sum(last_, difference(last_, before_last_)),
          neighbour.value_or(last_),
          sum(largest_, 1),
          before_last_};
}

std::int64_t NumberColumn::code_number(EntropyStream& stream, ContextMixer& mixer, Hash column,
                                       Hash sibling, std::optional<std::int64_t> neighbour,
                                       std::int64_t number) {
  const auto predicted = predictions(neighbour);
  const std::size_t best = best_of(misses_);
  const auto which = static_cast<Hash>(best);
  const std::int64_t residual = difference(number, predicted[best]);
  const std::uint64_t size =
      mixer.number(stream, Question::residual,
                   {hash_of(column, which), hash_of(column, last_residual_, which),
                    hash_of(static_cast<Hash>(form_ ? form_->kind : NumberForm::Kind::count), which,
                            last_residual_),
                    hash_of(column, sibling)},
                   magnitude(residual), kResidualBits);
  const auto length = static_cast<std::uint32_t>(std::bit_width(size));
  bool is_negative = false;
  if (size > 0) {
    is_negative =
        mixer.flag(stream, Question::residual_sign,
                   {hash_of(column, which, last_residual_), hash_of(column, length)}, residual < 0);
  }
  const auto bits = static_cast<std::int64_t>(is_negative ? 0 - size : size);
  const std::int64_t coded = sum(predicted[best], bits);
  judge(misses_, predicted, coded, kNumberMemory);
  last_residual_ = length * 2 + (is_negative ? 1 : 0);
  take(coded);
  return coded;
}

void NumberColumn::take(std::int64_t number) {
  before_last_ = last_;
  last_ = number;
  largest_ = std::max(largest_, number);
}

void NumberColumn::see(const FormedNumber& number) {
  if (!form_ || form_->is_decimal() != number.form.is_decimal()) return;
  take(form_->is_decimal() ? with_decimals(number.number, number.form.decimals, form_->decimals)
                           : number.number);
}

}  // namespace watertight::columns
