// SPDX-License-Identifier: GPL-3.0-or-later
//
// The sections of docs/findings.md, which the library has inside: meaning, cause and remedy of each
// finding. For `validate --explain` and the rules of SARIF.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace watertight::report {

/// The parts of a section of docs/findings.md; texts are one paragraph each, with Markdown's
/// backquotes.
struct Explanation {
  int code = 0;
  std::string_view name;  // "SHELL_NOT_CLOSED"
  std::string meaning;
  std::string cause;
  std::string remedy;
  std::string picture;  // the path in the repository, "docs/figures/302.svg"
};

/// The section of a code; nullopt if the page has none. Cost: linear in the page (26 kB).
std::optional<Explanation> explanation_of(int code);

/// The code that a user means by a number or a name in any case: "302", "shell_not_closed"; nullopt
/// for no finding of this program.
std::optional<int> code_of_text(std::string_view text);

}  // namespace watertight::report
