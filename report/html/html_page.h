// SPDX-License-Identifier: GPL-3.0-or-later
//
// The fixed parts of the HTML report: style, script, and the escaping of text. Internal to report/.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace watertight::report {

/// Text for elements and quoted attributes: markup characters become entities, control characters
/// and bytes that are not UTF-8 become U+FFFD.
std::string html_text(std::string_view text);

/// Appends the parts one after the other.
void append(std::string& html, std::initializer_list<std::string_view> parts);

/// A number with 6 significant digits.
std::string number_text(double value);

/// A count with separators, such as "12,345".
std::string count_text(std::uint64_t count);

/// A count with its noun: "1 finding", "12,345 findings".
std::string counted(std::uint64_t count, std::string_view noun);

/// Appends a term and its value to a list of facts; nothing for an empty value.
enum class FactStyle : std::uint8_t { text, code };
void append_fact(std::string& html, std::string_view name, std::string_view value,
                 FactStyle style = FactStyle::text);

/// The figure of a code in docs/figures as an SVG <symbol> with the id "figure-CODE"; "" without
/// one.
std::string_view figure_symbol(int code);

/// Content of the page's <style> and <script>: the files report/html/page.css and
/// report/html/page.js, which report/CMakeLists.txt embeds.
extern const std::string_view kPageStyle;
extern const std::string_view kPageScript;

}  // namespace watertight::report
