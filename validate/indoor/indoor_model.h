// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rules of indoor models (IndoorGML): the cells do not overlap (701), states are inside their
// cells (702), the references between cells, states and transitions fit (703), and cells that a
// transition joins are neighbours (704). The codes have val3dity's meanings.
#pragma once

#include <span>
#include <vector>

#include "geometry/cell_graph.h"
#include "validate/groups.h"

namespace watertight::validate {

/// The solids of a cell of the graph; null for a solid that is not valid. A cell without solids has
/// none in the document: its references are judged, nothing else.
using CellSolids = std::vector<const ValidSolid*>;

/// Judges an indoor model. `solids` has an entry for each cell of the graph. The result has a
/// report for each cell, in which Place::solid is the index of a solid of the cell, and after them
/// one report with the findings that name no cell. A finding about two cells is in the reports of
/// both. `source` has the line of the element that a finding is about.
///
/// 702: exact; a state on the boundary is inside, as in val3dity. 703: a duality or connects refers
/// to no element of the document or to several; the state of a cell has another cell or none; the
/// cell of a state has another state; an element has more than one duality; a transition does not
/// connect two states, or not the one that refers to it. Cells without state, states without cell,
/// and dualities that only the state states are allowed. 704: the cells of two connected states
/// have no point in common, and are farther apart than GroupOptions::overlap_metres; it is a
/// warning if they have only points or edges in common, or if the gap is no wider than the steps of
/// the coordinates (do_steps_warn). Cells that touch without a transition are allowed.
///
/// At most Limits::findings findings are kept in all. Never fails. Deterministic. Cost: that of
/// check_cells(), n log n in the graph, and for each cell linear in its solids.
std::vector<GroupReport> check_indoor_model(const geometry::CellGraph& graph,
                                            std::span<const CellSolids> solids,
                                            const GroupOptions& options = {});

}  // namespace watertight::validate
