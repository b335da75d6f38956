// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/text/json.h"

#include <array>
#include <charconv>
#include <utility>

namespace watertight::formats {
namespace {

void append_double(std::string& out, double value) {
  std::array<char, 32> digits{};
  const std::size_t begin = out.size();
  out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
  if (out.find_first_of(".e", begin) == std::string::npos) out += ".0";
}

void append_object(std::string& out, const Json& value) {
  out += '{';
  bool is_first = true;
  for (const auto& [key, member] : value.get_ref<const Json::object_t&>()) {
    if (!is_first) out += ',';
    is_first = false;
    append_json_string(out, key);
    out += ':';
    append_json(out, member);
  }
  out += '}';
}

void append_array(std::string& out, const Json& value) {
  out += '[';
  bool is_first = true;
  for (const Json& element : value.get_ref<const Json::array_t&>()) {
    if (!is_first) out += ',';
    is_first = false;
    append_json(out, element);
  }
  out += ']';
}

}  // namespace

Json number_value(double value, std::string_view text) {
  std::string own;
  append_double(own, value);
  if (own == text) return value;
  return Json::binary(std::vector<std::uint8_t>(text.begin(), text.end()));
}

bool is_number_value(const Json& value) { return value.is_number() || value.is_binary(); }

void append_json_string(std::string& out, std::string_view text) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  out += '"';
  std::size_t begin = 0;  // start of the characters that are written unchanged
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto byte = static_cast<unsigned char>(c);
    if (c != '"' && c != '\\' && byte >= 0x20) continue;
    out += text.substr(begin, i - begin);
    begin = i + 1;
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\r') {
      out += "\\r";
    } else if (c == '\t') {
      out += "\\t";
    } else {
      out += "\\u00";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    }
  }
  out += text.substr(begin);
  out += '"';
}

void append_json(std::string& out, const Json& value) {
  switch (value.type()) {
    case Json::value_t::object:
      return append_object(out, value);
    case Json::value_t::array:
      return append_array(out, value);
    case Json::value_t::string:
      return append_json_string(out, value.get_ref<const std::string&>());
    case Json::value_t::boolean:
      out += value.get<bool>() ? "true" : "false";
      return;
    case Json::value_t::number_integer:
      return append_integer(out, value.get<std::int64_t>());
    case Json::value_t::number_unsigned:
      return append_integer(out, value.get<std::uint64_t>());
    case Json::value_t::number_float:
      return append_double(out, value.get<double>());
    case Json::value_t::binary:
      out.append(value.get_binary().begin(), value.get_binary().end());
      return;
    case Json::value_t::null:
    case Json::value_t::discarded:
      out += "null";
  }
}

std::string json_text(const Json& value) {
  std::string out;
  append_json(out, value);
  return out;
}

const Json* find_member(const Json& object, std::string_view key) {
  if (!object.is_object()) return nullptr;
  for (const auto& [name, value] : object.get_ref<const Json::object_t&>()) {
    if (name == key) return &value;
  }
  return nullptr;
}

Json* find_member(Json& object, std::string_view key) {
  return const_cast<Json*>(find_member(std::as_const(object), key));
}

std::string string_member(const Json& object, std::string_view key) {
  const Json* value = find_member(object, key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

Json make_object(std::span<std::string> keys, std::span<Json> values) {
  // The vector of an ordered_map copies its elements, whose keys are const, when it grows; reserved
  // room avoids that.
  Json object = Json::object();
  auto& members = object.get_ref<Json::object_t&>();
  members.reserve(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    members.emplace_back(std::move(keys[i]), std::move(values[i]));
  }
  return object;
}

void append_member(Json& object, std::string key, Json value) {
  object.get_ref<Json::object_t&>().emplace_back(std::move(key), std::move(value));
}

std::string pointer_token(std::string_view key) {
  std::string token = "/";
  for (const char c : key) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

std::string pointer_token(std::size_t index) { return '/' + std::to_string(index); }

}  // namespace watertight::formats
