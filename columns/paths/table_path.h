// SPDX-License-Identifier: GPL-3.0-or-later
//
// Follows a table: cells with tabs between them, in lines of which the first is the table's name.
// Internal to columns/.
#pragma once

#include <cstdint>
#include <string_view>

#include "columns/mark_coder.h"
#include "columns/place.h"

namespace watertight::columns {

class TablePath {
 public:
  /// Goes to the start of another table.
  void restart();
  /// Follows the text of a mark: the name of the table and a line feed, a tab or a line feed.
  void follow(std::string_view mark);
  /// Where the next value or mark is.
  Place place() const;

 private:
  Hash table_ = 0;
  std::uint32_t column_ = 0;
};

/// Cuts a table into marks and values.
class TableTokens {
 public:
  explicit TableTokens(std::string_view text) : rest_(text) {}
  Mark next_mark();
  std::string_view next_value();

 private:
  std::string_view rest_;
  bool is_first_ = true;
};

}  // namespace watertight::columns
