// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rules by which solids are judged, as options of the commands that validate.
#pragma once

#include <string>

#include "pipeline/pipeline.h"
#include "validate/certify.h"
#include "validate/groups.h"

namespace watertight::cli {

struct RuleChoice {
  double planarity_metres = 0.01;
  double planarity_degrees = 20;
  double overlap_metres = 0;
  bool are_steps_errors = false;             // overlaps of a step of the coordinates or less
  std::string proof = "tetrahedralization";  // or "boundary"
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
  certify.tolerances.planarity_metres = rules.planarity_metres;
  certify.tolerances.planarity_degrees = rules.planarity_degrees;
  certify.proof = rules.proof == "boundary" ? Proof::boundary : Proof::tetrahedralization;
  certify.ladder.strict = rules.is_strict;
  groups.overlap_metres = rules.overlap_metres;
  groups.do_steps_warn = !rules.are_steps_errors;
}

}  // namespace watertight::cli
