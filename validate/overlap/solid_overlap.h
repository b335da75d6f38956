// SPDX-License-Identifier: GPL-3.0-or-later
//
// How two valid solids, with their cavities, lie to each other: whether their interiors meet,
// whether they are the same points, whether they share an area of their boundaries, and how far an
// overlap reaches. Internal to validate/.
#pragma once

#include <optional>

#include "base/cancel.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"
#include "validate/overlap/region_relation.h"

namespace watertight::validate {

/// A valid solid as surfaces, on a grid that it shares with the solids it is compared with.
class SolidSurface {
 public:
  /// `vertices` are the solid's on that grid, `facets` its canonical triangles, which turn
  /// outward there.
  SolidSurface(const Solid& solid, std::span<const Point> vertices,
               const tessellate::FacetTriangles& facets);

  /// The triangles of all shells.
  const RegionSurface& boundary() const { return boundary_; }
  const RegionSurface& exterior() const { return shells_.empty() ? boundary_ : shells_.front(); }
  /// Each turned outward, as the boundary of the region that the solid leaves out.
  std::span<const RegionSurface> cavities() const {
    return std::span<const RegionSurface>(shells_).subspan(shells_.empty() ? 0 : 1);
  }

 private:
  RegionSurface boundary_;
  std::vector<RegionSurface> shells_;  // empty for a solid of one shell
};

struct SolidRelation {
  bool is_cancelled = false;  // nothing else is known
  bool do_overlap = false;    // the interiors have a point in common
  bool are_equal = false;     // both solids have the same points
  bool share_area = false;    // facets lie on each other back to back; unless do_overlap
  Index facet = kNone;        // a facet of the first that shows the overlap
  Index other_facet = kNone;  // one of the second; kNone if none shows it
};

/// Deterministic. Cost: as relate_regions() for the exterior shells and, where these overlap, for
/// each cavity that can hold the other solid or equal a cavity of it.
SolidRelation relate(const SolidSurface& first, const SolidSurface& second,
                     const CancelPoll& cancel);

/// Metres along the axes of the world (rows) of one step along each axis of a grid.
using StepMetres = std::array<std::array<double, 3>, 3>;

/// How far an overlap reaches, in metres, and a point of it.
struct OverlapExtent {
  /// Each part of the overlap that hangs together lies between two parallel planes no further
  /// apart than this.
  double depth = 0;
  std::optional<Point> witness;  // inside both solids, exactly
};

/// Measures, in doubles, how far two solids overlap. The depth of one part of the overlap is its
/// least extent in a direction, among the axes and the normals of the facets that bound the part.
/// The depth of the overlap is that of its deepest part. Requires boundaries of solids that
/// overlap.
OverlapExtent measure_overlap(const RegionSurface& first, const RegionSurface& second,
                              const StepMetres& step_metres);

/// For boundaries of solids that overlap, on a grid of the world (a diagonal `step_metres`) to
/// which vertices were rounded: true if the solids overlap wherever the vertices are, no further
/// from their places than `rounding` metres. Distances are computed in doubles.
bool is_overlap_certain(const RegionSurface& first, const RegionSurface& second,
                        const StepMetres& step_metres, double rounding);

}  // namespace watertight::validate
