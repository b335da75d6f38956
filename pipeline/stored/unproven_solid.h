// SPDX-License-Identifier: GPL-3.0-or-later
//
// The text of a solid that is not proven to be valid. It is no blob: nothing is promised of it but
// that the same solid comes back, with its order, its repeated and unused vertices and all defects.
#pragma once

#include <string>
#include <string_view>

#include "base/limits.h"
#include "base/result.h"
#include "geometry/solid.h"

namespace watertight::pipeline {

/// The solid as one line of text without a line feed, made for compression. Cost: linear.
std::string write_unproven(const Solid& solid);

/// The solid of write_unproven(). Trusts nothing: memory is bounded by the length of the text.
/// Errors: malformed; limit_exceeded.
Result<Solid> read_unproven(std::string_view line, const Limits& limits = {});

}  // namespace watertight::pipeline
