// SPDX-License-Identifier: GPL-3.0-or-later
//
// A triangulated region that follows changes of its loops and of its grid.
//
// Based on: the section "Updates" of the paper on incremental triangulation of trimmed Bezier
// surfaces (region.h). Departure: triangles are kept instead of strips. A change deletes those that
// it may meet, sweeps the gap, and flips edges from there, so that the triangles are those of
// triangulate_trimmed() for the loops and the grid as they are now.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tessellate/trimmed/grid.h"
#include "tessellate/trimmed/region.h"

namespace watertight::tessellate {

/// Points keep their numbers while they exist; the number of one that is removed is used again.
class TrimmedMesh {
 public:
  /// Requires one edge from each point and one to it. After a conflict there are no triangles, and
  /// nothing may be changed. Cost: that of triangulate_trimmed().
  TrimmedMesh(Region loops, PlaneGrid grid);

  /// Why there are no triangles.
  const std::optional<RegionConflict>& conflict() const { return conflict_; }
  /// The points; some may be unused.
  std::span<const Point> points() const { return points_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  /// The loop point after a loop point; kNone for a grid point and for an unused one.
  Index next(Index sample) const { return next_[sample]; }

  /// Puts a point between a loop point and the next one. Returns a conflict, and changes nothing,
  /// exactly if the loops would no longer bound a region. Cost: that of the triangles around, and a
  /// comparison for each other triangle.
  std::optional<RegionConflict> insert_sample(Index before, const Point& place);

  /// Joins the points before and after a loop point. Conflicts and cost as for insert_sample(); a
  /// loop of three points stays as it is (not_closed).
  std::optional<RegionConflict> remove_sample(Index sample);

  /// Adds the line u = at (axis 0) or v = at (axis 1) with its points strictly inside the loops;
  /// false if the grid has it already. Cost: as for insert_sample().
  bool add_grid_line(std::size_t axis, double at);

  /// Removes a line and its points inside the loops; false if the grid has no such line.
  bool remove_grid_line(std::size_t axis, double at);

 private:
  struct Change {
    std::vector<std::uint32_t> triangles;  // that go
    std::vector<Index> coming;             // points, by number
    std::vector<Index> going;              // points
    std::vector<PlaneEdge> new_border;
    std::vector<PlaneEdge> old_border;
    bool is_along_u = false;  // how the gap lies
  };

  Index add_point(const Point& place);
  void free_point(Index point);
  std::vector<double>& lines(std::size_t axis) { return axis == 0 ? grid_.us : grid_.vs; }

  std::optional<RegionConflict> change_loop(Change change, Index before, Index middle, Index after,
                                            bool is_gained);
  bool may_meet(const Triangle& triangle, const std::array<Index, 3>& place) const;
  void add_grid_points(const std::array<Index, 3>& place, Change& change);
  void remove_grid_points(const std::array<Index, 3>& place, Change& change) const;
  void add_line_points(std::size_t axis, double at, std::uint32_t triangle,
                       std::vector<Index>& point_of_line, Change& change);

  // The region of the triangles that go, with points of its own.
  struct Gap {
    Region region;
    std::vector<Index> points;  // their numbers in the mesh
    std::vector<std::uint32_t>
        rim;  // region edge -> edge of the triangle beyond; kNone for borders
  };

  std::optional<RegionConflict> apply(const Change& change);
  Gap gap_of(const Change& change) const;
  void splice(const Change& change, const Gap& gap, std::span<const Triangle> triangles);
  void move_triangle(std::uint32_t from, std::uint32_t to);

  PlaneGrid grid_;
  std::vector<Point> points_;
  std::vector<bool> is_grid_point_;
  std::vector<Index> free_;  // numbers of unused points
  std::vector<Index> next_;
  std::vector<Index> previous_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> twins_;
  std::optional<RegionConflict> conflict_;
};

}  // namespace watertight::tessellate
