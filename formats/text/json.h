// SPDX-License-Identifier: GPL-3.0-or-later
//
// JSON values for the readers and writers of this folder. Member order is kept, and a number that
// would be printed with another text is kept as its text, so that printing returns the same
// numbers. Internal to formats/.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "base/limits.h"
#include "base/result.h"

namespace watertight::formats {

/// Appends the digits of a whole number.
template <std::integral Integer>
void append_integer(std::string& out, Integer value) {
  std::array<char, 24> digits;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

/// A JSON value. A value of kind `binary` (which JSON text cannot hold) is the text of a number.
using Json = nlohmann::ordered_json;

/// The JSON value of the number `text`, whose nearest double is `value`: a double if printing gives
/// `text` again, else the text.
Json number_value(double value, std::string_view text);

/// True for integers, doubles and numbers kept as text.
bool is_number_value(const Json& value);

/// Appends the compact JSON text. Recursive; the reader's nesting limit bounds the depth.
void append_json(std::string& out, const Json& value);
std::string json_text(const Json& value);

/// Appends a JSON string with its quotes. Requires valid UTF-8.
void append_json_string(std::string& out, std::string_view text);

/// The member, or nullptr if `object` is not an object or has no such member. Cost: linear.
const Json* find_member(const Json& object, std::string_view key);
Json* find_member(Json& object, std::string_view key);

/// The member's text if it is a string, else "".
std::string string_member(const Json& object, std::string_view key);

/// An object of the members `keys` and `values`, which are moved, in this order. The keys must
/// differ. Cost: linear.
Json make_object(std::span<std::string> keys, std::span<Json> values);

/// Appends a member whose key the object does not have yet.
void append_member(Json& object, std::string key, Json value);

/// "/" and the key as a reference token of a JSON Pointer (RFC 6901).
std::string pointer_token(std::string_view key);
std::string pointer_token(std::size_t index);

/// Parses a JSON text. Errors: malformed with byte offset; limit_exceeded beyond limits.nesting and
/// limits.bytes.
Result<Json> parse_json(std::string_view text, const Limits& limits);

}  // namespace watertight::formats
