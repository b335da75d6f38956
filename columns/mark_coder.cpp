// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/mark_coder.h"

#include <algorithm>
#include <array>

namespace watertight::columns {
namespace {

constexpr Hash kMarkColumn = 0x4D41524B;
constexpr std::uint32_t kLongArray = 40;
constexpr int kIndexBits = 14;
constexpr Hash kMarkTrusts = 17;
constexpr std::array<Question, 3> kQuestions{Question::mark_first, Question::mark_second,
                                             Question::mark_third};

}  // namespace

void MarkCoder::restart() {
  last_ = 0;
  before_last_ = 0;
}

Mark MarkCoder::code(EntropyStream& stream, ContextMixer& mixer, StringCoder& strings,
                     const Place& place, Hash last_value, const Mark& mark,
                     std::size_t most_bytes) {
  std::string whole;
  std::optional<std::uint32_t> known;
  if (!stream.is_reading()) {
    whole += mark.is_last ? kLast : kBeforeValue;
    whole += mark.text;
    known = marks_.find(whole);
  }
  // In an array its length tells most, in an object the key and the value.
  const Hash first = place.is_in_array ? hash_of(place.index + 1 == place.last_length ? 1 : 0,
                                                 std::min(place.index, kLongArray))
                                       : hash_of(last_value, place.key);
  const Hash second = place.is_in_array ? last_value : place.key;
  const std::array<Hash, 3> facts{hash_of(11, place.path, last_, first),
                                  hash_of(12, place.path, last_, second),
                                  hash_of(13, place.path, last_, before_last_)};
  std::array<std::optional<Candidate>, 3> candidates;
  Hash trust = 0;
  for (std::size_t i = 0; i < facts.size(); ++i) {
    candidates[i] = candidates_.find(facts[i]);
    trust = trust * kMarkTrusts + (candidates[i] ? candidates[i]->trust + 1 : 0);
  }
  std::optional<std::uint32_t> coded;
  for (std::size_t i = 0; i < facts.size() && !coded; ++i) {
    const auto& candidate = candidates[i];
    if (!candidate) continue;
    const bool was_denied =
        std::any_of(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const auto& other) { return other && other->value == candidate->value; });
    if (was_denied) continue;
    const auto which = static_cast<Hash>(i);
    if (mixer.flag(stream, kQuestions[i],
                   {facts[i], hash_of(trust, which), hash_of(place.path, last_, which),
                    hash_of(place.path, candidate->value, which)},
                   known && *known == candidate->value)) {
      coded = candidate->value;
    }
  }
  if (!coded) {
    if (mixer.flag(stream, Question::is_new_mark, {place.path, hash_of(place.path, last_)},
                   !known)) {
      // A mark as it is kept has a byte more than its text.
      const std::size_t most = std::max(most_bytes, most_bytes + 1);
      coded = marks_.add(strings.code(stream, mixer, kMarkColumn, whole, most));
    } else {
      coded = static_cast<std::uint32_t>(std::min<std::uint64_t>(
          mixer.number(stream, Question::mark_index, {place.path, hash_of(place.path, last_)},
                       known.value_or(0), kIndexBits),
          marks_.size()));
    }
  }
  if (*coded >= marks_.size() || marks_.text(*coded).empty()) {
    stream.fail();
    return {{}, true};
  }
  for (const Hash fact : facts) candidates_.learn(fact, *coded);
  before_last_ = last_;
  last_ = *coded;
  const std::string_view text = marks_.text(*coded);
  return {text.substr(1), text[0] == kLast};
}

}  // namespace watertight::columns
