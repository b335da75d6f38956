// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/edits/xml_spans.h"

#include <algorithm>
#include <utility>

#include "formats/gml/xml.h"

namespace watertight::formats {
namespace {

/// The byte after the construct that starts at `at`, which is no tag of an element: a comment, a
/// CDATA section or a processing instruction; `at` itself for a tag.
std::size_t after_other(std::string_view document, std::size_t at) {
  const auto after = [&](std::string_view end) {
    const std::size_t found = document.find(end, at);
    return found == std::string_view::npos ? document.size() : found + end.size();
  };
  const std::string_view here = document.substr(at);
  if (here.starts_with("<!--")) return after("-->");
  if (here.starts_with("<![CDATA[")) return after("]]>");
  if (here.starts_with("<?")) return after("?>");
  return at;
}

/// The byte after a tag. A value in quotes may hold the sign that ends a tag.
std::size_t after_tag(std::string_view document, std::size_t at) {
  for (char quote = '\0'; at < document.size(); ++at) {
    const char c = document[at];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return at + 1;
    }
  }
  return at;
}

}  // namespace

XmlSpan xml_span(std::string_view document, std::size_t begin) {
  XmlSpan span;
  span.begin = begin;
  const std::size_t name_end =
      std::min(document.find_first_of(" \t\r\n/>", begin + 1), document.size());
  span.name = document.substr(begin + 1, name_end - begin - 1);
  span.content = span.content_end = span.end = after_tag(document, begin);
  if (document[span.content - 2] == '/') return span;
  std::size_t depth = 1;
  std::size_t at = span.content;
  while (depth > 0 && (at = document.find('<', at)) != std::string_view::npos) {
    if (const std::size_t after = after_other(document, at); after != at) {
      at = after;
      continue;
    }
    span.content_end = at;
    const bool is_end = document.substr(at).starts_with("</");
    at = after_tag(document, at);
    if (is_end) {
      --depth;
    } else if (document[at - 2] != '/') {
      ++depth;
    }
  }
  span.end = std::min(at, document.size());
  return span;
}

std::string_view prefix_of(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? std::string_view() : name.substr(0, colon + 1);
}

std::string_view indent_before(std::string_view document, std::size_t begin) {
  const std::size_t last = document.substr(0, begin).find_last_not_of(kXmlBlanks);
  const std::size_t after = last == std::string_view::npos ? 0 : last + 1;
  const std::string_view blanks = document.substr(after, begin - after);
  const std::size_t line = blanks.rfind('\n');
  return line == std::string_view::npos ? std::string_view() : blanks.substr(line);
}

Result<std::string> changed_text(std::string_view text, std::vector<TextChange> changes) {
  std::ranges::stable_sort(
      changes, {}, [](const TextChange& change) { return std::pair(change.begin, change.end); });
  std::string changed;
  std::size_t at = 0;
  for (const TextChange& change : changes) {
    if (change.begin < at) {
      return Error{ErrorCode::unsupported, "two changes concern one element", change.begin, {}};
    }
    changed.append(text.substr(at, change.begin - at)).append(change.text);
    at = change.end;
  }
  return changed.append(text.substr(at));
}

}  // namespace watertight::formats
