// SPDX-License-Identifier: GPL-3.0-or-later
//
// Damaged blobs, for the unit test's slice and for bench/codec/mutate_blobs.
#pragma once

#include "base/bytes.h"
#include "generated_solids.h"

namespace watertight::generated {

/// Blobs of generated solids of at most a few hundred vertices in all modes, with and without
/// order.
std::vector<Bytes> seed_blobs(std::uint64_t seed);

/// One to three changes: a bit or byte changed, bytes removed, repeated or copied from another
/// blob.
Bytes mutated(const std::vector<Bytes>& blobs, Random& random);

}  // namespace watertight::generated
