// SPDX-License-Identifier: GPL-3.0-or-later
//
// The places of elements in the bytes of an XML document that was read without error, and changes
// of its text. Internal to formats/.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace watertight::formats {

/// The bytes of an element: "<gml:pos srsDimension='3'>1 2 3</gml:pos>".
struct XmlSpan {
  std::size_t begin = 0;    // of the start tag
  std::size_t content = 0;  // the byte after the start tag
  std::size_t content_end = 0;
  std::size_t end = 0;                              // the byte after the end tag
  std::string_view name;                            // with its prefix: "gml:pos"
  bool is_empty() const { return content == end; }  // "<gml:pos/>"
};

/// The element whose start tag is at `begin`. Requires a well-formed document in an encoding that
/// has ASCII. Cost: linear in the element.
XmlSpan xml_span(std::string_view document, std::size_t begin);

/// The prefix of a name with its colon, "" without one.
std::string_view prefix_of(std::string_view name);

/// The blanks of the line on which an element starts, with the end of the line before it; "" if
/// something else stands before the element.
std::string_view indent_before(std::string_view document, std::size_t begin);

/// A part of a text and what takes its place.
struct TextChange {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string text;
};

/// The text with its changes. Those at one place come in their order. Errors: unsupported if
/// changes overlap. Cost: linear.
Result<std::string> changed_text(std::string_view text, std::vector<TextChange> changes);

}  // namespace watertight::formats
