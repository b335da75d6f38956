// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arrangement of segments and points in one plane: edges that meet in end points only, and the
// regions between them. It is a part of arrangement.h.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "bench/verdict/exact.h"

namespace watertight::verdict {

/// Points with numbers; equal points have one number.
class PointTable {
 public:
  std::size_t number_of(const Vector& p);
  const Vector& operator[](std::size_t point) const { return points_[point]; }
  /// The point in doubles, off by some units in the last place.
  const Point& near(std::size_t point) const { return near_[point]; }
  const std::vector<Vector>& points() const { return points_; }

 private:
  std::map<Vector, std::size_t> numbers_;
  std::vector<Vector> points_;
  std::vector<Point> near_;
};

using Segment = std::array<std::size_t, 2>;  // the numbers of the ends, the smaller first

inline constexpr std::size_t kUnbounded = static_cast<std::size_t>(-1);

class PlaneArrangement {
 public:
  /// Arranges segments and points of one plane, which is not parallel to `axis`; the coordinate
  /// `axis` is ignored. New points are added to the table.
  PlaneArrangement(PointTable& table, int axis, const std::set<Segment>& segments,
                   const std::set<std::size_t>& points);

  struct HalfEdge {
    std::size_t from = 0;
    std::size_t to = 0;
    std::size_t next = 0;    // the next half-edge along the region to the left
    std::size_t region = 0;  // the region to the left, or kUnbounded
  };
  /// The half-edges; the two of an edge follow each other.
  const std::vector<HalfEdge>& half_edges() const { return half_edges_; }
  std::size_t region_count() const { return region_count_; }
  /// The points without an edge, each with its region.
  const std::vector<std::array<std::size_t, 2>>& lone_points() const { return lone_points_; }
  /// A point of a region; its ignored coordinate is 0. Requires region < region_count().
  Vector sample(std::size_t region) const;

 private:
  Number turn(const Vector& a, const Vector& b, const Vector& c) const;
  bool is_between(const Vector& p, const Vector& a, const Vector& b) const;
  bool may_meet(const Segment& a, const Segment& b) const;
  bool is_before(const Vector& a, const Vector& b) const;
  bool is_angle_before(std::size_t half_edge, std::size_t other) const;
  void split(const std::set<Segment>& segments, const std::set<std::size_t>& points);
  void note_meeting(const Segment& a, const Segment& b, std::set<std::size_t>& on_a,
                    std::set<std::size_t>& on_b);
  void link();
  void find_regions();
  std::vector<std::size_t> find_cycles();
  Number area(std::size_t half_edge) const;
  std::size_t cycle_left_of(std::size_t point) const;
  void place_lone_points(const std::vector<std::size_t>& region_of,
                         const std::set<std::size_t>& points);

  PointTable& table_;
  int u_;  // u_ and v_ are the coordinates that are not ignored
  int v_;
  std::vector<HalfEdge> half_edges_;
  std::vector<std::size_t> cycle_of_;   // for each half-edge, its cycle
  std::vector<std::size_t> first_of_;   // for each region, a half-edge of its outer boundary
  std::vector<std::size_t> region_of_;  // for each cycle, its region
  std::vector<std::array<std::size_t, 2>> lone_points_;
  std::size_t region_count_ = 0;
};

}  // namespace watertight::verdict
