// SPDX-License-Identifier: GPL-3.0-or-later
//
// Edges that are divided, part by part. Private to delaunay/.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "delaunay/recovery/point_between.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/point.h"

namespace watertight::delaunay {

/// Where missing edges are divided (Flips::middle_of_crossings).
struct DivisionRule {
  std::size_t first_rounds = 0;  // in which there is no share: points have few bits
  double share = 0;
};
/// The first rule needs the fewest Steiner points, and recovers all city solids of the measurements
/// at hand. The second one recovers meshes of needles that the first one does not.
constexpr std::array<DivisionRule, 2> kDivisionRules{{{0, 1.0 / 8}, {5, 1.0 / 4}}};

/// Knows for each part of a divided edge where it lies on the whole edge. Places count on the whole
/// edge, so that the points on one edge do not add up their bits.
class DividedEdges {
 public:
  /// A point well within two places of an edge (0 at its first vertex, 1 at its second), or else
  /// its middle; none if doubles hold neither. The edge may be a part of another one; the place
  /// found is one on the whole edge.
  std::optional<PlacedPoint> place_on(const std::vector<Point>& points, const VertexPair& edge,
                                      const std::array<double, 2>& places) const;
  /// Divides an edge at a vertex that is greater than both ends, and at a place from place_on().
  void divide(const VertexPair& edge, Index vertex, double place);

 private:
  struct Part {
    VertexPair whole{};
    std::array<double, 2> places{};  // of the ends of the part
  };
  Part part_of(const VertexPair& edge) const;

  std::map<VertexPair, Part> parts_;
};

}  // namespace watertight::delaunay
