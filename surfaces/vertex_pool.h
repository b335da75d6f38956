// SPDX-License-Identifier: GPL-3.0-or-later
//
// The vertices of a solid that is being tessellated.
#pragma once

#include <vector>

#include "geometry/point.h"
#include "surfaces/curves/bezier.h"

namespace watertight::surfaces {

class VertexPool {
 public:
  Index add(const Vector3& place) {
    places_.push_back(place);
    return static_cast<Index>(places_.size() - 1);
  }
  const Vector3& place(Index vertex) const { return places_[vertex]; }
  Index size() const { return static_cast<Index>(places_.size()); }
  /// Forgets the vertices from `size` on.
  void shrink(Index size) { places_.resize(size); }

 private:
  std::vector<Vector3> places_;  // metres
};

/// The vertices along an edge, from its start to its end.
using EdgeSamples = std::vector<Index>;

}  // namespace watertight::surfaces
