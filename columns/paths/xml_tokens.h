// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cuts an XML text into marks and values. Internal to columns/.
#pragma once

#include <string_view>

#include "columns/mark_coder.h"
#include "columns/paths/xml_path.h"

namespace watertight::columns {

class XmlTokens {
 public:
  explicit XmlTokens(std::string_view text) : rest_(text) {}
  Mark next_mark();
  /// The value after a mark that is not the last.
  std::string_view next_value();

 private:
  std::string_view rest_;
  bool is_in_tag_ = false;
  char quote_ = '\0';      // of the value that comes next, or came last; 0: it has none
  std::size_t items_ = 0;  // of a list of numbers: the values of it that are left
};

}  // namespace watertight::columns
