// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/models/uuid.h"

#include <algorithm>

#include "base/bytes.h"

namespace watertight::columns {
namespace {

constexpr std::size_t kTextSize = 36;
constexpr char kPlaceholder = '\1';
constexpr std::size_t kVersionDigit = 12;  // the version
constexpr std::size_t kVariantDigit = 16;  // the variant, in its upper bits
constexpr int kUuidDistanceBits = 4;
constexpr int kDigitBits = 4;
constexpr std::string_view kSmall = "0123456789abcdef";
constexpr std::string_view kCapital = "0123456789ABCDEF";

bool is_dash(std::size_t position) {
  return position == 8 || position == 13 || position == 18 || position == 23;
}

std::optional<Uuid> uuid_at(std::string_view text, std::size_t at) {
  Uuid uuid;
  uuid.at = at;
  bool has_small = false;
  std::size_t next = 0;
  for (std::size_t i = 0; i < kTextSize; ++i) {
    const char c = text[at + i];
    if (is_dash(i)) {
      if (c != '-') return std::nullopt;
      continue;
    }
    if (c >= '0' && c <= '9') {
      uuid.digits[next++] = static_cast<std::uint8_t>(c - '0');
    } else if (c >= 'a' && c <= 'f') {
      has_small = true;
      uuid.digits[next++] = static_cast<std::uint8_t>(c - 'a' + 10);
    } else if (c >= 'A' && c <= 'F') {
      uuid.is_upper_case = true;
      uuid.digits[next++] = static_cast<std::uint8_t>(c - 'A' + 10);
    } else {
      return std::nullopt;
    }
  }
  if (has_small && uuid.is_upper_case) return std::nullopt;
  return uuid;
}

}  // namespace

std::optional<Uuid> find_uuid(std::string_view text) {
  if (text.size() < kTextSize || text.find(kPlaceholder) != std::string_view::npos) {
    return std::nullopt;
  }
  for (std::size_t at = 0; at + kTextSize <= text.size(); ++at) {
    if (text[at + 8] != '-' || text[at + 13] != '-') continue;
    if (auto uuid = uuid_at(text, at)) return uuid;
  }
  return std::nullopt;
}

bool resembles(const Uuid& uuid, const std::optional<Uuid>& other) {
  constexpr std::size_t kMany = 10;
  if (!other || other->at != uuid.at) return false;
  std::size_t equal = 0;
  for (std::size_t i = 0; i < uuid.digits.size(); ++i) {
    if (uuid.digits[i] == other->digits[i]) ++equal;
  }
  return equal > kMany;
}

std::string affixes_of(const Uuid& uuid, std::string_view text) {
  std::string affixes(text.substr(0, uuid.at));
  affixes += kPlaceholder;
  if (text.size() >= uuid.at + kTextSize) affixes += text.substr(uuid.at + kTextSize);
  return affixes;
}

std::optional<std::string> with_uuid(std::string_view affixes, const Uuid& uuid) {
  const std::size_t at = affixes.find(kPlaceholder);
  if (at == std::string_view::npos) return std::nullopt;
  std::string text(affixes.substr(0, at));
  const std::string_view letters = uuid.is_upper_case ? kCapital : kSmall;
  std::size_t next = 0;
  for (std::size_t i = 0; i < kTextSize; ++i) {
    text += is_dash(i) ? '-' : letters[uuid.digits[next++]];
  }
  text += affixes.substr(at + 1);
  return text;
}

UuidCoder::Digits UuidCoder::code_digits(EntropyStream& stream, ContextMixer& mixer, Hash column,
                                         const Digits& digits) {
  Digits coded{};
  const auto code_random = [&](std::size_t begin, std::size_t end) {
    std::uint64_t value = 0;
    for (std::size_t i = begin; i < end; ++i) value = value << kDigitBits | digits[i];
    value = stream.code_plain_bits(value, static_cast<int>(end - begin) * kDigitBits);
    for (std::size_t i = end; i-- > begin; value >>= kDigitBits) coded[i] = value & 15U;
  };
  const auto code_predictable = [&](std::size_t i) {
    const auto place = static_cast<Hash>(i);
    coded[i] = static_cast<std::uint8_t>(mixer.symbol(
        stream, Question::uuid_version, {hash_of(column, place), place}, kDigitBits, digits[i]));
  };
  code_random(0, kVersionDigit);
  code_predictable(kVersionDigit);
  code_random(kVersionDigit + 1, kVariantDigit);
  code_predictable(kVariantDigit);
  code_random(kVariantDigit + 1, coded.size());
  return coded;
}

std::optional<std::uint32_t> UuidCoder::number_of(const Uuid& uuid) const {
  return known_.find(as_text(ByteView(uuid.digits)));
}

/// Codes whether a UUID is the last one, the one after it, or an earlier one; none for a new one.
std::optional<std::uint32_t> UuidCoder::code_known(EntropyStream& stream, ContextMixer& mixer,
                                                   Hash column,
                                                   std::optional<std::uint32_t> known) {
  if (known_.size() == 0) return std::nullopt;
  if (mixer.flag(stream, Question::is_last_uuid, {column}, known == last_)) return last_;
  if (!mixer.flag(stream, Question::is_known_uuid, {column}, known.has_value())) {
    return std::nullopt;
  }
  const bool has_next = last_ + 1 < known_.size();
  if (has_next && mixer.flag(stream, Question::is_next_uuid, {column}, known == last_ + 1)) {
    return last_ + 1;
  }
  const std::uint32_t newest = known_.size() - 1;
  const std::uint64_t distance = mixer.number(stream, Question::uuid_distance, {column},
                                              newest - known.value_or(newest), kUuidDistanceBits);
  if (distance > newest) {
    stream.fail();
    return 0;
  }
  return newest - static_cast<std::uint32_t>(distance);
}

Uuid UuidCoder::code(EntropyStream& stream, ContextMixer& mixer, Hash column, const Uuid& uuid) {
  Uuid coded;
  const auto known =
      code_known(stream, mixer, column, stream.is_reading() ? std::nullopt : number_of(uuid));
  if (known) {
    last_ = *known;
    std::ranges::copy(known_.text(last_), coded.digits.begin());
  } else {
    coded.digits = code_digits(stream, mixer, column, uuid.digits);
    if (knows(coded)) stream.fail();  // a new one that is known
    last_ = known_.add(as_text(ByteView(coded.digits)));
  }
  coded.is_upper_case = mixer.flag(stream, Question::is_upper_case, {column}, uuid.is_upper_case);
  return coded;
}

}  // namespace watertight::columns
