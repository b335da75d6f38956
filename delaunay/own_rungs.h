// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rungs 0 and 1 of the CDT ladder: the tetrahedralizations that this process makes itself. They
// need no other process, thread, file or clock.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "delaunay/axis_scale.h"
#include "delaunay/canonical/follow_delaunay.h"
#include "delaunay/canonical_delaunay.h"
#include "delaunay/rung.h"
#include "delaunay/tetrahedralization.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::delaunay {

/// The tetrahedralization that a rung made, for the certificate to judge, or the reason why it made
/// none.
struct RungResult {
  std::optional<Tetrahedralization> made;
  RungOutcome outcome = RungOutcome::engine_error;  // if nothing was made
  std::string text;                                 // the same for people: "refused: ..."
};

/// Works on one solid. What rung 0 finds out is not found out again by rung 1.
class OwnRungs {
 public:
  /// Keeps references. Requires merged vertices, and `triangles`: the canonical ones, divided where
  /// shells touch (divide_at_contacts); `is_divided` tells whether they are.
  OwnRungs(const Solid& solid, const tessellate::FacetTriangles& triangles, bool is_divided,
           const CancelPoll& is_cancelled);
  OwnRungs(const OwnRungs&) = delete;
  OwnRungs& operator=(const OwnRungs&) = delete;

  /// Rung 0: the canonical Delaunay tetrahedralization, where facets are unions of its faces. A
  /// facet for which `is_kept` is true keeps its canonical triangles (empty: none does).
  RungResult delaunay(const std::vector<bool>& is_kept);
  /// Rung 1: the same, changed where triangles of the boundary are missing; then, where flips end,
  /// a constrained Delaunay tetrahedralization. A facet for which `is_taken_apart` is true is given
  /// triangle by triangle (empty: none is).
  RungResult recovered(const std::vector<bool>& is_taken_apart);

 private:
  std::optional<Error> follow(const std::vector<bool>& is_kept);
  RungResult constrained(const std::vector<bool>& is_taken_apart);
  Tetrahedralization with_faces(std::vector<Point> points,
                                std::vector<geometry::Tetrahedron> tetrahedra,
                                const std::vector<Triangle>& triangles,
                                const std::vector<Index>& facet_of) const;

  const Solid& solid_;
  AxisScale scale_{1, 1, 1};
  std::vector<Point> scaled_;      // the vertices under a scaling that is not 1
  std::span<const Point> points_;  // these, or the solid's own
  const tessellate::FacetTriangles& triangles_;
  bool is_divided_;
  const CancelPoll& is_cancelled_;
  // From rung 0 to rung 1.
  std::optional<CanonicalDelaunay> delaunay_;
  std::optional<FollowingTriangles> following_;
};

}  // namespace watertight::delaunay
