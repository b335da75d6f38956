// SPDX-License-Identifier: GPL-3.0-or-later
//
// The text of `validate --explain CODE`.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace watertight::cli {

/// Meaning, cause and remedy of a finding in lines of at most 100 columns, for a code or a name.
/// Errors: invalid_argument naming the codes that there are.
Result<std::string> explained(std::string_view code);

}  // namespace watertight::cli
