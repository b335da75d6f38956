// SPDX-License-Identifier: GPL-3.0-or-later
//
// The order section of a blob: how the source had arranged shells, facets, rings, ring starts and
// vertices (docs/format-0.md). Semantics, materials and textures of a document follow their facets
// by it.
#pragma once

#include "base/bytes.h"
#include "geometry/canonical_form.h"

namespace watertight::codec {

/// Requires an order made by canonical_form() for this canonical solid.
/// Cost: O(n log n); at most about log2(f!) + log2(v!) + sum of log2(ring size) bits, and next to
/// nothing where the source numbers vertices by their first use.
Bytes write_order(const Solid& canonical, const geometry::SourceOrder& order);

/// Guarantees permutations that fit the solid. Errors: malformed.
Result<geometry::SourceOrder> read_order(ByteView section, const Solid& canonical);

}  // namespace watertight::codec
