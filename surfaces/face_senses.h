// SPDX-License-Identifier: GPL-3.0-or-later
//
// Faces whose loops run the wrong way: files often state the sense of a face wrongly.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/point.h"

namespace watertight::surfaces {

/// A face that an edge bounds, and whether it runs along the border of the face.
struct EdgeUse {
  Index face = kNone;
  bool is_forward = true;
};

/// The faces that must be turned so that each edge of two faces runs forward in one and backward in
/// the other: of each part of faces that share edges, the smaller number of faces. All false for a
/// part that no turning makes consistent. Whether a part as a whole is inside out is not decided.
/// `uses` has the uses of each edge. Cost: linear.
std::vector<bool> wrongly_oriented(std::size_t face_count,
                                   const std::vector<std::vector<EdgeUse>>& uses);

}  // namespace watertight::surfaces
