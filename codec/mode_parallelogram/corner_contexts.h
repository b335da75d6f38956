// SPDX-License-Identifier: GPL-3.0-or-later
//
// What mode parallelogram knows about a corner of the front before it says whether a triangle
// closes it: angles, lengths, bends and degrees, each alone or with another, as contexts.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/mode_parallelogram/families.h"
#include "codec/mode_parallelogram/front.h"
#include "codec/mode_parallelogram/vectors.h"

namespace watertight::codec::parallelogram {

/// A corner of the front, and what is expected around it.
struct CornerView {
  const SurfaceFront& front;
  const std::vector<Vector>& centres;  // of the vertices
  Index corner = 0;                    // its gate
  Vector tip;                          // expected beyond its gate
  Vector next_tip;                     // expected beyond the next gate
  double mean_edge = 0;
  std::uint32_t answers = 0;  // of the corners asked before, latest lowest
};

/// One context for each input of family Close (docs/format-parallelogram.md).
CloseContexts corner_contexts(const CornerView& view);

}  // namespace watertight::codec::parallelogram
