// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/trimmed/grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "tessellate/trimmed/plane_predicates.h"

namespace watertight::tessellate {
namespace {

// More than the rounding of a crossing of a loop and a grid line, as a share of the coordinates.
constexpr double kMargin = 1e-12;

enum class Cell : std::uint8_t { outside, inside, touched };

class Gridding {
 public:
  Gridding(Region loops, const PlaneGrid& grid, const Clearance& clearance)
      : us_(grid.us), vs_(grid.vs), clearance_(clearance) {
    result_.region = std::move(loops);
  }

  GridRegion run() {
    if (us_.empty() || vs_.empty()) return std::move(result_);
    rows_.resize(vs_.size());
    cells_.assign(column_count() * row_count(), Cell::outside);
    edge_count_ = result_.region.edges.size();
    for (std::size_t edge = 0; edge < edge_count_; ++edge) mark(edge);
    mark_points();
    for (std::size_t row = 0; row < row_count(); ++row) fill_row(row);
    number_points();
    for (std::size_t row = 0; row < row_count(); ++row) {
      for (std::size_t column = 0; column < column_count(); ++column) add_cell(column, row);
    }
    return std::move(result_);
  }

 private:
  // Cell (j, k) reaches from line j - 1 to line j, and from k - 1 to k: the outer ones have no end.
  std::size_t column_count() const { return us_.size() + 1; }
  std::size_t row_count() const { return vs_.size() + 1; }
  Cell& cell(std::size_t column, std::size_t row) { return cells_[row * column_count() + column]; }

  /// The column or row of a coordinate: the number of lines below it.
  static std::size_t place(const std::vector<double>& lines, double at) {
    return static_cast<std::size_t>(std::lower_bound(lines.begin(), lines.end(), at) -
                                    lines.begin());
  }

  const Point& start(std::size_t edge) const {
    return result_.region.points[result_.region.edges[edge][0]];
  }
  const Point& end(std::size_t edge) const {
    return result_.region.points[result_.region.edges[edge][1]];
  }

  /// Where an edge meets the line v, within rounding.
  double u_at(std::size_t edge, double v) const {
    const Point& a = start(edge);
    const Point& b = end(edge);
    if (a.y == b.y) return a.x;
    const double share = std::clamp((v - a.y) / (b.y - a.y), 0.0, 1.0);
    return a.x + share * (b.x - a.x);
  }

  double reach_of(std::size_t edge) const {
    return clearance_.of_edges.empty() ? 0 : clearance_.of_edges[edge];
  }

  /// Marks the cells that an edge may meet, and lists it with the lines v that it crosses.
  void mark(std::size_t edge) {
    const Point& a = start(edge);
    const Point& b = end(edge);
    const auto [low, high] = std::minmax(a.y, b.y);
    const auto [left, right] = std::minmax(a.x, b.x);
    const double reach = reach_of(edge);
    const double margin =
        reach + kMargin * (std::max(std::abs(left), std::abs(right)) + (us_.back() - us_.front()));
    const double margin_v =
        reach + kMargin * (std::max(std::abs(low), std::abs(high)) + (vs_.back() - vs_.front()));
    const std::size_t first = place(vs_, low - margin_v);
    const std::size_t last = place(vs_, high + margin_v);
    for (std::size_t row = first; row <= last; ++row) {
      const double below = row == 0 ? low : std::max(low, vs_[row - 1] - margin_v);
      const double above = row == vs_.size() ? high : std::min(high, vs_[row] + margin_v);
      auto [from, to] = std::minmax({u_at(edge, below), u_at(edge, above)});
      if (a.y == b.y) {
        from = left;
        to = right;
      }
      for (std::size_t column = place(us_, from - margin); column <= place(us_, to + margin);
           ++column) {
        cell(column, row) = Cell::touched;
      }
      // Lines are crossed by edges with one end below and one not below.
      if (row < vs_.size() && low < vs_[row] && high >= vs_[row]) rows_[row].push_back(edge);
    }
  }

  /// Marks the cells that points without an edge may touch: cells inside have no point but corners.
  void mark_points() {
    std::vector<bool> has_edge(result_.region.points.size(), false);
    for (const auto& [from, to] : result_.region.edges) has_edge[from] = has_edge[to] = true;
    for (std::size_t i = 0; i < has_edge.size(); ++i) {
      if (has_edge[i]) continue;
      const Point& p = result_.region.points[i];
      const auto places = [](const std::vector<double>& lines, double at) {
        const auto [first, last] = std::equal_range(lines.begin(), lines.end(), at);
        return std::pair(first - lines.begin(), last - lines.begin());
      };
      const auto [left, right] = places(us_, p.x);
      const auto [below, above] = places(vs_, p.y);
      for (auto row = below; row <= above; ++row) {
        for (auto column = left; column <= right; ++column) {
          cell(static_cast<std::size_t>(column), static_cast<std::size_t>(row)) = Cell::touched;
        }
      }
    }
  }

  /// Decides which cells of a row that no edge meets are inside. A row without a line below or
  /// above has none.
  void fill_row(std::size_t row) {
    if (row == 0 || row == vs_.size()) return;
    // The edges that cross the upper line of the row, from left to right, each in a touched cell.
    std::vector<std::size_t> crossed(column_count(), 0);
    for (const std::size_t edge : rows_[row]) ++crossed[place(us_, u_at(edge, vs_[row]))];
    std::size_t count = 0;
    for (std::size_t column = 0; column < column_count(); ++column) {
      count += crossed[column];
      Cell& state = cell(column, row);
      if (state == Cell::touched || column == 0 || column == us_.size()) continue;
      state = count % 2 == 1 ? Cell::inside : Cell::outside;
    }
  }

  /// Point (j, k) of the grid has the cells j, j + 1 by k, k + 1 around it.
  std::size_t cells_around(std::size_t j, std::size_t k, Cell state) {
    std::size_t count = 0;
    for (const std::size_t column : {j, j + 1}) {
      for (const std::size_t row : {k, k + 1}) count += cell(column, row) == state ? 1U : 0U;
    }
    return count;
  }

  void number_points() {
    number_.assign(us_.size() * vs_.size(), kNone);
    for (std::size_t k = 0; k < vs_.size(); ++k) {
      for (std::size_t j = 0; j < us_.size(); ++j) {
        const bool is_corner = cells_around(j, k, Cell::inside) > 0;
        const bool may_be_inside = is_corner || cells_around(j, k, Cell::outside) == 0;
        if (!may_be_inside || (!is_corner && !is_inside(j, k))) continue;
        number_[k * us_.size() + j] = static_cast<Index>(result_.region.points.size());
        result_.region.points.push_back({us_[j], vs_[k], 0});
      }
    }
  }

  /// Whether a grid point is strictly inside the loops, exactly, and clear of them.
  bool is_inside(std::size_t j, std::size_t k) const {
    const Point p{us_[j], vs_[k], 0};
    std::size_t count = 0;
    for (const std::size_t edge : rows_[k]) {
      const bool goes_up = start(edge).y < end(edge).y;
      const int side = goes_up ? turn(start(edge), end(edge), p) : turn(end(edge), start(edge), p);
      if (side == 0) return false;
      count += side < 0 ? 1U : 0U;
    }
    if (count % 2 == 0) return false;
    return !is_on_or_near_loop(j, k);
  }

  bool is_on_or_near_loop(std::size_t j, std::size_t k) const {
    const Point p{us_[j], vs_[k], 0};
    const auto reach = [&](const std::vector<double>& lines, std::size_t at) {
      const double before = at > 0 ? lines[at] - lines[at - 1] : lines[at + 1] - lines[at];
      const double after = at + 1 < lines.size() ? lines[at + 1] - lines[at] : before;
      return clearance_.of_cell * std::min(before, after);
    };
    const double cell_u = us_.size() > 1 ? reach(us_, j) : 0;
    const double cell_v = vs_.size() > 1 ? reach(vs_, k) : 0;
    for (std::size_t edge = 0; edge < edge_count_; ++edge) {
      const double reach_u = std::max(cell_u, reach_of(edge));
      const double reach_v = std::max(cell_v, reach_of(edge));
      const Point& a = start(edge);
      const Point& b = end(edge);
      if (std::max(a.y, b.y) < p.y - reach_v || std::min(a.y, b.y) > p.y + reach_v) continue;
      if (std::max(a.x, b.x) < p.x - reach_u || std::min(a.x, b.x) > p.x + reach_u) continue;
      if (turn(a, b, p) == 0) return true;
      if (reach_u > 0 && reach_v > 0 && meets_box(a, b, p, reach_u, reach_v)) return true;
    }
    return false;
  }

  /// Whether a segment meets the box around a point, within rounding.
  static bool meets_box(const Point& a, const Point& b, const Point& p, double reach_u,
                        double reach_v) {
    double from = 0;
    double to = 1;
    for (const int axis : {0, 1}) {
      const double reach = axis == 0 ? reach_u : reach_v;
      const double step = b[axis] - a[axis];
      if (step == 0) continue;
      const double one = (p[axis] - reach - a[axis]) / step;
      const double other = (p[axis] + reach - a[axis]) / step;
      from = std::max(from, std::min(one, other));
      to = std::min(to, std::max(one, other));
    }
    return from <= to;
  }

  /// Adds the triangles of a cell that is inside, and its sides that other cells do not share.
  void add_cell(std::size_t column, std::size_t row) {
    if (cell(column, row) != Cell::inside) return;
    const auto corner = [&](std::size_t j, std::size_t k) { return number_[k * us_.size() + j]; };
    const std::array<Index, 4> corners{corner(column - 1, row - 1), corner(column, row - 1),
                                       corner(column, row), corner(column - 1, row)};
    result_.cells.push_back({corners[0], corners[1], corners[2]});
    result_.cells.push_back({corners[0], corners[2], corners[3]});
    const std::array<Cell, 4> beside{cell(column, row - 1), cell(column + 1, row),
                                     cell(column, row + 1), cell(column - 1, row)};
    for (std::size_t side = 0; side < 4; ++side) {
      if (beside[side] == Cell::inside) continue;
      result_.region.edges.push_back({corners[(side + 1) % 4], corners[side]});
    }
  }

  const std::vector<double>& us_;
  const std::vector<double>& vs_;
  const Clearance& clearance_;
  std::size_t edge_count_ = 0;  // of the loops
  std::vector<Cell> cells_;
  std::vector<std::vector<std::size_t>> rows_;  // line v -> edges that cross it
  std::vector<Index> number_;                   // grid point -> vertex
  GridRegion result_;
};

}  // namespace

GridRegion region_with_grid(Region loops, const PlaneGrid& grid, const Clearance& clearance) {
  return Gridding(std::move(loops), grid, clearance).run();
}

namespace {

/// How many coordinates differ, apart from rounding.
std::size_t distinct_count(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double least = kMargin * (values.back() - values.front());
  std::size_t count = 1;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] - values[i - 1] > least) ++count;
  }
  return count;
}

/// Sweeps along the direction in which more coordinates differ: between two rows of points the
/// triangles then alternate from the start, and few edges have to be flipped.
RegionTriangles sweep_along_longer(Region region) {
  std::vector<double> us;
  std::vector<double> vs;
  for (const Point& p : region.points) {
    us.push_back(p.x);
    vs.push_back(p.y);
  }
  if (distinct_count(std::move(us)) <= distinct_count(std::move(vs))) return sweep_region(region);
  return sweep_region_from_left(std::move(region));
}

}  // namespace

TrimmedTriangles triangulate_trimmed(Region loops, const PlaneGrid& grid,
                                     const Clearance& clearance) {
  GridRegion gridded = region_with_grid(std::move(loops), grid, clearance);
  // Corners of cells between four cells that are inside have no edge, and are no part of the rest.
  TrimmedTriangles result;
  std::vector<Index> swept;
  std::vector<Index> number(gridded.region.points.size(), kNone);
  std::vector<bool> is_used(gridded.region.points.size(), true);
  for (const Triangle& triangle : gridded.cells) {
    for (const Index corner : triangle) is_used[corner] = false;
  }
  for (const PlaneEdge& edge : gridded.region.edges) is_used[edge[0]] = is_used[edge[1]] = true;
  Region rest;
  for (Index i = 0; i < gridded.region.points.size(); ++i) {
    if (!is_used[i]) continue;
    number[i] = static_cast<Index>(swept.size());
    swept.push_back(i);
    rest.points.push_back(gridded.region.points[i]);
  }
  for (const auto& [from, to] : gridded.region.edges) {
    rest.edges.push_back({number[from], number[to]});
  }
  RegionTriangles triangles = sweep_along_longer(std::move(rest));
  result.points = std::move(gridded.region.points);
  if (triangles.conflict) {
    for (PlaneEdge* edge : {&triangles.conflict->first, &triangles.conflict->second}) {
      for (Index& end : *edge) end = end == kNone ? kNone : swept[end];
    }
    result.conflict = triangles.conflict;
    return result;
  }
  result.triangles = std::move(gridded.cells);
  for (Triangle triangle : triangles.triangles) {
    for (Index& corner : triangle) corner = swept[corner];
    result.triangles.push_back(triangle);
  }
  flip_to_delaunay(result.points, result.triangles);
  return result;
}

}  // namespace watertight::tessellate
