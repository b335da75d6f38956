// SPDX-License-Identifier: GPL-3.0-or-later
//
// How two valid solids lie to each other: whether their interiors meet, whether they are the same
// points, whether they share an area of their boundaries. Exact, by orientation predicates and
// point location on the triangles of the boundaries. Internal to validate/.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/ladder.h"
#include "geometry/point.h"
#include "validate/box_tree.h"
#include "validate/point_location.h"

namespace watertight {

/// The boundary of a valid solid as triangles, turned outward, on a grid that it shares with the
/// solids it is compared with. Move only: the trees refer to the arrays.
class SolidSurface {
 public:
  SolidSurface(std::vector<Point> vertices, std::vector<Triangle> triangles,
               std::vector<Index> facet_of);
  SolidSurface(SolidSurface&&) = default;
  SolidSurface& operator=(SolidSurface&&) = default;
  SolidSurface(const SolidSurface&) = delete;
  SolidSurface& operator=(const SolidSurface&) = delete;

  std::span<const Point> vertices() const { return vertices_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  Index facet_of(Index triangle) const { return facet_of_[triangle]; }
  const Box& box() const { return box_; }
  Location locate(const Point& p) const { return locator_.locate(p); }
  std::array<Point, 3> corners(Index triangle) const {
    const Triangle& t = triangles_[triangle];
    return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
  }
  /// Triangles whose boxes meet a closed box, ascending.
  std::vector<Index> triangles_in(const Box& box) const;

 private:
  std::vector<Point> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Index> facet_of_;
  Box box_;
  BoxTree tree_;
  PointLocator locator_;
};

struct SolidRelation {
  bool is_cancelled = false;  // nothing else is known
  bool do_overlap = false;    // the interiors have a point in common
  bool are_equal = false;     // the same points
  bool share_area = false;    // facets lie on each other back to back; unless do_overlap
  Index facet = kNone;        // of the first solid, that shows the overlap
  Index other_facet = kNone;  // of the second; kNone when no facet of it is concerned
};

/// Deterministic. Cost: near linear in the triangles inside the overlap of the boxes; the product
/// of their numbers when all of them meet.
SolidRelation relate(const SolidSurface& first, const SolidSurface& second,
                     const CancelPoll& cancel);

/// How far an overlap reaches, in the unit of `metres_per_step`, and a point of it.
struct OverlapExtent {
  /// Each part of the overlap that hangs together lies between two parallel planes no further
  /// apart than this.
  double depth = 0;
  std::optional<Point> witness;  // inside both solids, exactly
};

/// Requires solids that overlap. The depth is the largest over the parts of the least extent along
/// the axes and the normals of the facets that bound the part: measured in doubles.
OverlapExtent measure_overlap(const SolidSurface& first, const SolidSurface& second,
                              const std::array<double, 3>& metres_per_step);

}  // namespace watertight
