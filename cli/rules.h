// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rules by which solids are judged, as options of the commands that validate.
#pragma once

#include <optional>
#include <string>

#include "pipeline/pipeline.h"
#include "validate/certify.h"
#include "validate/groups.h"

namespace watertight::cli {

/// What the command line states; what it does not state stays as it is.
struct RuleChoice {
  std::optional<double> planarity_metres;
  std::optional<double> planarity_degrees;
  std::optional<double> overlap_metres;
  bool are_steps_errors = false;     // overlaps of a step of the coordinates or less
  std::optional<std::string> proof;  // "tetrahedralization" or "boundary"
  bool is_strict = false;
};

/// The rule for surfaces of a name that the command line has checked.
inline pipeline::SurfaceRule surface_rule(const std::string& name) {
  const auto rule = pipeline::surface_rule_named(name);
  return rule ? *rule : pipeline::SurfaceRule{};
}

/// Sets the rules of solids and of groups of them.
inline void apply(const RuleChoice& rules, CertifyOptions& certify,
                  validate::GroupOptions& groups) {
  Tolerances& tolerances = certify.tolerances;
  if (rules.planarity_metres) tolerances.planarity_metres = *rules.planarity_metres;
  if (rules.planarity_degrees) tolerances.planarity_degrees = *rules.planarity_degrees;
  if (rules.proof) {
    certify.proof = *rules.proof == "boundary" ? Proof::boundary : Proof::tetrahedralization;
  }
  if (rules.is_strict) certify.ladder.strict = true;
  if (rules.overlap_metres) groups.overlap_metres = *rules.overlap_metres;
  if (rules.are_steps_errors) groups.do_steps_warn = false;
}

}  // namespace watertight::cli
