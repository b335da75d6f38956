// SPDX-License-Identifier: GPL-3.0-or-later
//
// UUIDs (RFC 9562) within strings: 32 hexadecimal digits in groups of 8, 4, 4, 4 and 12, which most
// programs draw at random. Internal to columns/.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "columns/models/context_mixer.h"
#include "columns/value_table.h"

namespace watertight::columns {

struct Uuid {
  std::size_t at = 0;  // where it begins in its string
  std::array<std::uint8_t, 32> digits{};
  bool is_upper_case = false;
};

/// The first UUID in a string whose letters are all small or all capital.
std::optional<Uuid> find_uuid(std::string_view text);
/// Whether two UUIDs begin at one position and have many digits in common, as those that are made
/// of a time have.
bool resembles(const Uuid& uuid, const std::optional<Uuid>& other);
/// The string with a byte of 1 in place of the UUID.
std::string affixes_of(const Uuid& uuid, std::string_view text);
/// The string with the UUID back in its place; none when no byte is 1.
std::optional<std::string> with_uuid(std::string_view affixes, const Uuid& uuid);
/// Codes UUIDs. Ids that belong together often have one UUID and different ends.
class UuidCoder {
 public:
  /// Codes the digits of a UUID and the case of its letters.
  Uuid code(EntropyStream& stream, ContextMixer& mixer, Hash column, const Uuid& uuid);

  /// Makes this copy of a coder that has not changed since equal to it again.
  void revert(const UuidCoder& original) {
    known_.revert(original.known_);
    last_ = original.last_;
  }

  /// Whether a UUID was coded before.
  bool knows(const Uuid& uuid) const { return number_of(uuid).has_value(); }

 private:
  using Digits = std::array<std::uint8_t, 32>;
  std::optional<std::uint32_t> number_of(const Uuid& uuid) const;
  std::optional<std::uint32_t> code_known(EntropyStream& stream, ContextMixer& mixer, Hash column,
                                          std::optional<std::uint32_t> known);
  static Digits code_digits(EntropyStream& stream, ContextMixer& mixer, Hash column,
                            const Digits& digits);

  ValueTable known_;        // their digits, a byte each
  std::uint32_t last_ = 0;  // the number of the last UUID
};

}  // namespace watertight::columns
