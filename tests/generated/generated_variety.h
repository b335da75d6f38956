// SPDX-License-Identifier: GPL-3.0-or-later
//
// Random closed boundaries of any size, on any lattice: buildings, voxels, plates with holes, fans,
// flat and scrambled surfaces. Not all are valid solids; the codec must bring back every one.
#pragma once

#include "tests/generated/generated_solids.h"

namespace watertight::generated {

/// A random boundary of about `size` vertices, at least 4. Equal states of `random` give equal
/// boundaries.
NamedBoundary random_solid(Random& random, Index size);

/// `count` boundaries that may stand in one page, with shared columns; some boundaries occur twice.
std::vector<NamedBoundary> random_page(Random& random, Index count, Index size);

/// Random tolerances and proof; mostly the tolerances that a blob does not state.
Acceptance random_acceptance(Random& random);

/// A number of vertices from 4 to `largest`; small numbers are by far the most frequent.
Index random_size(Random& random, Index largest);

}  // namespace watertight::generated
