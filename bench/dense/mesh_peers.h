// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bytes that mesh coders need for a triangle mesh of integers.
#pragma once

#include <cstddef>

#include "codec/page/integer_solid.h"

namespace watertight {

/// Draco, compression level 10 (8 from 2^20 steps on), int32 positions from the minimum on; 0 = it
/// refuses.
std::size_t draco_bytes(const codec::IntegerSolid& mesh);
/// The same with all positions 0: about what its connectivity takes.
std::size_t draco_connectivity_bytes(const codec::IntegerSolid& mesh);
/// meshoptimizer's vertex and index codecs after its own reordering, through zstd -19.
std::size_t meshopt_bytes(const codec::IntegerSolid& mesh);

}  // namespace watertight
