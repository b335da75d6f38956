// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiles/pin.h"

#include <algorithm>

namespace watertight::tiles {
namespace {

constexpr std::int32_t kRadius = static_cast<std::int32_t>(kPinRadius * kStepsOfAMetre);
constexpr std::int32_t kHeight = static_cast<std::int32_t>(kPinHeight * kStepsOfAMetre);
constexpr std::int32_t kShoulder = kHeight - kRadius;  // where it is widest

/// The corners by their distances from the place: the tip, four around, the top.
constexpr std::array<GridPosition, 6> kCorners{{{0, 0, 0},
                                                {kRadius, 0, kShoulder},
                                                {0, kRadius, kShoulder},
                                                {-kRadius, 0, kShoulder},
                                                {0, -kRadius, kShoulder},
                                                {0, 0, kHeight}}};

}  // namespace

void add_pin(FeatureMesh& mesh, const GridPosition& place) {
  const auto first = static_cast<Index>(mesh.vertices.size());
  for (const GridPosition& corner : kCorners) {
    GridPosition position{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis] = static_cast<std::int32_t>(std::min<std::int64_t>(
          std::int64_t{place[axis]} + corner[axis], std::numeric_limits<std::int32_t>::max()));
    }
    mesh.vertices.push_back(position);
  }
  auto& triangles = mesh.triangles[static_cast<std::size_t>(Look::finding)];
  for (Index side = 0; side < 4; ++side) {
    const Index from = first + 1 + side;
    const Index to = first + 1 + (side + 1) % 4;
    triangles.push_back({first, to, from});
    triangles.push_back({first + 5, from, to});
  }
}

}  // namespace watertight::tiles
