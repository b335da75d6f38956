// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rules by which solids are judged, as texts: those that a collection keeps for all its writes,
// and the parameters of requests.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The names of the rules.
inline constexpr std::array<std::string_view, 6> kRuleNames{
    "exact-overlaps", "overlap", "planarity", "planarity-angle", "proof", "strict"};

/// Names and values of rules: `planarity` (metres) and `planarity-angle` (degrees) above 0,
/// `overlap` (metres) from 0, `exact-overlaps` and `strict` (true or false), `proof`
/// (tetrahedralization or boundary).
using Rules = std::vector<std::pair<std::string, std::string>>;

/// Sets a number above 0 (or from 0), at most `limit`, from its text. Errors: invalid_argument,
/// which names the parameter.
Status read_number(std::string_view name, std::string_view value, bool can_be_zero, double limit,
                   double& number);

/// Sets one rule. Errors: invalid_argument for another name or a value that it cannot have.
Status apply_rule(std::string_view name, std::string_view value, IngestOptions& options);

/// The rules as one text, which the store keeps with a collection; in order of their names.
std::string rules_text(Rules rules);
/// The rules in a text of rules_text().
Rules rules_in(std::string_view text);

/// Sets the rules in a text of rules_text(). Errors: as for apply_rule().
Status apply_rules(std::string_view text, IngestOptions& options);

/// Sets the rules that the collection of a write keeps, if it exists. Errors: those of the store.
Status apply_rules_of(SolidStore& store, IngestOptions& options);

}  // namespace watertight::pipeline
