// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes how the source had arranged shells, facets, rings, the starts of rings, and vertices
// (docs/format.md, "Order"). Sources have habits: the next facet often lies across the next edge of
// the last facet or of the ground; a ring often starts at a vertex that is known already, at a low
// corner, or with the edge to the last facet. The models learn these habits. An arrangement that
// follows none of them costs as much as a permutation.
#pragma once

#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "geometry/canonical_form.h"

namespace watertight::codec {

/// The layout of the models of the source order.
const ModelLayout& order_layout();

/// Writes or measures the order of a canonical solid, or reads it into `order`. Requires a bank of
/// order_layout() and, unless reading, an order made by canonical_form(). Even when the stream has
/// failed, `order` holds permutations. Cost: O(n log n), and up to 64 decisions for each facet that
/// follows no habit.
void code_order(EntropyStream& stream, ModelBank& bank, const Solid& canonical,
                geometry::SourceOrder& order);

}  // namespace watertight::codec
