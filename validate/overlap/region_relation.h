// SPDX-License-Identifier: GPL-3.0-or-later
//
// How two regions lie to each other, each bounded by one shell: whether their insides meet, whether
// one holds the other, whether they share an area of their boundaries. Exact, by orientation
// predicates and point location on the triangles of the boundaries. For cavities in their solid and
// for solids of a group. Internal to validate/.
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

/// A closed surface as triangles, turned outward. Move only: the trees refer to the arrays.
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

/// The triangles of the shells [begin, end) of a solid, with the vertices that they use. `vertices`
/// are the solid's, on any grid; an inner shell taken alone is turned outward by `is_turned_over`.
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
  bool is_cancelled = false;        // nothing else is known
  bool do_overlap = false;          // the insides have a point in common
  bool is_first_inside = false;     // when asked: no point of the first is outside the second
  bool is_second_inside = false;    // when asked: no point of the second is outside the first
  bool touch_back_to_back = false;  // triangles share an area, turned against each other
  bool touch_side_by_side = false;  // triangles share an area, turned alike
  std::uint64_t looks = 0;          // triangles in the common box and comparisons: the work done
  Index facet = kNone;              // a facet of the first that shows the overlap
  Index other_facet = kNone;        // one of the second; kNone if none shows it
};

/// Requires that each surface is one closed 2-manifold that does not meet itself, turned outward.
/// The touch_ flags are complete where the insides do not meet or where the asked region is inside.
/// Deterministic. Cost: near linear in the triangles inside the overlap of the boxes; the product
/// of their numbers when all of them meet.
RegionRelation relate_regions(const RegionSurface& first, const RegionSurface& second,
                              const RegionQuestions& questions, const CancelPoll& cancel);

}  // namespace watertight::validate
