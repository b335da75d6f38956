// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/models/string_coder.h"

#include <algorithm>
#include <array>

namespace watertight::columns {
namespace {

constexpr std::uint32_t kLongMatch = 31;
constexpr std::size_t kFarPosition = 40;

}  // namespace

// The character of a string, or its end, which is a NUL that a decision tells from a true one.
bool StringCoder::code_character(EntropyStream& stream, ContextMixer& mixer, Hash column,
                                 std::size_t position, Match& match, unsigned char& character,
                                 bool& is_end) {
  const bool is_matched = match.length > 0 && match.at < history_.size();
  const auto likely =
      static_cast<unsigned>(is_matched ? static_cast<unsigned char>(history_[match.at]) : 0);
  const auto far = static_cast<Hash>(std::min(position, kFarPosition));
  const std::array<Hash, 6> contexts{
      hash_of(1, before_ & 0xFFU),      hash_of(2, before_ & 0xFFFFU),
      hash_of(3, before_ & 0xFF'FFFFU), hash_of(4, before_, column),
      hash_of(5, column, far),          hash_of(6, column, before_ & 0xFFU)};
  const ContextMixer::Inputs plain(Question::character, contexts);
  std::uint32_t node = 1;
  ContextMixer::Inputs group = plain;
  for (int bit = 7; bit >= 0; --bit) {
    const bool agrees = is_matched && ((likely | 256U) >> static_cast<unsigned>(bit + 1)) == node;
    const std::uint32_t expected = agrees ? 1 + ((likely >> static_cast<unsigned>(bit)) & 1U) : 0;
    if (bit % 4 == 3) group = plain.at(node);
    const Question question = agrees ? Question::character_after_match : Question::character;
    const std::size_t step =
        (agrees ? std::min<std::size_t>(match.length, 4) - 1 : 0) + (bit == 7 ? 4U : 0U);
    const bool one = mixer.decide(
        stream, question, step,
        group.with(hash_of(7, expected, agrees ? std::min(match.length, kLongMatch) : 0)),
        bit >= 4 ? node
                 : (1U << static_cast<unsigned>(3 - bit)) |
                       (node & ((1U << static_cast<unsigned>(3 - bit)) - 1)),
        ((character >> bit) & 1U) != 0);
    node = node * 2 + (one ? 1U : 0U);
  }
  character = static_cast<unsigned char>(node & 0xFFU);
  if (is_matched && likely == character) {
    ++match.length;
    ++match.at;
  } else {
    match = {};
  }
  if (character != 0) return false;
  is_end = mixer.flag(stream, Question::is_end, {column}, is_end);
  return is_end;
}

std::string StringCoder::code(EntropyStream& stream, ContextMixer& mixer, Hash column,
                              std::string_view text, std::size_t most_bytes) {
  const std::size_t* const last = last_of_column_.find(column);
  Match match = last == nullptr ? Match{} : Match{*last, 1};
  const std::size_t begin = history_.size();
  before_ = 0;
  for (std::size_t i = 0;; ++i) {
    unsigned char character = i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
    bool is_end = i >= text.size();
    const bool ends = code_character(stream, mixer, column, i, match, character, is_end);
    history_ += static_cast<char>(character);
    if (ends) break;
    is_over_limit_ = is_over_limit_ || i >= most_bytes;
    if (is_over_limit_) stream.fail();
    if (stream.failed()) break;
    before_ = (before_ << 8U) | character;
    if (i < 2) continue;
    std::size_t& after = after_three_[before_ & 0xFF'FFFFU];
    if (match.length == 0 && after > 0) match = {after, 1};
    after = history_.size();
  }
  last_of_column_[column] = begin;
  return history_.substr(begin, history_.size() - begin - 1);
}

}  // namespace watertight::columns
