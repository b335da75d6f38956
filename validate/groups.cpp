// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "geometry/crs/crs.h"
#include "geometry/disjoint_sets.h"
#include "geometry/lattice/shared_grid.h"
#include "tessellate/facets.h"
#include "validate/finding_kinds.h"
#include "validate/overlap/gap.h"
#include "validate/overlap/solid_overlap.h"

namespace watertight::validate {
namespace {

using Pair = std::pair<Index, Index>;

/// The largest number of members that a reason names; others are only counted.
constexpr std::size_t kMostNamed = 8;
/// The largest numbers of pairs of overlapping boxes, and of tests of boxes to find them.
constexpr std::size_t kMostPairs = 10'000'000;
/// The largest number of pairs of members that are compared as neighbours.
constexpr std::size_t kMostNeighbours = 1'000'000;
constexpr std::uint64_t kMostLooks = 2'000'000'000;

/// The distance, in steps of the grid, by which rounded vertices are assumed to be wrong. Rounding
/// moves them by half a step along each axis; distances are computed in doubles.
constexpr double kRoundedSteps = 16;
/// A bound of the relative rounding error of placed vertices in the world, for their boxes.
constexpr double kPlaceError = 1e-14;

/// A bound of the relative rounding error of a depth.
constexpr double kDepthError = 1e-9;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A common grid of two members or of all.
struct GroupGrid {
  geometry::SharedGrid grid;
  StepMetres step_metres{};
};

/// Two members that are compared, and their surfaces on a common grid.
struct ComparedPair {
  Index first = kNone;
  Index second = kNone;
  const GroupGrid* grid = nullptr;
  const SolidSurface* first_surface = nullptr;
  const SolidSurface* second_surface = nullptr;
  double rounding = 0;  // the metres by which vertices may be wrong
};

class GroupExaminer {
 public:
  GroupExaminer(std::span<const GroupMember> members, GroupKind kind, const GroupOptions& options,
                std::span<const Index> unit_of)
      : members_(members),
        unit_of_(unit_of),
        kind_(kind),
        options_(options),
        boxes_(members.size()),
        surfaces_(members.size()),
        connected_(members.size()) {}

  /// Members of the two units of each of `neighbours` are compared too; see check_cells().
  GroupReport run(std::span<CellPair> neighbours = {});

 private:
  bool is_composite() const { return kind_ == GroupKind::composite_solid; }
  int overlap_code() const {
    if (is_composite()) return kIntersectionSolids;
    return kind_ == GroupKind::indoor_cells ? kCellsOverlap : kBuildingPartsOverlap;
  }
  std::string_view noun() const {
    if (is_composite()) return "member";
    return kind_ == GroupKind::indoor_cells ? "cell" : "solid";
  }
  std::vector<int> codes() const {
    if (kind_ == GroupKind::indoor_cells) return {kCellsOverlap, kAdjacenciesInconsistent};
    if (!is_composite()) return {kBuildingPartsOverlap};
    return {kIntersectionSolids, kDuplicatedSolids, kDisconnectedSolids};
  }
  void skip(std::vector<int> codes, std::string reason) {
    report_.not_run.push_back({std::move(codes), std::move(reason)});
  }
  void give_up(std::string reason) {
    skip(codes(), std::move(reason));
    report_.verdict = Verdict::undecided;
  }
  void name_invalid_members();
  bool find_grid();
  void find_boxes();
  GroupGrid group_grid(geometry::SharedGrid grid) const;
  geometry::StandingSolid standing(Index member) const {
    return {&members_[member].solid->solid(), members_[member].placement};
  }
  std::uint32_t srid(Index member) const;
  std::optional<std::vector<Pair>> pairs() const;
  bool may_meet(Index a, Index b) const;
  std::unique_ptr<SolidSurface> surface(Index member, const geometry::SharedGrid& grid,
                                        std::size_t number) const;
  const SolidSurface* kept_surface(Index member);
  bool compare(const Pair& pair);
  bool compare_apart(const Pair& pair);
  bool compare(const ComparedPair& pair);
  void report_overlap(const ComparedPair& pair, const SolidRelation& relation);
  void check_connected();
  bool find_neighbours(std::span<CellPair> neighbours);
  bool compare_neighbours(const std::vector<Pair>& compared);
  void note_contact(const ComparedPair& pair, const SolidRelation& relation);
  Place place(Index member, Index facet) const;
  std::string named(Index member) const;
  std::string overlap_detail(const Pair& pair, const SolidRelation& relation) const;
  double step(Index member, const GroupGrid& grid) const;

  std::span<const GroupMember> members_;
  std::span<const Index> unit_of_;
  GroupKind kind_;
  const GroupOptions& options_;
  std::vector<Index> present_;     // the valid members, ascending
  std::vector<Index> number_;      // member -> its index in present_, or kNone
  std::optional<GroupGrid> grid_;  // the grid of all members; none if their placements differ
  std::vector<Box> boxes_;         // member -> a box that contains it
  std::vector<std::unique_ptr<SolidSurface>> surfaces_;
  geometry::DisjointSets connected_;
  std::vector<Finding> duplicates_;
  std::map<Pair, CellPair*> neighbours_;  // by the members that are compared
  GroupReport report_;
};

void GroupExaminer::name_invalid_members() {
  std::string list;
  std::size_t count = 0;
  for (Index i = 0; i < members_.size(); ++i) {
    number_.push_back(members_[i].solid != nullptr ? static_cast<Index>(present_.size()) : kNone);
    if (members_[i].solid != nullptr) {
      present_.push_back(i);
    } else if (++count <= kMostNamed) {
      if (count > 1) list += ", ";
      list += std::to_string(i);
    }
  }
  if (count == 0) return;
  if (count > kMostNamed) {
    list += " and ";
    list += std::to_string(count - kMostNamed);
    list += " more";
  }
  std::string reason(noun());
  reason += count == 1 ? " " : "s ";
  reason += list;
  reason +=
      count == 1 ? " is not valid and was not compared" : " are not valid and were not compared";
  skip(codes(), std::move(reason));
}

std::uint32_t GroupExaminer::srid(Index member) const {
  const GroupMember& own = members_[member];
  return own.placement != nullptr ? own.placement->srid : own.solid->solid().srid();
}

bool GroupExaminer::find_grid() {
  std::vector<geometry::StandingSolid> solids;
  for (const Index i : present_) {
    if (srid(i) != srid(present_.front())) {
      give_up("the solids are in different coordinate reference systems");
      return false;
    }
    solids.push_back(standing(i));
  }
  if (auto grid = geometry::SharedGrid::of_one_placement(std::move(solids)))
    grid_ = group_grid(*std::move(grid));
  if (!grid_ && is_composite()) {
    give_up("the coordinates of the solids have no exact grid in common");
    return false;
  }
  find_boxes();
  return true;
}

/// Finds the boxes of the members: on the common grid if there is one, else in the world with a
/// margin for the rounding of coordinates.
void GroupExaminer::find_boxes() {
  for (const Index i : present_) {
    if (grid_) {
      boxes_[i] = grid_->grid.box(number_[i]);
      continue;
    }
    const auto [solid, placement] = standing(i);
    for (Index v = 0; v < solid->vertex_count(); ++v) {
      std::array<double, 3> p = solid->world(v);
      double size = std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]);
      if (placement != nullptr) {
        double factor = 0;
        for (const auto& row : geometry::linear_part(*placement)) {
          for (const double entry : row) factor = std::max(factor, std::abs(entry));
        }
        size *= factor;
        for (const double part : geometry::shift_of(*placement)) size += std::abs(part);
        p = watertight::geometry::place(*placement, p);
      }
      const bool is_finite = std::isfinite(size) && std::isfinite(p[0] + p[1] + p[2]);
      const double margin = is_finite ? kPlaceError * size : kInfinity;
      if (!is_finite) p = {};
      boxes_[i].include({p[0] - margin, p[1] - margin, p[2] - margin});
      boxes_[i].include({p[0] + margin, p[1] + margin, p[2] + margin});
    }
  }
}

GroupGrid GroupExaminer::group_grid(geometry::SharedGrid grid) const {
  Box all;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    all.include(grid.box(i).min);
    all.include(grid.box(i).max);
  }
  const Lattice& lattice = grid.lattice();
  const std::array<double, 3> low = lattice.world(all.min);
  const std::array<double, 3> high = lattice.world(all.max);
  std::array<double, 3> centre{};
  for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = low[axis] / 2 + high[axis] / 2;
  const geometry::Placement* placement = grid.placement();
  if (placement != nullptr) centre = geometry::shift_of(*placement);
  const geometry::AxisUnits units = geometry::axis_units(srid(present_.front()), centre);
  const auto linear =
      geometry::linear_part(placement != nullptr ? *placement : geometry::Placement{});
  GroupGrid result{std::move(grid)};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double scale = result.grid.lattice().scale(static_cast<int>(axis));
      result.step_metres[row][axis] = scale * units.metres_per_unit[row] * linear[row][axis];
    }
  }
  return result;
}

/// True if the boxes of two members share a point (composite solids, where contact matters) or have
/// insides in common (building parts).
bool GroupExaminer::may_meet(Index a, Index b) const {
  if (!unit_of_.empty() && unit_of_[a] == unit_of_[b]) return false;
  if (is_composite()) return boxes_[a].overlaps(boxes_[b]);
  for (int axis = 0; axis < 3; ++axis) {
    if (boxes_[a].min[axis] >= boxes_[b].max[axis] || boxes_[b].min[axis] >= boxes_[a].max[axis])
      return false;
  }
  return true;
}

/// The pairs of members that may meet, found by a sweep along the longest axis; ordered by first,
/// then second member. Nothing if there are too many pairs.
std::optional<std::vector<Pair>> GroupExaminer::pairs() const {
  Box all;
  for (const Index i : present_) {
    all.include(boxes_[i].min);
    all.include(boxes_[i].max);
  }
  int along = 0;
  const auto length = [&](int axis) {
    double metres = grid_ ? 0 : 1;
    if (grid_) {
      for (const auto& row : grid_->step_metres) {
        metres += std::abs(row[static_cast<std::size_t>(axis)]);
      }
    }
    return (all.max[axis] - all.min[axis]) * metres;
  };
  for (const int axis : {1, 2}) {
    if (length(axis) > length(along)) along = axis;
  }
  std::vector<Index> order = present_;
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::pair(boxes_[a].min[along], a) < std::pair(boxes_[b].min[along], b);
  });
  std::vector<Pair> pairs;
  std::vector<Index> active;
  std::uint64_t looks = 0;
  for (const Index i : order) {
    std::erase_if(active, [&](Index a) { return boxes_[a].max[along] < boxes_[i].min[along]; });
    for (const Index other : active) {
      if (may_meet(i, other)) pairs.emplace_back(std::min(i, other), std::max(i, other));
    }
    active.push_back(i);
    looks += active.size();
    if (looks > kMostLooks || pairs.size() > kMostPairs) return std::nullopt;
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// The surface of a member on a grid; null if the grid cannot hold the solid.
std::unique_ptr<SolidSurface> GroupExaminer::surface(Index member, const geometry::SharedGrid& grid,
                                                     std::size_t number) const {
  const Solid& solid = members_[member].solid->solid();
  const auto points = grid.vertices(number);
  if (!points) return nullptr;
  tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  if (grid.is_turned_over(number)) {
    for (Triangle& t : facets.triangles) std::swap(t[1], t[2]);
  }
  return std::make_unique<SolidSurface>(solid, *points, facets);
}

/// The surface of a member on the grid of all members, made at the first call for this member.
const SolidSurface* GroupExaminer::kept_surface(Index member) {
  if (!surfaces_[member]) surfaces_[member] = surface(member, grid_->grid, number_[member]);
  return surfaces_[member].get();
}

Place GroupExaminer::place(Index member, Index facet) const {
  Place place;
  place.solid = member;
  if (facet != kNone) {
    place.facet = facet;
    place.shell = members_[member].solid->solid().shell_of(facet);
  }
  return place;
}

std::string GroupExaminer::named(Index member) const {
  std::string name(noun());
  name += ' ';
  name += members_[member].name.empty() ? std::to_string(member) : members_[member].name;
  return name;
}

std::string GroupExaminer::overlap_detail(const Pair& pair, const SolidRelation& relation) const {
  std::string detail;
  if (relation.are_equal) {
    detail += named(pair.first);
    detail += " and ";
    detail += named(pair.second);
    detail += " are the same points";
  } else if (relation.facet != kNone && relation.other_facet != kNone) {
    detail += "the interiors of ";
    detail += named(pair.first);
    detail += " and ";
    detail += named(pair.second);
    detail += " overlap";
  } else {
    const bool is_first = relation.facet != kNone;
    detail += "facet ";
    detail += std::to_string(is_first ? relation.facet : relation.other_facet);
    detail += " of ";
    detail += named(is_first ? pair.first : pair.second);
    detail += " lies inside ";
    detail += named(is_first ? pair.second : pair.first);
  }
  return detail;
}

/// The largest step of the coordinates of a member, metres; 0 when it has none.
double GroupExaminer::step(Index member, const GroupGrid& grid) const {
  if (members_[member].placement != nullptr) return 0;
  const geometry::Lattice& own = members_[member].solid->solid().lattice();
  if (own.kind == geometry::LatticeKind::float64) return 0;
  double metres = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto row = static_cast<std::size_t>(axis);
    const double steps = own.scale(axis) / grid.grid.lattice().scale(axis);
    metres = std::max(metres, steps * std::abs(grid.step_metres[row][row]));
  }
  return std::min(metres, kCoarsestStep);
}

void GroupExaminer::report_overlap(const ComparedPair& compared, const SolidRelation& relation) {
  const Pair pair{compared.first, compared.second};
  const bool is_duplicate = relation.are_equal && is_composite();
  const OverlapExtent extent =
      measure_overlap(compared.first_surface->boundary(), compared.second_surface->boundary(),
                      compared.grid->step_metres);
  const bool is_allowed = extent.depth > 0 && extent.depth <= options_.overlap_metres;
  if (is_allowed && !is_duplicate) return;
  const double least_step =
      std::min(step(pair.first, *compared.grid), step(pair.second, *compared.grid));
  const bool is_below_steps = options_.do_steps_warn && !is_duplicate && extent.depth > 0 &&
                              extent.depth <= least_step * (1 + kDepthError);
  if (!is_below_steps) report_.verdict = Verdict::invalid;
  Finding finding;
  if (is_below_steps) finding.severity = Severity::warning;
  finding.code = is_duplicate ? kDuplicatedSolids : overlap_code();
  finding.place = place(pair.first, is_duplicate ? kNone : relation.facet);
  finding.other = place(pair.second, is_duplicate ? kNone : relation.other_facet);
  if (extent.witness) finding.witness = compared.grid->grid.world(*extent.witness);
  if (!is_duplicate) {
    finding.measured = extent.depth;
    finding.limit = is_below_steps ? least_step : options_.overlap_metres;
    finding.unit = std::string("m");
  }
  finding.detail = overlap_detail(pair, relation);
  if (is_below_steps) finding.detail += ", no deeper than a step of the coordinates";
  (is_duplicate ? duplicates_ : report_.findings).push_back(std::move(finding));
}

/// Compares two members. False if no more pairs are to be compared.
bool GroupExaminer::compare(const Pair& pair) {
  if (options_.cancel && options_.cancel()) {
    give_up("the comparison was cancelled");
    return false;
  }
  if (!grid_) return compare_apart(pair);
  return compare(ComparedPair{pair.first, pair.second, &*grid_, kept_surface(pair.first),
                              kept_surface(pair.second)});
}

/// Compares two members on a grid of their own.
bool GroupExaminer::compare_apart(const Pair& pair) {
  const std::vector<geometry::StandingSolid> both{standing(pair.first), standing(pair.second)};
  auto found = geometry::SharedGrid::of_one_placement(both);
  if (!found) found = geometry::SharedGrid::in_world(both);
  if (!found) return compare(ComparedPair{pair.first, pair.second});
  const GroupGrid grid = group_grid(*std::move(found));
  const auto first = surface(pair.first, grid.grid, 0);
  const auto second = surface(pair.second, grid.grid, 1);
  double rounding = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!grid.grid.rounded_axes(0)[axis] && !grid.grid.rounded_axes(1)[axis]) continue;
    rounding = std::max(rounding, kRoundedSteps * grid.step_metres[axis][axis]);
  }
  const bool may_round = both[0].placement != nullptr || both[1].placement != nullptr;
  if (rounding > 0 && !may_round) return compare(ComparedPair{pair.first, pair.second});
  return compare(ComparedPair{pair.first, pair.second, &grid, first.get(), second.get(), rounding});
}

bool GroupExaminer::compare(const ComparedPair& pair) {
  if (pair.first_surface == nullptr || pair.second_surface == nullptr) {
    give_up("the coordinates of the solids have no exact grid in common");
    return false;
  }
  SolidRelation relation = relate(*pair.first_surface, *pair.second_surface, options_.cancel);
  if (relation.is_cancelled) {
    give_up("the comparison was cancelled");
    return false;
  }
  if (relation.do_overlap && pair.rounding > 0 && !relation.are_equal) {
    relation.do_overlap =
        is_overlap_certain(pair.first_surface->boundary(), pair.second_surface->boundary(),
                           pair.grid->step_metres, pair.rounding);
  }
  if (relation.do_overlap) report_overlap(pair, relation);
  note_contact(pair, relation);
  if (relation.do_overlap || relation.share_area) connected_.join(pair.first, pair.second);
  return true;
}

void GroupExaminer::check_connected() {
  std::vector<Index> first;  // the first member of each part is its root
  for (const Index i : present_) {
    if (connected_.root(i) == i) first.push_back(i);
  }
  for (std::size_t part = 1; part < first.size(); ++part) {
    report_.verdict = Verdict::invalid;
    Finding finding;
    finding.code = kDisconnectedSolids;
    finding.place = place(first[part], kNone);
    finding.other = place(first[0], kNone);
    const GroupMember& member = members_[first[part]];
    finding.witness = member.solid->solid().world(0);
    if (member.placement != nullptr)
      finding.witness = watertight::geometry::place(*member.placement, *finding.witness);
    finding.measured = static_cast<double>(first.size());
    finding.limit = 1;
    finding.unit = "parts";
    finding.detail = "no facets connect ";
    finding.detail += named(first[part]);
    finding.detail += " with ";
    finding.detail += named(first[0]);
    report_.findings.push_back(std::move(finding));
  }
}

/// Names the pairs of members that stand for neighbours. False if there are too many.
bool GroupExaminer::find_neighbours(std::span<CellPair> neighbours) {
  const auto members_of = [&](Index unit) {
    const auto [begin, end] = std::equal_range(unit_of_.begin(), unit_of_.end(), unit);
    return IndexRange{static_cast<Index>(begin - unit_of_.begin()),
                      static_cast<Index>(end - unit_of_.begin())};
  };
  for (CellPair& pair : neighbours) {
    const IndexRange first = members_of(pair.first);
    const IndexRange second = members_of(pair.second);
    for (Index a = first.begin; a < first.end; ++a) {
      for (Index b = second.begin; b < second.end; ++b) {
        if (neighbours_.size() >= kMostNeighbours) return false;
        neighbours_.emplace(std::minmax(a, b), &pair);
      }
    }
  }
  return true;
}

/// Compares the neighbours that are not among the pairs compared before. False if the comparison
/// ended early.
bool GroupExaminer::compare_neighbours(const std::vector<Pair>& compared) {
  for (const auto& [pair, neighbours] : neighbours_) {
    if (std::binary_search(compared.begin(), compared.end(), pair)) continue;
    if (!compare(pair)) return false;
  }
  return true;
}

void GroupExaminer::note_contact(const ComparedPair& pair, const SolidRelation& relation) {
  const auto found = neighbours_.find(Pair{pair.first, pair.second});
  if (found == neighbours_.end()) return;
  const RegionSurface& first = pair.first_surface->boundary();
  const RegionSurface& second = pair.second_surface->boundary();
  const auto are_near = [&](double metres) {
    return metres > 0 && is_gap_at_most(first, second, pair.grid->step_metres, metres);
  };
  const auto least_step = [&] {
    return std::min(step(pair.first, *pair.grid), step(pair.second, *pair.grid));
  };
  CellContact contact = CellContact::apart;
  if (relation.do_overlap || relation.share_area) {
    contact = CellContact::area;
  } else if (are_near(options_.overlap_metres)) {
    contact = CellContact::allowed;
  } else if (do_touch(first, second)) {
    contact = CellContact::at_points;
  } else if (options_.do_steps_warn && are_near(least_step() * (1 + kDepthError))) {
    contact = CellContact::within_steps;
  }
  found->second->contact = std::max(found->second->contact, contact);
}

GroupReport GroupExaminer::run(std::span<CellPair> neighbours) {
  name_invalid_members();
  if (present_.size() < 2 || !find_grid()) return std::move(report_);
  const auto candidates = pairs();
  if (!candidates) {
    give_up("there are too many solids whose boxes overlap");
    return std::move(report_);
  }
  // Before any pair is compared, since that is when contacts are noted.
  const bool are_neighbours_known = find_neighbours(neighbours);
  bool is_complete = true;
  const std::uint64_t most = std::max<std::uint64_t>(options_.limits.findings, 1);
  for (const Pair& pair : *candidates) {
    if (report_.findings.size() + duplicates_.size() >= most) {
      skip(codes(),
           "only the pairs up to the last reported one were compared: there are more "
           "findings than are kept");
      is_complete = false;
      break;
    }
    if (!compare(pair)) {
      is_complete = false;
      break;
    }
  }
  if (is_complete && !are_neighbours_known) {
    skip({kAdjacenciesInconsistent}, "there are too many pairs of solids of neighbours");
    is_complete = false;
  }
  if (is_complete) is_complete = compare_neighbours(*candidates);
  report_.findings.insert(report_.findings.end(), std::make_move_iterator(duplicates_.begin()),
                          std::make_move_iterator(duplicates_.end()));
  if (is_composite() && is_complete && present_.size() == members_.size()) {
    if (report_.findings.empty()) {
      check_connected();
    } else {
      skip({kDisconnectedSolids}, "members overlap or are the same");
    }
  }
  if (report_.findings.size() > options_.limits.findings) {
    report_.findings_omitted = report_.findings.size() - options_.limits.findings;
    report_.findings.resize(options_.limits.findings);
  }
  return std::move(report_);
}

}  // namespace

GroupReport check_cells(std::span<const GroupMember> members, std::span<const Index> unit_of,
                        std::span<CellPair> neighbours, const GroupOptions& options) {
  return GroupExaminer(members, GroupKind::indoor_cells, options, unit_of).run(neighbours);
}

GroupReport check_group(std::span<const GroupMember> members, GroupKind kind,
                        const GroupOptions& options, std::span<const Index> unit_of) {
  return GroupExaminer(members, kind, options, unit_of).run();
}

}  // namespace watertight::validate
