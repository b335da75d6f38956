// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/explanation.h"

#include <algorithm>

#include "validate/finding_kinds.h"

namespace watertight::report {

/// The file docs/findings.md.
extern const std::string_view kFindingsPage;

namespace {

/// The text between a heading "## CODE " and the next heading; "" without one.
std::string_view section_of(int code) {
  const std::string_view page = kFindingsPage;
  std::string heading = "\n## ";
  heading += std::to_string(code);
  heading += ' ';
  const std::size_t start = page.find(heading);
  if (start == std::string_view::npos) return {};
  const std::string_view rest = page.substr(start + 1);
  return rest.substr(0, rest.find("\n## "));
}

std::string_view next_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

/// The text after the prefix if the line begins with it.
std::optional<std::string_view> after(std::string_view line, std::string_view prefix) {
  if (!line.starts_with(prefix)) return std::nullopt;
  return line.substr(prefix.size());
}

void append_words(std::string& text, std::string_view words) {
  words.remove_prefix(std::min(words.find_first_not_of(' '), words.size()));
  if (words.empty()) return;
  if (!text.empty()) text += ' ';
  text += words;
}

}  // namespace

std::optional<Explanation> explanation_of(int code) {
  std::string_view section = section_of(code);
  if (section.empty()) return std::nullopt;
  next_line(section);
  Explanation explanation;
  explanation.code = code;
  explanation.name = validate::finding_name(code);
  std::string sample;  // not part of the explanation
  std::string* part = &explanation.meaning;
  while (!section.empty()) {
    std::string_view line = next_line(section);
    if (line.starts_with("![")) {
      explanation.picture = "docs/figures/" + std::to_string(code) + ".svg";
      continue;
    }
    if (const auto cause = after(line, "- Cause:")) {
      part = &explanation.cause;
      line = *cause;
    } else if (const auto remedy = after(line, "- Remedy:")) {
      part = &explanation.remedy;
      line = *remedy;
    } else if (const auto path = after(line, "- Sample:")) {
      part = &sample;
      line = *path;
    }
    append_words(*part, line);
  }
  return explanation;
}

std::optional<int> code_of_text(std::string_view text) {
  const auto is_same = [](std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
      const char upper = x >= 'a' && x <= 'z' ? static_cast<char>(x - 'a' + 'A') : x;
      return upper == y;
    });
  };
  for (const validate::FindingKind& kind : validate::finding_kinds()) {
    if (text == std::to_string(kind.code) || is_same(text, kind.name)) return kind.code;
  }
  return std::nullopt;
}

}  // namespace watertight::report
