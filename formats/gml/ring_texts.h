// SPDX-License-Identifier: GPL-3.0-or-later
//
// The places of the coordinates of solids in the bytes of a GML document. Internal to formats/.
#pragma once

#include <span>
#include <vector>

#include "base/bytes.h"
#include "formats/gml/model.h"
#include "formats/text/kept_text.h"

namespace watertight::formats {

/// The first use of a ring element by a solid of a feature.
struct GmlRingUse {
  Index solid = kNone;  // the number of the solid in the document; kNone: no solid uses the element
  Index ring = 0;       // the number of the ring in the solid
  bool is_reversed = false;
  bool is_y_first = false;
};

/// Gives rings that no solid uses, but that have the positions of one that a solid uses, in its
/// order or in the opposite one (the footprint of a building), the use of that ring. `uses` has an
/// entry for each node of the model. Cost: linear.
void find_copies(const GmlModel& model, std::span<GmlRingUse> uses);

/// The coordinates of rings that solids use, in document order. `uses` has an entry for each node
/// of the model, which is that of `bytes`. Cost: linear.
std::vector<RingText> ring_texts(const GmlModel& model, std::span<const GmlRingUse> uses,
                                 ByteView bytes);

}  // namespace watertight::formats
