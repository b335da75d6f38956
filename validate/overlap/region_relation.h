// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides how two regions, each bounded by one shell, lie to each other: whether their insides
// meet, whether one contains the other, whether their boundaries share an area. The answers are
// exact, by orientation predicates and point location on the triangles of the boundaries. For
// cavities in their solid and for solids of a group. Internal to validate/.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "geometry/point.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"
#include "validate/overlap/box_tree.h"
#include "validate/overlap/point_location.h"

namespace watertight::validate {

/// A closed surface as triangles, turned outward. The class cannot be copied, because its trees
/// refer to its arrays.
class RegionSurface {
 public:
  RegionSurface(std::vector<Point> vertices, std::vector<Triangle> triangles,
                std::vector<Index> facet_of);
  RegionSurface(RegionSurface&&) = default;
  RegionSurface& operator=(RegionSurface&&) = default;
  RegionSurface(const RegionSurface&) = delete;
  RegionSurface& operator=(const RegionSurface&) = delete;

  std::span<const Point> vertices() const { return vertices_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  Index facet_of(Index triangle) const { return facet_of_[triangle]; }
  const Box& box() const { return box_; }
  Location locate(const Point& p) const { return locator_.locate(p); }
  std::array<Point, 3> corners(Index triangle) const {
    const Triangle& t = triangles_[triangle];
    return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
  }
  /// The triangles whose boxes meet a closed box, ascending.
  std::vector<Index> triangles_in(const Box& box) const;

 private:
  std::vector<Point> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Index> facet_of_;
  Box box_;
  BoxTree tree_;
  PointLocator locator_;
};

/// The surface of the shells [begin, end) of a solid, with the vertices that they use. `vertices`
/// are the vertices of the solid on any grid; `is_turned_over` turns an interior shell outward.
RegionSurface surface_of_shells(const Solid& solid, std::span<const Point> vertices,
                                const tessellate::FacetTriangles& facets, IndexRange shells,
                                bool is_turned_over);

/// True if no point of the inner closed box is outside the outer one.
bool contains(const Box& outer, const Box& inner);

/// Questions in addition to whether the insides meet. Each answer costs time.
struct RegionQuestions {
  bool is_first_inside = false;
  bool is_second_inside = false;
};

struct RegionRelation {
  bool is_cancelled = false;        // true: the other members say nothing
  bool do_overlap = false;          // the insides have a point in common
  bool is_first_inside = false;     // if asked: no point of the first is outside the second
  bool is_second_inside = false;    // if asked: no point of the second is outside the first
  bool touch_back_to_back = false;  // triangles share an area, turned against each other
  bool touch_side_by_side = false;  // triangles share an area, turned alike
  std::uint64_t looks = 0;          // the work: the triangles in the common box plus comparisons
  Index facet = kNone;              // a facet of the first that shows the overlap, or kNone
  Index other_facet = kNone;        // a facet of the second that shows the overlap, or kNone
};

/// The relation of two regions. Requires that each surface is one closed 2-manifold that does not
/// meet itself, turned outward. The touch_ members are complete if the insides do not meet, or if a
/// region for which this was asked is inside the other. Deterministic. Cost: near linear in the
/// triangles inside the overlap of the boxes; the product of the two numbers of triangles if all of
/// them meet.
RegionRelation relate_regions(const RegionSurface& first, const RegionSurface& second,
                              const RegionQuestions& questions, const CancelPoll& cancel);

}  // namespace watertight::validate
