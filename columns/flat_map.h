// SPDX-License-Identifier: GPL-3.0-or-later
//
// A map in one array: a search reads one or two neighbouring slots, a copy is one of plain bytes.
// Internal to columns/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "columns/keyed_hash.h"
#include "columns/noted_array.h"

namespace watertight::columns {

/// Open addressing with linear probing. Keys are whole numbers of at most 64 bits; nothing is ever
/// removed. Pointers and references to values are valid until a key is added.
template <class Key, class Value>
class FlatMap {
 public:
  const Value* find(Key key) const {
    if (slots_.empty()) return nullptr;
    const Slot& slot = slots_[slot_of(key)];
    return slot.is_used ? &slot.value : nullptr;
  }
  Value& operator[](Key key) {
    if (2 * size_ >= slots_.size()) grow();
    Slot& slot = slots_.change(slot_of(key));
    if (!slot.is_used) {
      slot = {key, true, Value{}};
      ++size_;
    }
    return slot.value;
  }
  std::size_t size() const { return size_; }
  void clear() {
    slots_.replace({});
    size_ = 0;
  }
  /// Makes this copy of a map that has not changed since equal to it again.
  void revert(const FlatMap& original) {
    slots_.revert(original.slots_);
    size_ = original.size_;
  }

 private:
  struct Slot {
    Key key{};
    bool is_used = false;
    Value value{};
  };
  static constexpr std::size_t kFirstSlots = 16;

  /// The slot of a key, or the one that it would take.
  std::size_t slot_of(Key key) const {
    std::size_t at = keyed_hash(static_cast<std::uint64_t>(key)) & (slots_.size() - 1);
    while (slots_[at].is_used && slots_[at].key != key) at = (at + 1) & (slots_.size() - 1);
    return at;
  }
  void grow() {
    std::vector<Slot> old =
        slots_.replace(std::vector<Slot>(slots_.empty() ? kFirstSlots : 2 * slots_.size()));
    for (Slot& slot : old) {
      if (slot.is_used) slots_.change(slot_of(slot.key)) = std::move(slot);
    }
  }

  NotedArray<Slot> slots_;  // a power of two of them
  std::size_t size_ = 0;
};

}  // namespace watertight::columns
