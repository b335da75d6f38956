// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes text of documents fit for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace watertight::cli {

/// One line of UTF-8 that a terminal shows and does not obey: control characters (C0 with line ends
/// and tabs, DEL, C1), line separators, marks that turn the direction of writing, and bytes that
/// are no UTF-8 become U+FFFD. Ids, names and messages come from documents that anybody may have
/// written. Cost: linear.
std::string printable(std::string_view text);

}  // namespace watertight::cli
