// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html/html_page.h"

#include <array>
#include <charconv>

#include "base/json_text.h"

namespace watertight::report {

/// All figures, a symbol on each line (cmake/figures.cmake).
extern const std::string_view kFigures;

std::string html_text(std::string_view text) {
  std::string html;
  html.reserve(text.size());
  const std::string clean = utf8_text(text);
  for (const char c : clean) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

void append(std::string& html, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) html += part;
}

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, 6)
                       .ptr;
  return {buffer.data(), end};
}

std::string count_text(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
  return digits;
}

std::string counted(std::uint64_t count, std::string_view noun) {
  std::string text = count_text(count);
  text += ' ';
  text += noun;
  if (count != 1) text += 's';
  return text;
}

void append_fact(std::string& html, std::string_view name, std::string_view value,
                 FactStyle style) {
  if (value.empty()) return;
  const bool is_code = style == FactStyle::code;
  html += "<dt>";
  html += name;
  html += is_code ? "</dt><dd><code>" : "</dt><dd>";
  html += html_text(value);
  html += is_code ? "</code></dd>" : "</dd>";
}

std::string_view figure_symbol(int code) {
  const std::string start = "<symbol id=\"figure-" + std::to_string(code) + "\"";
  const std::size_t at = kFigures.find(start);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = kFigures.substr(at);
  return rest.substr(0, rest.find('\n'));
}

}  // namespace watertight::report
