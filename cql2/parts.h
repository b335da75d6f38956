// SPDX-License-Identifier: GPL-3.0-or-later
//
// Parts of filters that both encodings have. Internal to cql2/.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "base/result.h"
#include "store/filter.h"

namespace watertight::cql2 {

store::Filter negated(store::Filter part);
/// The comparison of a sign, "<" for example.
std::optional<store::Comparison> comparison_named(std::string_view sign);
/// Whether a text has the characters of a date or an instant of RFC 3339.
bool is_instant(std::string_view text);
/// Whether each backslash of a pattern stands before a character.
bool is_pattern(std::string_view text);
/// Minima, then maxima. Errors: malformed.
Result<store::Filter> box_filter(std::span<const double> numbers);
/// Errors: malformed.
Result<store::Filter> point_filter(std::span<const double> numbers);

}  // namespace watertight::cql2
