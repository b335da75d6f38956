// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads XML as events with namespaces and places, over expat. Nothing outside the bytes is ever
// read: a document type declaration, and with it every entity but the five of XML, is refused.
// Internal to formats/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "base/result.h"

namespace watertight::formats {

/// The white space of XML (XML 1.0, section 2.3).
inline constexpr std::string_view kXmlBlanks = " \t\r\n";

/// The text without blanks at both ends.
std::string_view without_blanks(std::string_view text);

/// Takes the next word off the front of the text; "" at its end.
std::string_view take_word(std::string_view& text, std::string_view separators = kXmlBlanks);

/// The words of the text.
std::vector<std::string_view> words_of(std::string_view text,
                                       std::string_view separators = kXmlBlanks);

/// The place where an element starts.
struct XmlPlace {
  std::uint64_t byte = 0;
  std::uint64_t line = 1;
};

/// The error "line 12: <message>" with the byte offset.
Error error_at(XmlPlace place, ErrorCode code, std::string_view message);

/// A start tag; valid during the call that receives it.
struct XmlElement {
  std::string_view space;  // namespace URI, "" for none
  std::string_view name;   // local name
  const char** attributes = nullptr;
  XmlPlace place;
  std::uint64_t content = 0;  // the byte after the start tag

  /// The value of an attribute, if there is one. Cost: linear in the number of attributes.
  std::optional<std::string_view> attribute(std::string_view attribute_space,
                                            std::string_view attribute_name) const;
};

/// Takes the events of one document. The first error ends the reading and is returned.
class XmlHandler {
 public:
  virtual ~XmlHandler() = default;
  virtual Status start(const XmlElement& element) = 0;
  /// Receives character data in pieces of any length; CDATA sections and character references are
  /// resolved.
  virtual Status text(std::string_view text) = 0;
  virtual Status end() = 0;
};

/// Reads UTF-8, UTF-16, ISO-8859-1 and US-ASCII; text and names reach the handler as UTF-8. Errors:
/// malformed with byte offset and line; unsupported (encoding, document type declaration);
/// limit_exceeded when elements are nested deeper than limits.nesting; those of the handler. Cost:
/// linear; memory proportional to the depth and the longest token.
Status read_xml(ByteView bytes, XmlHandler& handler, const Limits& limits);

}  // namespace watertight::formats
