// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/findings/explain.h"

#include "report/explanation.h"
#include "validate/finding_kinds.h"

namespace watertight::cli {
namespace {

constexpr std::size_t kColumns = 100;

/// Text without Markdown's backquotes, in lines that begin below each other.
std::string paragraph(std::string_view name, std::string_view text) {
  constexpr std::size_t kIndent = 10;
  std::string lines(name);
  lines.append(kIndent > name.size() ? kIndent - name.size() : 1, ' ');
  std::size_t column = kIndent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (column > kIndent && column + 1 + word.size() > kColumns) {
      lines.append(1, '\n').append(kIndent, ' ');
      column = kIndent;
    }
    if (column > kIndent) lines += ' ';
    column += word.size() + (column > kIndent ? 1 : 0);
    for (const char c : word) {
      if (c != '`') lines += c;
    }
  }
  return lines + "\n";
}

std::string known_codes() {
  std::string codes;
  for (const validate::FindingKind& kind : validate::finding_kinds()) {
    if (!codes.empty()) codes += ' ';
    codes += std::to_string(kind.code);
  }
  return codes;
}

}  // namespace

Result<std::string> explained(std::string_view code) {
  const auto number = report::code_of_text(code);
  const auto explanation = number ? report::explanation_of(*number) : std::nullopt;
  const validate::FindingKind* kind = number ? validate::find_kind(*number) : nullptr;
  if (!explanation || kind == nullptr) {
    return Error{ErrorCode::invalid_argument,
                 "no finding has this code or name; there are " + known_codes()};
  }
  std::string text = std::to_string(kind->code);
  text.append(1, ' ').append(kind->name).append(" (");
  text.append(validate::to_string(kind->severity)).append("): ");
  text.append(kind->summary).append("\n\n");
  text += paragraph("Meaning", explanation->meaning);
  text += paragraph("Cause", explanation->cause);
  text += paragraph("Remedy", explanation->remedy);
  text += paragraph("Repair", kind->is_repairable
                                  ? "A program can do it without a guess at the intended shape."
                                  : "It takes a decision about the intended shape.");
  text += paragraph("Picture", explanation->picture);
  return text + paragraph("More", "docs/findings.md");
}

}  // namespace watertight::cli
