// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bytes that other mesh coders need for a triangle mesh of integers.
#pragma once

#include <cstddef>

#include "codec/page/integer_solid.h"

namespace watertight {

/// The bytes of Draco at compression level 10 (8 from 2^20 steps on), with int32 positions counted
/// from the minimum; 0 if Draco refuses the mesh.
std::size_t draco_bytes(const codec::IntegerSolid& mesh);
/// The bytes of Draco with all positions 0, which are about those of the connectivity.
std::size_t draco_connectivity_bytes(const codec::IntegerSolid& mesh);
/// The bytes of meshoptimizer's vertex and index codecs after its own reordering, through zstd -19.
std::size_t meshopt_bytes(const codec::IntegerSolid& mesh);

}  // namespace watertight
