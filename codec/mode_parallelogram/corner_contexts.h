// SPDX-License-Identifier: GPL-3.0-or-later
//
// The contexts of the decision of mode parallelogram whether a triangle closes a corner of the
// front: angles, lengths, bends and degrees, alone or combined.
#pragma once

#include <vector>

#include "codec/entropy/context.h"
#include "codec/mode_parallelogram/families.h"
#include "codec/mode_parallelogram/front.h"
#include "codec/mode_parallelogram/vectors.h"

namespace watertight::codec::parallelogram {

/// A corner of the front, and what is expected around it.
struct CornerView {
  const SurfaceFront& front;
  const std::vector<Vector>& centres;  // the positions of the vertices
  Index corner = 0;                    // the gate of the corner
  Vector tip;                          // the tip expected beyond the gate
  Vector next_tip;                     // the tip expected beyond the next gate
  double mean_edge = 0;
  Context<256> answers;  // the last answers of Close
};

/// One context for each input of family Close (docs/format-parallelogram.md, "Contexts of Close").
ContextsOf<kClose> corner_contexts(const CornerView& view);

}  // namespace watertight::codec::parallelogram
