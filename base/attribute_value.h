// SPDX-License-Identifier: GPL-3.0-or-later
//
// A value of an attribute of a city object, as it can be compared.
#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace watertight {

struct AttributeValue {
  enum class Type : std::uint8_t { number, text, truth };
  Type type = Type::text;
  /// The digits of a number as JSON has them, all of them; the characters of a text (UTF-8); "true"
  /// or "false".
  std::string text;
  friend auto operator<=>(const AttributeValue&, const AttributeValue&) = default;
};

}  // namespace watertight
