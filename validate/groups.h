// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rules about several solids: the members of a composite solid (501, 502, 503), the parts of a
// building in one level of detail (601), and the cells of an indoor model (701). Exact, on the
// coordinates of the solids; no Nef polyhedra.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/cancel.h"
#include "base/limits.h"
#include "geometry/placement.h"
#include "geometry/valid_solid.h"
#include "validate/report.h"

namespace watertight::validate {

enum class GroupKind : std::uint8_t { composite_solid, building_parts, indoor_cells };
/// "composite_solid", "building_parts" or "indoor_cells", as in reports.
std::string_view to_string(GroupKind kind);

/// The most that a step of coordinates counts for GroupOptions::do_steps_warn, metres: a solid in
/// whole metres can overlap another one visibly.
inline constexpr double kCoarsestStep = 0.01;

struct GroupOptions {
  /// The depth in metres up to which overlaps are allowed; with 0 no overlap is (exact). An overlap
  /// reaches no deeper than d if each connected part of it fits between two parallel planes d
  /// apart. Planes across the axes and along the facets that meet the part are tried, so the depth
  /// is never too small; for a slab between two facets, the depth is the thickness of the slab.
  double overlap_metres = 0;
  /// Whether an overlap no deeper than the steps of both solids' coordinates is a warning: the
  /// coordinates cannot say that the solids are apart. A step counts up to kCoarsestStep. Solids
  /// with placements, and those on no grid, have no steps.
  bool do_steps_warn = true;
  Limits limits;
  CancelPoll cancel = {};
};

/// A member of a group: a valid solid or, with a placement, an instance of a geometry template with
/// its valid solid. A member without a solid is not valid and is not compared.
struct GroupMember {
  const ValidSolid* solid = nullptr;
  const geometry::Placement* placement = nullptr;
  std::string name = {};  // the name in details, for cells; "": the index
};

/// The result of a comparison. Places name a member by Place::solid, its index in `members`.
struct GroupReport {
  /// `undecided` if the comparison was cancelled or not possible, as when the members' coordinates
  /// have no exact common grid; not_run has the reason.
  Verdict verdict = Verdict::valid;
  std::vector<Finding> findings;       // the findings, ordered by code, then by pair
  std::uint64_t findings_omitted = 0;  // the number of findings beyond Limits::findings
  std::vector<SkippedRule> not_run;
};

/// Compares valid solids of one coordinate reference system pair by pair; a member that is not
/// valid is not compared, and not_run says so.
///
/// 501, 601, 701: the interiors of two solids have a point in common; the finding has both facets,
/// the depth in metres (GroupOptions::overlap_metres) and, where one was found, a point inside
/// both. It is a warning if the depth is no more than the steps of the coordinates (do_steps_warn).
/// 502: two members are the same points, however their facets are divided. 503: areas that two
/// members have in common do not connect all members; there is one finding for each part but that
/// of the first member; not tested if members overlap or are the same, as in val3dity.
///
/// Members that share one placement, or have none, are compared exactly on their own coordinates.
/// Other pairs are compared on a SharedGrid of the world; two members without placements are never
/// rounded. If a member of a pair was rounded, the two overlap only if they do so wherever their
/// vertices lie within 16 steps of the grid, some 1e-14 of their extent: the digits of a matrix can
/// turn a contact into an overlap or a gap.
///
/// Members with the same entry in `unit_of` are not compared with each other; if `unit_of` is
/// empty, all members are compared. Never fails. Deterministic, independent of threads. Cost: the
/// pairs of overlapping boxes, then near linear in the triangles inside the overlap of the boxes.
/// The comparison ends soon after Limits::findings overlaps, and not_run says so.
GroupReport check_group(std::span<const GroupMember> members, GroupKind kind,
                        const GroupOptions& options = {}, std::span<const Index> unit_of = {});

/// How two cells that are said to be neighbours meet, from the worst to the best.
enum class CellContact : std::uint8_t {
  unknown,       // not compared: a cell is not valid, or the comparison ended before
  apart,         // no point in common
  within_steps,  // apart by no more than the steps of the coordinates (do_steps_warn)
  at_points,     // points or edges in common, but no area
  allowed,       // apart by no more than GroupOptions::overlap_metres
  area           // an area in common, or interiors
};

/// Two cells that should be neighbours, as entries of `unit_of`.
struct CellPair {
  Index first = kNone;
  Index second = kNone;
  CellContact contact = CellContact::unknown;  // the result
};

/// Compares the cells of an indoor model as check_group() does (701), and decides how the
/// neighbours meet. `unit_of` has the cell of each member, ascending; all members are valid.
/// Whether two cells have points, areas or interiors in common is decided exactly; the distance of
/// cells that are apart is computed in doubles. Cost: that of check_group(), and for each pair of
/// neighbours near linear in the triangles near the other cell.
GroupReport check_cells(std::span<const GroupMember> members, std::span<const Index> unit_of,
                        std::span<CellPair> neighbours, const GroupOptions& options = {});

}  // namespace watertight::validate
