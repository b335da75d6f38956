// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides which solids of a feature are compared, and reports the comparison.
#pragma once

#include <span>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// A solid that groups may have as a member. The caller keeps what the pointers refer to.
struct GroupCandidate {
  const SolidSource* source = nullptr;
  validate::GroupMember member;
};

/// The solids of a feature as candidates, in order.
std::vector<GroupCandidate> group_candidates(const InspectedFeature& feature);

/// One group for each CompositeSolid geometry (rules 501 to 503), and one for the solids of a
/// building with its parts in each level of detail (601) that come from two geometries or more;
/// solids of one MultiSolid or CompositeSolid are not compared for 601. Groups come in order of
/// their first members; members are indices into `candidates`. Solids that are not valid are
/// members, but are not compared. Never fails. Cost: that of check_group().
std::vector<InspectedGroup> inspect_groups(std::span<const GroupCandidate> candidates,
                                           const validate::GroupOptions& options);

}  // namespace watertight::pipeline
