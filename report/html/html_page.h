// SPDX-License-Identifier: GPL-3.0-or-later
//
// The fixed parts of the HTML report: style, script, and the escaping of text. Internal to report/.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace watertight::report {

/// Text for elements and quoted attributes: markup characters become entities, control characters
/// and bytes that are not UTF-8 become U+FFFD.
std::string html_text(std::string_view text);

/// Appends the parts one after the other.
void append(std::string& html, std::initializer_list<std::string_view> parts);

/// Content of the page's <style> and <script>: the files report/html/page.css and
/// report/html/page.js, which report/CMakeLists.txt embeds.
extern const std::string_view kPageStyle;
extern const std::string_view kPageScript;

}  // namespace watertight::report
