// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cuts a JSON text into marks and values. Internal to columns/.
#pragma once

#include <string_view>

#include "columns/mark_coder.h"
#include "columns/paths/json_path.h"

namespace watertight::columns {

class JsonTokens {
 public:
  explicit JsonTokens(std::string_view text) : rest_(text) {}
  Mark next_mark();
  /// The value after a mark that is not the last.
  std::string_view next_value();

 private:
  std::string_view rest_;
  JsonPath path_;           // tells keys that are ids from others
  bool is_quoted_ = false;  // the value that comes next, or came last
};

}  // namespace watertight::columns
