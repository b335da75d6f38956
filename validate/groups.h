// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rules about several solids: the members of a composite solid (501, 502, 503) and the parts of a
// building in one level of detail (601). Exact, on the coordinates of the solids; no Nef polyhedra.
#pragma once

#include <span>
#include <vector>

#include "base/limits.h"
#include "delaunay/ladder.h"
#include "geometry/valid_solid.h"
#include "validate/report.h"

namespace watertight {

enum class GroupKind : std::uint8_t { composite_solid, building_parts };

struct GroupOptions {
  /// Overlaps that reach no deeper than this are allowed; 0: none are (exact).
  double overlap_metres = 0;
  Limits limits;
  CancelPoll cancel = {};
};

/// What a comparison of solids found. Places name a member by Place::solid, its index in `members`.
struct GroupReport {
  Verdict verdict = Verdict::valid;  // undecided when it was cancelled
  std::vector<Finding> findings;     // ordered by code, then by pair
  std::uint64_t findings_omitted = 0;
  std::vector<SkippedRule> not_run;
};

/// Compares valid solids of one coordinate reference system pair by pair; a null entry is a member
/// that is not valid: the rules are not run for it, and not_run says so.
/// Never fails. Deterministic, independent of threads. Cost: pairs of overlapping boxes, then near
/// linear in the triangles inside the overlap of their boxes.
GroupReport check_group(std::span<const ValidSolid* const> members, GroupKind kind,
                        const GroupOptions& options = {});

}  // namespace watertight
