// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes marks: the text between two values, with brackets, keys and white space. A city model has
// few different ones, and nearly all follow from their place. Internal to columns/.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "columns/models/candidates.h"
#include "columns/models/context_mixer.h"
#include "columns/models/string_coder.h"
#include "columns/place.h"
#include "columns/value_table.h"

namespace watertight::columns {

struct Mark {
  std::string_view text;
  bool is_last = false;  // the text ends here; else a value follows
};

class MarkCoder {
 public:
  explicit MarkCoder(int slot_bits) : candidates_(slot_bits) {
    marks_.add(std::string(1, kBeforeValue));
  }
  /// Starts another text.
  void restart();
  /// Makes this copy of a coder that has not changed since equal to it again.
  void revert(const MarkCoder& original) {
    marks_.revert(original.marks_);
    candidates_.revert(original.candidates_);
    last_ = original.last_;
    before_last_ = original.before_last_;
  }
  /// Codes a mark; its text stays where it is until the next one. `last_value` stands for the value
  /// before it. The stream fails when a text that is read is longer than `most_bytes`.
  Mark code(EntropyStream& stream, ContextMixer& mixer, StringCoder& strings, const Place& place,
            Hash last_value, const Mark& mark, std::size_t most_bytes);

 private:
  // The first byte of a mark in the table.
  static constexpr char kLast = '.';
  static constexpr char kBeforeValue = ' ';

  ValueTable marks_;
  Candidates candidates_;
  std::uint32_t last_ = 0;
  std::uint32_t before_last_ = 0;
};

}  // namespace watertight::columns
