// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers of things in messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace watertight {

/// A count with its noun: "1 facet", "2 facets". `plural` is for nouns whose plural does not end in
/// s alone.
inline std::string quantity(std::uint64_t count, std::string_view noun,
                            std::string_view plural = {}) {
  std::string text = std::to_string(count);
  text.append(1, ' ').append(count == 1 || plural.empty() ? noun : plural);
  if (count != 1 && plural.empty()) text.append(1, 's');
  return text;
}

}  // namespace watertight
