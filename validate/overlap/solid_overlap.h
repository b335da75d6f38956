// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides how two valid solids with their cavities lie to each other: whether their interiors meet,
// whether the solids are equal, whether their boundaries share an area, and how far an overlap
// reaches. Internal to validate/.
#pragma once

#include <optional>

#include "base/cancel.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"
#include "validate/overlap/region_relation.h"

namespace watertight::validate {

/// A valid solid as surfaces, on one grid with the solids with which it is compared.
class SolidSurface {
 public:
  /// `vertices` are the vertices of the solid on the common grid, `facets` its canonical triangles,
  /// which turn outward on that grid.
  SolidSurface(const Solid& solid, std::span<const Point> vertices,
               const tessellate::FacetTriangles& facets);

  /// The triangles of all shells.
  const RegionSurface& boundary() const { return boundary_; }
  const RegionSurface& exterior() const { return shells_.empty() ? boundary_ : shells_.front(); }
  /// The surfaces of the cavities, each turned outward: the boundary of a region that the solid
  /// leaves out.
  std::span<const RegionSurface> cavities() const {
    return std::span<const RegionSurface>(shells_).subspan(shells_.empty() ? 0 : 1);
  }

 private:
  RegionSurface boundary_;
  std::vector<RegionSurface> shells_;  // empty for a solid of one shell
};

struct SolidRelation {
  bool is_cancelled = false;  // true: the other members say nothing
  bool do_overlap = false;    // the interiors have a point in common
  bool are_equal = false;     // both solids have the same points
  bool share_area = false;    // facets lie on each other back to back; known unless do_overlap
  Index facet = kNone;        // a facet of the first that shows the overlap, or kNone
  Index other_facet = kNone;  // a facet of the second that shows the overlap, or kNone
};

/// The relation of two solids. Deterministic. Cost: that of relate_regions() for the exterior
/// shells and, where these overlap, for each cavity that can hold the other solid or equal a cavity
/// of the other solid.
SolidRelation relate(const SolidSurface& first, const SolidSurface& second,
                     const CancelPoll& cancel);

/// The metres along the axes of the world (rows) of one step along each axis of a grid (columns).
using StepMetres = std::array<std::array<double, 3>, 3>;

/// The depth of an overlap, and a point of the overlap.
struct OverlapExtent {
  /// Metres. Each connected part of the overlap lies between two parallel planes at most this far
  /// apart.
  double depth = 0;
  std::optional<Point> witness;  // a point that is exactly inside both solids
};

/// Measures, in doubles, how far two solids overlap. The depth of a part of the overlap is its
/// least extent along the axes and the normals of the facets that bound it; the depth of the
/// overlap is the depth of the deepest part. Requires boundaries of solids that overlap.
OverlapExtent measure_overlap(const RegionSurface& first, const RegionSurface& second,
                              const StepMetres& step_metres);

/// True if two solids overlap wherever their vertices are within `rounding` metres of the given
/// vertices. Requires boundaries of solids that overlap on a grid of the world (`step_metres` is
/// diagonal) to which the vertices were rounded. Distances are computed in doubles.
bool is_overlap_certain(const RegionSurface& first, const RegionSurface& second,
                        const StepMetres& step_metres, double rounding);

}  // namespace watertight::validate
