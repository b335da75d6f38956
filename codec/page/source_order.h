// SPDX-License-Identifier: GPL-3.0-or-later
//
// The order section of format version 1: how the source had arranged shells, facets, rings, ring
// starts and vertices. Sources have habits: the next facet lies across the next edge of the last
// one or of the ground, rings start at a vertex that is known already, at a low corner or with the
// edge to the last facet. The models learn which; what fits no habit costs what a permutation
// costs.
#pragma once

#include <cstdint>
#include <span>

#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "geometry/canonical_form.h"

namespace watertight::codec {

/// The families of decisions, to be put into the layout of a bank (also one that lives for a whole
/// page). They have no numbers.
std::span<const FamilyShape> order_families();

/// Writes or measures the order of a canonical solid, or reads it into `order`. Requires the bank's
/// first families to be order_families(); unless reading, an order made by canonical_form(). When
/// the stream has failed `order` is of permutations all the same. Cost: O(n log n), and for facets
/// that follow no habit up to 64 decisions each.
void code_order(EntropyStream& stream, ModelBank& bank, const Solid& canonical,
                geometry::SourceOrder& order);

}  // namespace watertight::codec
