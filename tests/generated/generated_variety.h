// SPDX-License-Identifier: GPL-3.0-or-later
//
// Closed boundaries at random, of any size, on any lattice: buildings, voxels, plates with holes,
// fans, flat and scrambled ones. Not all are valid solids; the codec must bring back every one.
#pragma once

#include "tests/generated/generated_solids.h"

namespace watertight::generated {

/// About `size` vertices, at least 4. The same for the same state of `random`.
NamedBoundary random_solid(Random& random, Index size);

/// `count` solids that may stand in one page, with shared columns and some of them twice.
std::vector<NamedBoundary> random_page(Random& random, Index count, Index size);

/// Mostly the tolerances that a blob does not state.
Acceptance random_acceptance(Random& random);

/// From 4 to `largest` vertices; small ones are by far the most frequent.
Index random_size(Random& random, Index largest);

}  // namespace watertight::generated
