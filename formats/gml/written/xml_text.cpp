// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/written/xml_text.h"

#include <algorithm>
#include <cctype>

namespace watertight::formats {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool is_name_character(char c) {
  return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
}

}  // namespace

void XmlText::append_escaped(std::string_view text, bool is_attribute) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto byte = static_cast<unsigned char>(c);
    if (c == '&') {
      text_ += "&amp;";
    } else if (c == '<') {
      text_ += "&lt;";
    } else if (c == '>') {
      text_ += "&gt;";
    } else if (c == '"' && is_attribute) {
      text_ += "&quot;";
    } else if (c == '\r') {
      text_ += "&#13;";
    } else if (is_attribute && (c == '\n' || c == '\t')) {
      text_ += c == '\n' ? "&#10;" : "&#9;";
    } else if (byte < 0x20 && c != '\n' && c != '\t') {
      text_ += kReplacement;
    } else if (text.substr(i).starts_with("\xEF\xBF\xBE") ||
               text.substr(i).starts_with("\xEF\xBF\xBF")) {  // U+FFFE and U+FFFF
      text_ += kReplacement;
      i += 2;
    } else {
      text_ += c;
    }
  }
}

void XmlText::start(std::string_view name, std::span<const XmlAttribute> attributes) {
  text_.append(2 * open_.size(), ' ').append("<").append(name);
  for (const auto& [key, value] : attributes) {
    if (value.empty()) continue;
    text_.append(" ").append(key).append("=\"");
    append_escaped(value, true);
    text_ += '"';
  }
}

void XmlText::open(std::string_view name, std::span<const XmlAttribute> attributes) {
  start(name, attributes);
  text_ += ">\n";
  open_.emplace_back(name);
}

void XmlText::close() {
  const std::string name = std::move(open_.back());
  open_.pop_back();
  text_.append(2 * open_.size(), ' ').append("</").append(name).append(">\n");
}

void XmlText::leaf(std::string_view name, std::string_view text,
                   std::initializer_list<XmlAttribute> attributes) {
  start(name, std::span(attributes.begin(), attributes.size()));
  if (text.empty()) {
    text_ += "/>\n";
    return;
  }
  text_ += '>';
  append_escaped(text, false);
  text_.append("</").append(name).append(">\n");
}

void XmlText::comment(std::string_view text) {
  text_.append(2 * open_.size(), ' ').append("<!-- ");
  for (const char c : text) {  // a comment cannot have two hyphens in turn
    text_ += c == '-' && text_.back() == '-' ? '_' : c;
  }
  text_ += " -->\n";
}

std::string xml_name(std::string_view text) {
  const bool is_name = !text.empty() && is_letter(text.front()) && !text.starts_with("_x") &&
                       std::all_of(text.begin(), text.end(), is_name_character);
  if (is_name) return std::string(text);
  static constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string name = "_x";  // the names of texts that are none begin so
  for (const char c : text) {
    if (is_name_character(c) && c != '_') {
      name += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    name.append("_").append(1, kHex[byte >> 4U]).append(1, kHex[byte & 15U]);
  }
  return name;
}

}  // namespace watertight::formats
