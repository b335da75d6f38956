// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html/html_page.h"

#include "base/json_text.h"

namespace watertight::report {

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

}  // namespace watertight::report
