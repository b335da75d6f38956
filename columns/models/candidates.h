// SPDX-License-Identifier: GPL-3.0-or-later
//
// Remembers, for the facts before a value or mark, which one came last. Internal to columns/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "columns/models/context_mixer.h"
#include "columns/noted_array.h"

namespace watertight::columns {

/// The value that is likely after some facts.
struct Candidate {
  std::uint32_t value = 0;
  std::uint32_t trust = 0;  // how often it came, less how often it did not; 0 to 15
};

class Candidates {
 public:
  explicit Candidates(int slot_bits)
      : shift_(32 - slot_bits),
        slots_(std::size_t{1} << static_cast<unsigned>(slot_bits), Slot{}) {}

  std::optional<Candidate> find(Hash facts) const {
    const Slot& slot = slots_[facts >> static_cast<unsigned>(shift_)];
    if (!slot.is_used || slot.check != check_of(facts)) return std::nullopt;
    return Candidate{slot.value, slot.trust};
  }
  void learn(Hash facts, std::uint32_t value) {
    Slot& slot = slots_.change(facts >> static_cast<unsigned>(shift_));
    const bool is_known = slot.is_used && slot.check == check_of(facts);
    if (is_known && slot.value == value) {
      if (slot.trust < kMostTrust) ++slot.trust;
    } else if (is_known && slot.trust > 1) {
      slot.trust = static_cast<std::uint8_t>(slot.trust / 2);
    } else {
      slot = {value, check_of(facts), 0, true};
    }
  }

  /// Makes this copy of candidates that have not changed since equal to them again.
  void revert(const Candidates& original) { slots_.revert(original.slots_); }

 private:
  static constexpr std::uint8_t kMostTrust = 15;
  static std::uint16_t check_of(Hash facts) { return static_cast<std::uint16_t>(facts); }
  struct Slot {
    std::uint32_t value = 0;
    std::uint16_t check = 0;
    std::uint8_t trust = 0;
    bool is_used = false;
  };
  int shift_;
  NotedArray<Slot> slots_;
};

}  // namespace watertight::columns
