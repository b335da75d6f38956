// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/indoor/indoor_model.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "geometry/lattice/shared_grid.h"
#include "tessellate/facets.h"
#include "validate/finding_kinds.h"
#include "validate/indoor/indoor_links.h"
#include "validate/indoor/indoor_names.h"
#include "validate/overlap/point_location.h"

namespace watertight::validate {
namespace {

using geometry::CellGraph;
using geometry::GraphState;

/// A solid of one vertex and no facets at a position; nothing if no lattice holds the position.
std::optional<Solid> solid_at(const std::array<GridNumber, 3>& position, std::uint32_t srid) {
  const auto points = geometry::lattice_of_decimals({&position, 1});
  if (!points || !points->rounded.empty() || points->is_origin_rounded) return std::nullopt;
  SolidArrays arrays;
  arrays.vertices = points->points;
  auto solid = Solid::make(std::move(arrays), points->lattice, srid);
  if (!solid) return std::nullopt;
  return *std::move(solid);
}

/// Where the only vertex of `point` is in a solid, exactly. Nothing if no grid holds both exactly.
std::optional<Location> location_in(const Solid& solid, const Solid& point) {
  const std::vector<geometry::StandingSolid> both{{&solid, nullptr}, {&point, nullptr}};
  auto grid = geometry::SharedGrid::of_one_placement(both);
  if (!grid) grid = geometry::SharedGrid::in_world(both);
  if (!grid) return std::nullopt;
  for (std::size_t i = 0; i < both.size(); ++i) {
    const auto& is_rounded = grid->rounded_axes(i);
    if (is_rounded[0] || is_rounded[1] || is_rounded[2]) return std::nullopt;
  }
  const auto vertices = grid->vertices(0);
  const auto at = grid->vertices(1);
  if (!vertices || !at) return std::nullopt;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  return locate(at->front(), *vertices, facets.triangles);
}

class IndoorExaminer {
 public:
  IndoorExaminer(const CellGraph& graph, std::span<const CellSolids> solids,
                 const GroupOptions& options)
      : graph_(graph),
        solids_(solids),
        options_(options),
        links_(graph),
        reports_(graph.cells.size() + 1) {}

  std::vector<GroupReport> run() {
    name_neighbours();
    compare_cells();
    for (Index cell = 0; cell < graph_.cells.size(); ++cell) check_state(cell);
    check_links();
    report_neighbours();
    return std::move(reports_);
  }

 private:
  bool is_cancelled() const { return options_.cancel && options_.cancel(); }

  std::string cell_name(Index cell) const {
    return std::string("cell ").append(element_name(graph_.cells[cell]));
  }

  bool is_valid(Index cell) const {
    return std::none_of(solids_[cell].begin(), solids_[cell].end(),
                        [](const ValidSolid* solid) { return solid == nullptr; });
  }

  /// Adds a finding to the report of a cell, or to the last one.
  void add(Index cell, Finding finding) {
    GroupReport& report = reports_[cell == kNone ? graph_.cells.size() : cell];
    if (finding.severity == Severity::error) report.verdict = Verdict::invalid;
    if (found_ >= options_.limits.findings) {
      ++report.findings_omitted;
      return;
    }
    ++found_;
    report.findings.push_back(std::move(finding));
  }

  void skip(Index cell, std::vector<int> codes, std::string reason) {
    reports_[cell].not_run.push_back({std::move(codes), std::move(reason)});
  }

  /// The pairs of cells that transitions join, each once, with the first transition of each.
  void name_neighbours() {
    std::set<std::pair<Index, Index>> known;
    for (Index i = 0; i < graph_.transitions.size(); ++i) {
      const auto& states = graph_.transitions[i].states;
      if (states.size() != 2) continue;
      std::pair<Index, Index> cells{links_.cell_of(states[0].target),
                                    links_.cell_of(states[1].target)};
      if (cells.first > cells.second) std::swap(cells.first, cells.second);
      if (cells.second == kNone || cells.first == cells.second) continue;
      if (!known.insert(cells).second) continue;
      neighbours_.push_back({cells.first, cells.second});
      transitions_.push_back(i);
    }
  }

  void compare_cells() {
    std::vector<GroupMember> members;
    std::vector<Index> cell_of;
    std::vector<Index> number;  // of the member among the solids of its cell
    for (Index cell = 0; cell < solids_.size(); ++cell) {
      for (Index i = 0; i < solids_[cell].size(); ++i) {
        if (solids_[cell][i] == nullptr) continue;
        members.push_back({solids_[cell][i], nullptr, element_name(graph_.cells[cell])});
        cell_of.push_back(cell);
        number.push_back(i);
      }
      if (!is_valid(cell)) {
        skip(cell, {kCellsOverlap, kAdjacenciesInconsistent},
             "a solid of the cell is not valid and was not compared");
      }
    }
    const GroupReport compared = check_cells(members, cell_of, neighbours_, options_);
    for (const Finding& finding : compared.findings) {
      const auto side = [&](const Place& place) {
        Finding own = finding;
        own.place = place;
        own.place.solid = number[place.solid];
        own.other.reset();
        add(cell_of[place.solid], std::move(own));
      };
      side(finding.place);
      if (finding.other) side(*finding.other);
    }
    if (compared.not_run.empty()) return;
    for (Index cell = 0; cell < solids_.size(); ++cell) {
      if (solids_[cell].empty()) continue;
      GroupReport& report = reports_[cell];
      report.not_run.insert(report.not_run.end(), compared.not_run.begin(), compared.not_run.end());
      if (compared.verdict == Verdict::undecided && report.verdict == Verdict::valid) {
        report.verdict = Verdict::undecided;
      }
    }
  }

  /// 702, for the state of a cell.
  void check_state(Index cell) {
    const Index number = links_.state_of(cell);
    if (number == kNone || solids_[cell].empty()) return;
    const GraphState& state = graph_.states[number];
    const auto give_up = [&](std::string reason) {
      skip(cell, {kDualVertexOutsideCell}, std::move(reason));
    };
    if (is_cancelled()) {
      reports_[cell].verdict = Verdict::undecided;
      return give_up("the comparison was cancelled");
    }
    if (!is_valid(cell)) return give_up("a solid of the cell is not valid");
    const std::string name = std::string("state ").append(element_name(state));
    if (!state.position) {
      return give_up(name + ": " + (state.fault.empty() ? "it has no position" : state.fault));
    }
    const auto point = solid_at(*state.position, solids_[cell].front()->solid().srid());
    bool is_outside = true;
    for (const ValidSolid* solid : solids_[cell]) {
      const auto location = point ? location_in(solid->solid(), *point) : std::nullopt;
      if (!location) {
        if (reports_[cell].verdict == Verdict::valid) {
          reports_[cell].verdict = Verdict::undecided;
        }
        return give_up(name + ": its position and the cell have no exact grid in common");
      }
      is_outside = is_outside && *location == Location::outside;
    }
    if (!is_outside) return;
    Finding finding;
    finding.code = kDualVertexOutsideCell;
    finding.place.solid = 0;
    finding.witness = point->world(0);
    finding.source.line = state.line;
    finding.detail = name + " is outside " + cell_name(cell);
    add(cell, std::move(finding));
  }

  /// 703.
  void check_links() {
    for (LinkFault& fault : links_.faults()) {
      Finding finding;
      finding.code = kXlinksError;
      finding.place.solid = fault.cell == kNone || solids_[fault.cell].empty() ? kNone : 0;
      finding.source.line = fault.line;
      finding.detail = std::move(fault.detail);
      add(fault.cell, std::move(finding));
    }
  }

  /// 704.
  void report_neighbours() {
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      const auto [first, second, contact] = neighbours_[i];
      if (contact == CellContact::unknown || contact == CellContact::allowed ||
          contact == CellContact::area) {
        continue;
      }
      const geometry::GraphTransition& transition = graph_.transitions[transitions_[i]];
      Finding finding;
      finding.code = kAdjacenciesInconsistent;
      if (contact != CellContact::apart) finding.severity = Severity::warning;
      finding.place.solid = 0;
      finding.source.line = transition.line;
      finding.detail.append("transition ").append(element_name(transition));
      finding.detail.append(" joins ").append(cell_name(first));
      finding.detail.append(" and ").append(cell_name(second));
      finding.detail.append(contact == CellContact::at_points
                                ? ", which have only points or edges in common"
                            : contact == CellContact::within_steps
                                ? ", which are apart by a step of the coordinates at most"
                                : ", which do not touch");
      add(first, finding);
      add(second, std::move(finding));
    }
  }

  const CellGraph& graph_;
  std::span<const CellSolids> solids_;
  const GroupOptions& options_;
  IndoorLinks links_;
  std::vector<CellPair> neighbours_;
  std::vector<Index> transitions_;  // one for each pair of neighbours
  std::vector<GroupReport> reports_;
  std::uint64_t found_ = 0;
};

}  // namespace

std::vector<GroupReport> check_indoor_model(const CellGraph& graph,
                                            std::span<const CellSolids> solids,
                                            const GroupOptions& options) {
  return IndoorExaminer(graph, solids, options).run();
}

}  // namespace watertight::validate
