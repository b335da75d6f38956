// SPDX-License-Identifier: GPL-3.0-or-later
//
// The different texts of a list, numbered in order of their first appearance. Internal to columns/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "columns/keyed_hash.h"
#include "columns/noted_array.h"

namespace watertight::columns {

/// All texts lie in one string, so that a copy is one of plain bytes.
class ValueTable {
 public:
  std::optional<std::uint32_t> find(std::string_view text) const {
    if (slots_.empty()) return std::nullopt;
    const std::uint32_t slot = slots_[slot_of(text, static_cast<std::uint32_t>(keyed_hash(text)))];
    return slot == 0 ? std::nullopt : std::optional(slot - 1);
  }
  /// The number of a text, which is added if it is new.
  std::uint32_t add(std::string_view text) {
    if (2 * entries_.size() >= slots_.size()) grow();
    const std::uint32_t hash = static_cast<std::uint32_t>(keyed_hash(text));
    std::uint32_t& slot = slots_.change(slot_of(text, hash));
    if (slot == 0) {
      entries_.push_back({characters_.size(), text.size(), hash});
      characters_ += text;
      slot = size();
    }
    return slot - 1;
  }
  /// Stays where it is until a text is added.
  std::string_view text(std::uint32_t number) const {
    const Entry& entry = entries_[number];
    return std::string_view(characters_).substr(entry.begin, entry.size);
  }
  /// Makes this copy of a table that has not changed since equal to it again.
  void revert(const ValueTable& original) {
    characters_.resize(original.characters_.size());
    entries_.resize(original.entries_.size());
    slots_.revert(original.slots_);
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }

 private:
  struct Entry {
    std::size_t begin = 0;
    std::size_t size = 0;
    std::uint32_t hash = 0;
  };
  static constexpr std::size_t kFirstSlots = 64;

  /// The slot of a text, or the one that it would take.
  std::size_t slot_of(std::string_view wanted, std::uint32_t hash) const {
    std::size_t at = hash & (slots_.size() - 1);
    for (; slots_[at] != 0; at = (at + 1) & (slots_.size() - 1)) {
      const std::uint32_t number = slots_[at] - 1;
      if (entries_[number].hash == hash && text(number) == wanted) break;
    }
    return at;
  }
  void grow() {
    slots_.replace(std::vector<std::uint32_t>(slots_.empty() ? kFirstSlots : 2 * slots_.size(), 0));
    for (std::uint32_t number = 0; number < size(); ++number) {
      std::size_t at = entries_[number].hash & (slots_.size() - 1);
      while (slots_[at] != 0) at = (at + 1) & (slots_.size() - 1);
      slots_.change(at) = number + 1;
    }
  }

  std::string characters_;
  std::vector<Entry> entries_;
  NotedArray<std::uint32_t> slots_;  // 0, or the number of a text and 1; a power of two of them
};

}  // namespace watertight::columns
