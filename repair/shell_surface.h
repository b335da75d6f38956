// SPDX-License-Identifier: GPL-3.0-or-later
//
// The facets of shells as triangles: which new triangles would meet them, and how facets lie beside
// a border. Internal to repair/.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "geometry/vector3.h"
#include "repair/edited_solid.h"
#include "validate/overlap/box_tree.h"

namespace watertight::repair {

class ShellSurface {
 public:
  /// Takes the canonical triangles of all facets; facets without a triangulation are left out.
  /// Cost: O(n log n).
  explicit ShellSurface(const EditedSolid& solid);

  /// Whether a triangle of vertices of the solid meets the facets in common vertices and in edges
  /// that one facet uses, and nowhere else. Exact. Requires vertices that are not on one line.
  /// Cost: O(log n + k) for k triangles nearby.
  bool has_room_for(const Triangle& triangle) const;

  /// The direction in metres from the border edge of a missing facet, which runs from one vertex to
  /// another one, into the facet that is there; zero if that facet has no triangulation.
  geometry::Vector3 behind(Index from, Index to) const;

  /// The third vertex of the triangle that has this directed edge; kNone if none or several have
  /// it.
  Index third(Index from, Index to) const;

  std::span<const Triangle> triangles() const { return triangles_; }

  /// metres_per_unit() of the solid.
  const geometry::Vector3& units() const { return units_; }

 private:
  struct Side {
    Index third = kNone;  // the third vertex of the triangle with this directed edge
    int uses = 0;
  };

  const EditedSolid& solid_;
  geometry::Vector3 units_;
  std::vector<Triangle> triangles_;
  std::map<std::pair<Index, Index>, Side> sides_;
  validate::BoxTree tree_;
};

}  // namespace watertight::repair
