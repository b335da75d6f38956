// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/models/string_coder.h"

#include <algorithm>
#include <array>

namespace watertight::columns {
namespace {

constexpr std::uint32_t kLongMatch = 31;
constexpr std::size_t kFarPosition = 40;
constexpr std::uint32_t kCopied = 8;  // a match of this length goes on as a copy
constexpr std::size_t kMostCopied = 4096;
constexpr int kCopyLengthBits = 4;
constexpr Hash kTag = 0x5354'5200;  // tells contexts of characters from those of other questions

}  // namespace

// The character of a string, or its end, which is a NUL that a decision tells from a true one.
bool StringCoder::code_character(EntropyStream& stream, ContextMixer& mixer, Hash column,
                                 std::size_t position, Match& match, unsigned char& character,
                                 bool& is_end) {
  const bool is_matched = match.length > 0 && match.at < history_.size();
  const auto likely =
      static_cast<unsigned>(is_matched ? static_cast<unsigned char>(history_[match.at]) : 0);
  const auto far = static_cast<Hash>(std::min(position, kFarPosition));
  const Hash place = hash_of(column, kTag);
  const std::array<Hash, 6> contexts{hash_of(kTag + 1, before_ & 0xFFU),
                                     hash_of(kTag + 2, before_ & 0xFFFFU),
                                     hash_of(kTag + 3, before_ & 0xFF'FFFFU),
                                     hash_of(place, before_),
                                     hash_of(place + 1, far),
                                     hash_of(place + 2, before_ & 0xFFU)};
  const Hash length = is_matched ? std::min(match.length, kLongMatch) : 0;
  std::uint32_t node = 1;
  std::array<std::uint32_t*, contexts.size()> groups{};
  for (int bit = 7; bit >= 0; --bit) {
    const bool agrees = is_matched && ((likely | 256U) >> static_cast<unsigned>(bit + 1)) == node;
    const std::uint32_t expected = agrees ? 1 + ((likely >> static_cast<unsigned>(bit)) & 1U) : 0;
    if (bit % ContextMixer::kGroupBits == ContextMixer::kGroupBits - 1) {
      for (std::size_t i = 0; i < groups.size(); ++i) {
        groups[i] = mixer.group(hash_of(contexts[i], node));
      }
    }
    const std::uint32_t known = static_cast<std::uint32_t>(bit % ContextMixer::kGroupBits);
    const std::uint32_t before = ContextMixer::kGroupBits - 1 - known;
    const std::uint32_t in_group = (1U << before) | (node & ((1U << before) - 1));
    ContextMixer::Counters<contexts.size() + 1> counters{};
    for (std::size_t i = 0; i < groups.size(); ++i) counters[i] = groups[i] + in_group;
    counters.back() = mixer.counter(hash_of(kTag + 4, agrees ? expected * 64 + length : 0));
    const Question question = agrees ? Question::character_after_match : Question::character;
    const std::size_t step =
        (agrees ? std::min<std::size_t>(match.length, 4) - 1 : 0) + (bit == 7 ? 4U : 0U);
    const bool one = mixer.decide(stream, question, step, counters, ((character >> bit) & 1U) != 0);
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

std::size_t StringCoder::copy(EntropyStream& stream, ContextMixer& mixer, Hash column, Match& match,
                              std::string_view rest, std::size_t most_bytes) {
  std::size_t size = 0;
  const std::size_t at = match.at;
  const std::size_t known = history_.size() - at;
  // Beyond what is known, a copy repeats itself.
  const auto copied = [&](std::size_t i) { return history_[at + i % known]; };
  if (!stream.is_reading()) {
    const std::size_t most = std::min(rest.size(), kMostCopied);
    while (size < most && copied(size) != 0 && copied(size) == rest[size]) ++size;
  }
  size = mixer.number(stream, Question::copy_length, {column, 0}, size, kCopyLengthBits);
  if (size > kMostCopied) stream.fail();
  if (size > most_bytes) is_over_limit_ = true;
  if (is_over_limit_) stream.fail();
  if (stream.failed()) {
    match = {};
    return 0;
  }
  for (std::size_t i = 0; i < size; ++i) take(static_cast<unsigned char>(history_[at + i]));
  match = {at + size, kCopied};
  if (size == kMostCopied) return size;
  const bool may_end = match.at < history_.size() && history_[match.at] == 0;
  match = may_end ? Match{match.at, kLongMatch} : Match{};
  return size;
}

std::string_view StringCoder::code(EntropyStream& stream, ContextMixer& mixer, Hash column,
                                   std::string_view text, std::size_t most_bytes) {
  const std::size_t* const last = last_of_column_.find(column);
  Match match = last == nullptr ? Match{} : Match{*last, 1};
  const std::size_t begin = history_.size();
  before_ = 0;
  for (std::size_t i = 0;; ++i) {
    while (match.length == kCopied && match.at < history_.size() && !stream.failed()) {
      const std::string_view rest = text.substr(std::min(i, text.size()));
      i += copy(stream, mixer, column, match, rest, most_bytes - i);
    }
    unsigned char character = i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
    bool is_end = i >= text.size();
    const bool ends = code_character(stream, mixer, column, i, match, character, is_end);
    if (ends || stream.failed()) {
      history_ += '\0';
      break;
    }
    is_over_limit_ = is_over_limit_ || i >= most_bytes;
    if (is_over_limit_) {
      stream.fail();
      break;
    }
    take(character);
    if (i < 2) continue;
    std::size_t& after = after_three_[before_ & 0xFF'FFFFU];
    if (match.length == 0 && after > 0) match = {after, 1};
    after = history_.size();
  }
  last_of_column_[column] = begin;
  return std::string_view(history_).substr(begin, history_.size() - begin - 1);
}

}  // namespace watertight::columns
