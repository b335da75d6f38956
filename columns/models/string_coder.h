// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes strings character by character, each predicted from the characters before it, from its
// column, and from an earlier string that begins or goes on alike. Internal to columns/.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "columns/flat_map.h"
#include "columns/models/context_mixer.h"

namespace watertight::columns {

class StringCoder {
 public:
  /// Codes a string of a column; returns its text, which stays where it is until the next string.
  /// The stream fails when a string that is read is longer than `most_bytes`.
  std::string_view code(EntropyStream& stream, ContextMixer& mixer, Hash column,
                        std::string_view text, std::size_t most_bytes);

  /// Makes this copy of a coder that has not changed since equal to it again.
  void revert(const StringCoder& original) {
    history_.resize(original.history_.size());
    last_of_column_.revert(original.last_of_column_);
    after_three_.revert(original.after_three_);
    is_over_limit_ = original.is_over_limit_;
    before_ = original.before_;
  }

  /// Whether a string was longer than it may be.
  bool is_over_limit() const { return is_over_limit_; }

 private:
  /// Where an earlier string goes on like this one.
  struct Match {
    std::size_t at = 0;
    std::uint32_t length = 0;  // 0: none
  };
  bool code_character(EntropyStream& stream, ContextMixer& mixer, Hash column, std::size_t position,
                      Match& match, unsigned char& character, bool& is_end);
  /// Copies the characters of the match that come next in the string; returns their number.
  std::size_t copy(EntropyStream& stream, ContextMixer& mixer, Hash column, Match& match,
                   std::string_view rest, std::size_t most_bytes);
  void take(unsigned char character) {
    history_ += static_cast<char>(character);
    before_ = (before_ << 8U) | character;
  }

  std::string history_;                        // all strings, a NUL after each
  FlatMap<Hash, std::size_t> last_of_column_;  // where the last string of a column begins
  FlatMap<Hash, std::size_t> after_three_;     // what followed three characters
  bool is_over_limit_ = false;
  std::uint32_t before_ = 0;  // the last four characters, the last one lowest
};

}  // namespace watertight::columns
