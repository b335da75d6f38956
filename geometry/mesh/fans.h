// SPDX-License-Identifier: GPL-3.0-or-later
//
// The fans of a surface without boundary: facets or triangles around a vertex, each reached from
// the one before across an edge. A vertex where the surface touches itself has several fans.
#pragma once

#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::geometry {

struct Fans {
  std::vector<Index> fan_of;  // half-edge -> the fan of the corner at which the half-edge begins
  std::vector<Index> first;   // fan -> its smallest half-edge; increasing
  std::vector<Index> size;    // fan -> the number of its half-edges
};

/// Numbers the fans of a surface by their smallest half-edges. `twin` has the twin of each
/// half-edge; `previous(h)` is the half-edge before h in its ring. Cost: linear.
template <class Previous>
Fans number_fans(std::span<const Index> twin, const Previous& previous) {
  Fans fans;
  fans.fan_of.assign(twin.size(), kNone);
  for (Index start = 0; start < twin.size(); ++start) {
    if (fans.fan_of[start] != kNone) continue;
    const auto fan = static_cast<Index>(fans.first.size());
    Index size = 0;
    for (Index half = start; fans.fan_of[half] == kNone; half = twin[previous(half)]) {
      fans.fan_of[half] = fan;
      ++size;
    }
    fans.first.push_back(start);
    fans.size.push_back(size);
  }
  return fans;
}

}  // namespace watertight::geometry
