// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures a mesh as a whole blob: bytes, time and memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/result.h"
#include "codec/blob.h"
#include "codec/page/integer_solid.h"

namespace watertight {

struct WholeBlob {
  std::size_t bytes = 0;
  Mode mode = Mode::automatic;
  double connectivity_bytes = 0;  // the parts `connectivity` and `facets`
  double encode_seconds =
      0;  // CPU time of trying every mode, and of writing and reading the chosen one
  double decode_seconds = 0;
  double peak_bytes = 0;  // the growth of the resident set at its peak; 0 if unknown
};

/// The boundary of the mesh on `lattice`, or on the lattice of its integers. Errors: as
/// OrientedBoundary::make().
Result<OrientedBoundary> boundary_of(const codec::IntegerSolid& mesh, const Lattice* lattice);

/// Measures a blob with the shipped priors, without source order. Ends the program if the decoded
/// solid differs.
WholeBlob whole_blob(const OrientedBoundary& boundary, Mode mode);

}  // namespace watertight
